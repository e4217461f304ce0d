/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a QUICK job leaves for the next: whatever changes, the picture is that of a job which starts from nothing, bit
 * by bit but where maps fitted to an earlier view serve; and what need not be drawn again is not. */
#include "quality.h"

#define WIDTH  160
#define HEIGHT 120

struct shot {
    pnb_scene scene;
    pnb_light light;
    pnb_instance instances[8];
    pnb_material material;
    pnb_settings settings;
};

static void shot_init(struct shot *shot, struct test_scene *test, const char *technique) {
    *shot = (struct shot){.scene = *test_scene_get(test), .settings = quality_settings(technique, WIDTH, HEIGHT)};
    shot->light = shot->scene.lights[0];
    memcpy(shot->instances, shot->scene.instances, shot->scene.instance_count * sizeof *shot->instances);
    shot->settings.shadow_map_size = 256;
    shot->settings.passes |= PNB_PASS_COMBINED;
    shot->settings.flags = PNB_SETTINGS_PROGRESSIVE;
}

static struct render take(struct shot *shot, uint32_t flags) {
    shot->scene.lights = &shot->light;
    shot->scene.instances = shot->instances;
    pnb_settings settings = shot->settings;
    settings.flags |= flags;
    return quality_render(&shot->scene, &settings);
}

static bool has_pass(const struct render *render, const char *name) {
    for (uint32_t i = 0; render->job && i < pnb_job_timing_count(render->job); i++) {
        pnb_timing timing = PNB_INIT(pnb_timing);
        if (pnb_job_get_timing(render->job, i, &timing) == PNB_OK && strcmp(timing.name, name) == 0)
            return true;
    }
    return false;
}

static bool images_equal(const struct render *a, const struct render *b) {
    return render_shadows_equal(a, b) && memcmp(a->combined, b->combined, 4 * sizeof(float) * WIDTH * HEIGHT) == 0 &&
           memcmp(a->depth, b->depth, sizeof(float) * WIDTH * HEIGHT) == 0;
}

/* ---- Changes ---- */

static void nothing(struct shot *shot) {
    (void)shot;
}
static void move_lamp(struct shot *shot) {
    shot->light.matrix[12] += 0.2f;
}
static void dim_lamp(struct shot *shot) {
    shot->light.emission[0] *= 0.5f;
}
static void widen_lamp(struct shot *shot) {
    shot->light.size[0] *= 1.5f, shot->light.radius *= 1.5f, shot->light.angle *= 1.5f;
}
static void move_object(struct shot *shot) {
    shot->instances[shot->scene.instance_count - 1].matrix[12] += 0.1f;
}
static void hide_shadow(struct shot *shot) {
    shot->instances[shot->scene.instance_count - 1].flags |= PNB_INSTANCE_NO_SHADOW;
}
static void remove_object(struct shot *shot) {
    shot->scene.instance_count--;
}
static void add_material(struct shot *shot) {
    static const uint32_t slot = 0;
    shot->material = (pnb_material){.struct_size = sizeof shot->material, .base_color = {0.8f, 0.1f, 0.1f}};
    shot->scene.materials = &shot->material, shot->scene.material_count = 1;
    shot->scene.slots = &slot, shot->scene.slot_count = 1;
    shot->instances[0].slot_count = 1;
}
static void enlarge_map(struct shot *shot) {
    shot->settings.shadow_map_size = 320;
}
static void cut_clip(struct shot *shot) {
    shot->scene.camera.clip_start = 4.0f;
}
static void turn_view(struct shot *shot) {
    float *m = shot->scene.camera.matrix;
    for (int i = 0; i < 3; i++)
        m[8 + i] += 0.02f * m[i];
    m[12] += 0.02f * m[0], m[13] += 0.02f * m[1];
}
static void step_back(struct shot *shot) {
    for (int i = 0; i < 3; i++)
        shot->scene.camera.matrix[12 + i] += 3.0f * shot->scene.camera.matrix[8 + i];
}

enum maps { KEPT, DRAWN, EITHER };

static const struct change {
    const char *name;
    void (*apply)(struct shot *shot);
    bool keeps_gbuffer;
    enum maps maps;
} changes[] = {{"nothing", nothing, true, KEPT},
               {"lamp moved", move_lamp, true, DRAWN},
               {"lamp dimmed", dim_lamp, true, KEPT},
               {"lamp widened", widen_lamp, true, DRAWN},
               {"object moved", move_object, false, DRAWN},
               {"casts no shadow", hide_shadow, false, DRAWN},
               {"object gone", remove_object, false, DRAWN},
               {"material", add_material, false, DRAWN},
               {"map size", enlarge_map, true, DRAWN},
               {"clip", cut_clip, false, EITHER},
               {"view turned", turn_view, false, KEPT},
               {"view farther", step_back, false, EITHER}};

/* Maps of a view that moves have texels of another size elsewhere, which moves edges: .019 at most, .059 where they are
 * hard. */
#define MOST_ERROR(technique) (strcmp(technique, "HARD") == 0 ? 0.08 : 0.03)

static void check_quick(const struct change *change, const struct render *quick, const struct render *fresh,
                        const char *technique, enum test_light light) {
    const double error = render_rmse(quick, fresh);
    const bool view_moved = change->apply == turn_view || change->maps == EITHER;
    bool good = CHECK_INT(!has_pass(quick, "G-buffer"), change->keeps_gbuffer);
    good = CHECK(view_moved ? error < MOST_ERROR(technique) : images_equal(quick, fresh)) && good;
    if (strcmp(technique, "REFERENCE") != 0 && change->maps != EITHER)
        good = CHECK_INT(!has_pass(quick, "Shadow map"), change->maps == KEPT) && good;
    if (!good)
        printf("    %s, %s, %s: RMSE %.5f\n", technique, test_light_names[light], change->name, error);
}

/* A QUICK job before the change, or several while the view turns, since maps have no room to spare at first; one after
 * it; and one that starts from nothing. */
static void check_change(const struct change *change, struct test_scene *test, const char *technique,
                         enum test_light light) {
    struct shot shot;
    shot_init(&shot, test, technique);
    for (int i = 0; i < (change->apply == turn_view ? 3 : 1); i++) {
        struct render before = take(&shot, PNB_SETTINGS_QUICK);
        render_free(&before);
        if (change->apply == turn_view)
            turn_view(&shot);
    }
    change->apply(&shot);
    struct render quick = take(&shot, PNB_SETTINGS_QUICK), fresh = take(&shot, 0);
    check_quick(change, &quick, &fresh, technique, light);
    render_free(&quick);
    render_free(&fresh);
}

static void changes_are_seen(void) {
    for (uint32_t t = 0; t < pnb_technique_count(); t++)
        for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
            pnb_technique_info info = PNB_INIT(pnb_technique_info);
            CHECK_RESULT(pnb_technique_get_info(t, &info), PNB_OK);
            struct test_scene *test = quality_scene("box", (enum test_light)light, 0, NAN);
            for (size_t i = 0; i < sizeof changes / sizeof *changes; i++)
                check_change(&changes[i], test, info.id, (enum test_light)light);
            test_scene_destroy(&test);
        }
}

/* One technique's maps are none of another's. */
static void techniques_take_turns(void) {
    struct test_scene *test = quality_scene("box", TEST_LIGHT_RECTANGLE, 0, NAN);
    for (uint32_t t = 0; t < 2 * pnb_technique_count(); t++) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        CHECK_RESULT(pnb_technique_get_info(t % pnb_technique_count(), &info), PNB_OK);
        struct shot shot;
        shot_init(&shot, test, info.id);
        struct render quick = take(&shot, PNB_SETTINGS_QUICK), fresh = take(&shot, 0);
        CHECK(images_equal(&quick, &fresh));
        render_free(&quick);
        render_free(&fresh);
    }
    test_scene_destroy(&test);
}

/* Neither do other jobs in between take what is kept, nor does it show in them. */
static void others_are_not_touched(void) {
    struct test_scene *test = quality_scene("box", TEST_LIGHT_RECTANGLE, 0, NAN);
    struct shot shot;
    shot_init(&shot, test, "PCSS");
    struct render first = take(&shot, PNB_SETTINGS_QUICK);
    shot.settings.samples = 8;
    struct render samples = take(&shot, PNB_SETTINGS_QUICK), same = take(&shot, 0);
    CHECK(images_equal(&samples, &same)); /* of several samples none is quick */
    shot.settings.samples = 1;
    struct render quick = take(&shot, PNB_SETTINGS_QUICK);
    CHECK(!has_pass(&quick, "Shadow map"));
    shot.settings.flags = 0;
    struct render still = take(&shot, 0);
    CHECK(has_pass(&still, "Shadow map") && has_pass(&still, "G-buffer"));
    struct render again = take(&shot, PNB_SETTINGS_QUICK);
    CHECK(images_equal(&again, &still) && has_pass(&again, "Shadow map")); /* a still has all the memory */
    struct render *const all[] = {&first, &samples, &same, &quick, &still, &again};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        render_free(all[i]);
    test_scene_destroy(&test);
}

/* Maps of a light that casts no shadow for now would be memory held for nothing. */
static void unused_maps_are_dropped(void) {
    struct test_scene *test = quality_scene("box", TEST_LIGHT_RECTANGLE, 0, NAN);
    struct shot shot;
    shot_init(&shot, test, "PCSS");
    struct render shadowed = take(&shot, PNB_SETTINGS_QUICK);
    shot.light.flags |= PNB_LIGHT_NO_SHADOW;
    struct render unshadowed = take(&shot, PNB_SETTINGS_QUICK);
    shot.light.flags &= ~(uint32_t)PNB_LIGHT_NO_SHADOW;
    struct render again = take(&shot, PNB_SETTINGS_QUICK);
    CHECK(!has_pass(&unshadowed, "Shadow map") && has_pass(&again, "Shadow map"));
    CHECK(images_equal(&shadowed, &again));
    struct render *const all[] = {&shadowed, &unshadowed, &again};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        render_free(all[i]);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    changes_are_seen();
    techniques_take_turns();
    others_are_not_touched();
    unused_maps_are_dropped();
    return quality_close();
}
