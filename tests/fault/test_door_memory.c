/* SPDX-License-Identifier: GPL-3.0-or-later
 * Renders that run out of memory. Each host allocation of a context's first render fails in turn, compilation of
 * shaders included, and large images meet any limit on address space. Every time: an error, or the right image; and
 * after an error the same context renders a good scene as if nothing had happened. */
#include "room.h"
#include "spawn.h"

#include <inttypes.h>

/* ---- Host allocations ---------------------------------------------------------------------------------------- */

static void prepare(struct room *room) {
    room_reset(room);
    room->settings.samples = 2;
    room->texture_desc.channels = 3;
    room->scene.light_count = 2;
}

static pnb_result render(pnb_context *context, struct room *room, uint64_t *hash) {
    pnb_job *job = NULL;
    pnb_result result = room_make(room);
    if (result == PNB_OK) {
        result = pnb_render(context, &room->scene, &room->settings, &job);
    }
    *hash = images_hash(job);
    pnb_job_destroy(&job);
    room_free(room);
    return result;
}

/* Fails the n-th allocation of a render. False: there are fewer. */
static bool fail_at(uint64_t n, pnb_context *context, const char *technique, uint64_t expected) {
    struct room room;
    uint64_t hash = 0;
    prepare(&room);
    room.settings.technique = technique;
    memory_fail_at(n);
    pnb_result result = render(context, &room, &hash);
    const bool reached = memory_fail_at(0) == 0;
    if (result == PNB_OK) {
        CHECK(hash == expected);
    } else {
        CHECK_RESULT(result, PNB_ERROR_OUT_OF_MEMORY);
        CHECK_CONTAINS(pnb_last_error(), "memory");
    }
    prepare(&room);
    room.settings.technique = technique;
    if (!CHECK_RESULT(render(context, &room, &hash), PNB_OK) || !CHECK(hash == expected)) {
        printf("after allocation %" PRIu64 " failed, with %s\n", n, technique);
    }
    return reached;
}

/* Fails each allocation in turn: of the first renders of new contexts, or of the later ones of a single context. */
static void fail_each(const char *technique, bool first) {
    enum { MOST = 10000 };
    pnb_context *context = NULL;
    struct room room;
    uint64_t expected = 0, n = 0;
    CHECK_RESULT(create_context(NULL, &context), PNB_OK);
    prepare(&room);
    room.settings.technique = technique;
    CHECK_RESULT(render(context, &room, &expected), PNB_OK);
    for (bool reached = true; reached && n < MOST;) {
        if (first) {
            pnb_context_destroy(&context);
            CHECK_INT(memory_live_blocks(), 0);
            CHECK_RESULT(create_context(NULL, &context), PNB_OK);
        }
        reached = fail_at(++n, context, technique, expected);
    }
    pnb_context_destroy(&context);
    CHECK_INT(memory_live_blocks(), 0);
    printf("%s: %" PRIu64 " allocations of %s failed in turn\n", technique, n - 1,
           first ? "first renders" : "a render");
    CHECK(n > 50 && n < MOST);
}

/* ---- Address space ------------------------------------------------------------------------------------------- */

/* In a process of its own: a large image, then a small one. */
static int render_large(uint32_t side) {
    pnb_context *context = NULL;
    struct room room;
    uint64_t hash = 0;
    pnb_result result = create_context(NULL, &context);
    printf("context %s\n", pnb_result_name(result));
    if (result != PNB_OK) {
        return 0;
    }
    prepare(&room);
    room.settings.width = room.settings.height = side;
    room.settings.technique = "HARD";
    room.settings.samples = 1;
    result = render(context, &room, &hash);
    printf("large %s %016" PRIx64 " %s\n", pnb_result_name(result), hash, result == PNB_OK ? "" : pnb_last_error());
    prepare(&room);
    result = render(context, &room, &hash);
    printf("small %s %016" PRIx64 "\n", pnb_result_name(result), hash);
    pnb_context_destroy(&context);
    printf("live blocks %lld\n", (long long)memory_live_blocks());
    return 0;
}

/* The line that begins with `word`, without its end. */
static void find_line(const char *text, const char *word, char *line, size_t size) {
    const char *found = strstr(text, word);
    snprintf(line, size, "%.*s", found ? (int)strcspn(found, "\n") : 0, found ? found : "");
}

static void any_address_space(void) {
    char expected_large[256], expected_small[256], output[4096], large[256];
    int refused = 0, rendered = 0;
    spawn_self(&(struct spawn){.argument = "2000"}, output, sizeof output);
    find_line(output, "large PNB_OK ", expected_large, sizeof expected_large);
    find_line(output, "small PNB_OK ", expected_small, sizeof expected_small);
    CHECK(expected_large[0] && expected_small[0]);
    for (rlim_t megabytes = 800; megabytes <= 1700; megabytes += 75) {
        struct spawn spawn = {.argument = "2000", .address_space = megabytes << 20};
        int status = spawn_self(&spawn, output, sizeof output);
        find_line(output, "large ", large, sizeof large);
        const bool no_context = strstr(output, "context PNB_ERROR_OUT_OF_MEMORY") != NULL;
        const bool is_refused = strstr(large, "PNB_ERROR_OUT_OF_MEMORY") && strstr(large, "memory");
        const bool is_rendered = strcmp(large, expected_large) == 0;
        const bool goes_on = strstr(output, expected_small) && strstr(output, "live blocks 0\n");
        refused += is_refused;
        rendered += is_rendered;
        if (!CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0) ||
            !CHECK(no_context || ((is_refused || is_rendered) && goes_on))) {
            printf("with %lu MiB, status %#x:\n%s", (unsigned long)megabytes, (unsigned)status, output);
        }
    }
    printf("limits on address space: %d large images refused, %d rendered\n", refused, rendered);
    CHECK(refused > 0 && rendered > 0);
}

/* Sixteen gigabytes of textures and images. */
static void largest_image(void) {
    char output[4096];
    struct spawn spawn = {.argument = "16384", .address_space = (rlim_t)6 << 30};
    int status = spawn_self(&spawn, output, sizeof output);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    if (!strstr(output, "PNB_ERROR_UNSUPPORTED")) { /* a smaller limit of OpenGL */
        CHECK_CONTAINS(output, "large PNB_ERROR_OUT_OF_MEMORY");
    }
    CHECK_CONTAINS(output, "small PNB_OK");
}

int main(int argc, char **argv) {
    if (argc > 1) {
        return render_large((uint32_t)strtoul(argv[1], NULL, 10));
    }
    if (!backend_works(NULL)) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    fail_each("PCSS", true);
    fail_each("PCSS", false);
    fail_each("REFERENCE", false);
    if (!UNDER_ADDRESS_SANITIZER) { /* which needs terabytes of it */
        any_address_space();
        largest_image();
    }
    return check_report();
}
