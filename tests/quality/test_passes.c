/* SPDX-License-Identifier: GPL-3.0-or-later
 * What every shadow image promises: finite, between 0 and 1, one for each light, and the parts adding up to the whole;
 * for every technique, procedural scene and kind of light. */
#include "quality.h"

static int bad_values(const float *pixels, size_t count, float *lowest) {
    int bad = 0;
    for (size_t i = 0; i < count; i++) {
        bad += !(pixels[i] >= 0 && pixels[i] <= 1); /* NaN too */
        *lowest = fminf(*lowest, pixels[i]);
    }
    return bad;
}

/* One render: bad pixels of all shadow passes, plus one for each pass that is missing. */
static int bad_in_scene(const char *name, enum test_light light, const char *technique, float *lowest) {
    struct test_scene *test = quality_scene(name, light, 0, NAN);
    const pnb_scene *scene = test_scene_get(test);
    pnb_settings settings = quality_scene_settings(technique, test, 72);
    settings.shadow_map_size = 128;
    settings.light_samples = 2;
    struct render render = quality_render(scene, &settings);
    int bad = render.job ? 0 : 1;
    *lowest = 1;
    if (render.job) {
        const size_t values = 3 * (size_t)render.width * render.height;
        bad += bad_values(render.shadow, values, lowest);
        for (uint32_t i = 0; i < scene->light_count; i++) {
            const float *pixels = render_light_shadow(&render, scene->lights[i].name);
            bad += pixels ? bad_values(pixels, values, lowest) : 1;
        }
    }
    render_free(&render);
    test_scene_destroy(&test);
    return bad;
}

static void values_are_shares(void) {
    for (uint32_t t = 0; t < pnb_technique_count(); t++) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        CHECK_RESULT(pnb_technique_get_info(t, &info), PNB_OK);
        const struct test_scene_info *scene;
        int renders = 0, casting = 0, shadowed = 0, bad = 0;
        for (uint32_t i = 0; (scene = test_scene_info(i)); i++)
            for (int light = 0; light < scene_light_kinds(scene); light++) {
                float lowest;
                const int here = bad_in_scene(scene->name, (enum test_light)light, info.id, &lowest);
                if (!CHECK_INT(here, 0))
                    printf("  %s, %s, %s\n", info.id, scene->name, test_light_names[light]);
                bad += here;
                renders++;
                if (strcmp(scene->name, "plane") == 0 || strcmp(scene->name, "terraces") == 0)
                    continue; /* there is nothing, or little, to see of a shadow */
                casting++;
                shadowed += lowest < 0.5f;
            }
        printf("%-9s %d scenes: %d values out of range or passes missing; %d scenes with a shadow\n", info.id, renders,
               bad, shadowed);
        CHECK_INT(shadowed, casting);
    }
}

/* ---- Several lights ---- */

static struct render render_lights(const pnb_scene *from, const pnb_light *lights, uint32_t count,
                                   const char *technique) {
    pnb_scene scene = *from;
    scene.lights = lights;
    scene.light_count = count;
    memset(scene.world_color, 0, sizeof scene.world_color);
    pnb_settings settings = quality_settings(technique, 128, 72);
    settings.passes |= PNB_PASS_COMBINED;
    settings.light_samples = 2;
    return quality_render(&scene, &settings);
}

/* Shadow of all, from what each light alone gives: the irradiance that arrives over what would arrive. */
static void lights_add_up(const char *technique) {
    struct test_scene *test = quality_scene("all-lights", TEST_LIGHT_RECTANGLE, 0, NAN);
    const pnb_scene *scene = test_scene_get(test);
    const size_t pixels = 128 * 72;
    struct render together = render_lights(scene, scene->lights, scene->light_count, technique);
    double *shadowed = calloc(3 * pixels, sizeof *shadowed), *unshadowed = calloc(3 * pixels, sizeof *unshadowed);
    int different = 0;
    for (uint32_t i = 0; i < scene->light_count && together.job && shadowed && unshadowed; i++) {
        pnb_light free_light = scene->lights[i];
        free_light.flags |= PNB_LIGHT_NO_SHADOW;
        struct render alone = render_lights(scene, &scene->lights[i], 1, technique);
        struct render lit = render_lights(scene, &free_light, 1, technique);
        const float *share = render_light_shadow(&together, scene->lights[i].name);
        const float *own = render_light_shadow(&alone, scene->lights[i].name);
        CHECK(share && own);
        for (size_t k = 0; k < 3 * pixels && share && own && lit.job; k++) {
            different += share[k] != own[k];
            shadowed[k] += (double)alone.combined[4 * (k / 3) + k % 3];
            unshadowed[k] += (double)lit.combined[4 * (k / 3) + k % 3];
        }
        render_free(&alone);
        render_free(&lit);
    }
    double combined_error = 0, shadow_error = 0;
    for (size_t k = 0; k < 3 * pixels && together.job && shadowed && unshadowed; k++) {
        combined_error = fmax(combined_error, fabs((double)together.combined[4 * (k / 3) + k % 3] - shadowed[k]));
        if (unshadowed[k] > 0)
            shadow_error = fmax(shadow_error, fabs((double)together.shadow[k] - shadowed[k] / unshadowed[k]));
    }
    printf("%-9s five lights: %d values of Shadow.<light> differ from the light alone; Combined off the sum by %.2g, "
           "Shadow "
           "off the quotient by %.2g\n",
           technique, different, combined_error, shadow_error);
    CHECK_INT(different, 0);
    CHECK_AT_MOST(combined_error, 1e-5); /* rounding of sums of numbers below 1 */
    CHECK_AT_MOST(shadow_error, 1e-4);   /* ... and of quotients of small ones */
    free(shadowed);
    free(unshadowed);
    render_free(&together);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    values_are_shares();
    lights_add_up("PCSS");
    lights_add_up("REFERENCE");
    return quality_close();
}
