/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fails the first, second, third ... host allocation of a whole use of the library until all of it succeeds. Each time:
 * an out-of-memory error with a message, or a result that is complete; never a leak or a crash. */
#include "support.h"

static pnb_context *context;

static pnb_result use_context(void) {
    pnb_context *own = NULL;
    pnb_result result = create_context(NULL, &own);
    pnb_context_destroy(&own);
    return result;
}

static pnb_result use_mesh(void) {
    struct small_scene small;
    pnb_result result = small_scene_create(&small);
    small_scene_destroy(&small);
    return result;
}

static pnb_result use_texture(void) {
    static const float pixels[2 * 2 * 4] = {0.5f, 0.5f, 0.5f, 1.0f};
    pnb_texture *texture = NULL;
    pnb_texture_desc desc = PNB_INIT(pnb_texture_desc);
    desc.width = desc.height = 2;
    desc.channels = 4;
    desc.pixels.data = pixels;
    pnb_result result = pnb_texture_create(&desc, &texture);
    pnb_texture_destroy(&texture);
    return result;
}

static struct small_scene small;

static pnb_result use_render(void) {
    pnb_job *job = NULL;
    pnb_settings settings = small.settings;
    settings.samples = 2;
    settings.passes = PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW | PNB_PASS_LIGHT_SHADOWS;
    pnb_result result = pnb_render(context, small_scene_get(&small), &settings, &job);
    if (result == PNB_OK) {
        CHECK(pnb_job_image_count(job) >= 1);
    }
    pnb_job_destroy(&job);
    return result;
}

/* Gives how many allocations failed in turn. */
static int fail_each(const char *what, pnb_result (*use)(void)) {
    enum { MOST = 100000 };
    CHECK_RESULT(use(), PNB_OK); /* fills what is kept for later, such as meshes in OpenGL */
    int64_t before = memory_live_blocks();
    int refused = 0, survived = 0;
    for (uint64_t n = 1; n < MOST; ++n) {
        memory_fail_at(n);
        pnb_result result = use();
        bool reached = memory_fail_at(0) == 0;
        if (result == PNB_OK) {
            ++survived; /* what failed was not essential, such as a warning */
        } else {
            CHECK_RESULT(result, PNB_ERROR_OUT_OF_MEMORY);
            CHECK_CONTAINS(pnb_last_error(), "memory");
            ++refused;
        }
        CHECK_AT_MOST((double)memory_live_blocks(), (double)before);
        if (!reached) {
            break;
        }
    }
    printf("%s: %d failures refused, %d without effect\n", what, refused, survived - 1);
    CHECK_RESULT(use(), PNB_OK);
    return refused;
}

int main(void) {
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    CHECK(fail_each("mesh", use_mesh) > 0);
    CHECK(fail_each("texture", use_texture) > 0);
    CHECK(fail_each("context", use_context) > 0);
    CHECK(fail_each("render", use_render) > 0);
    pnb_context_destroy(&context);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
