/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shadow maps against depths computed here, the min-max pyramid against minima and maxima taken here, and the promise
 * that the pyramid never changes an image. */
#include "pass_bench.h"

#include "memory.h"

/* A map of random depths, a part of them 0 or 1: the worst there can be for minima and maxima. */
static void upload_random_map(struct bench *bench, int side, int layers, struct gl_texture *map, float *depths) {
    uint32_t random = (uint32_t)side;
    const size_t count = (size_t)side * (size_t)side;
    CHECK_RESULT(gl_texture_ensure(&bench->backend.gl, map, GL_DEPTH_COMPONENT32F, side, side, layers, 1), PNB_OK);
    for (size_t i = 0; i < count * (size_t)layers; i++) {
        const uint32_t x = next_random(&random);
        depths[i] = x % 97 == 0 ? 0.0f : x % 89 == 0 ? 1.0f : (float)x / 16777216.0f;
    }
    upload_texture(bench, map, GL_DEPTH_COMPONENT, depths);
}

/* Texels of the pyramid that are not exactly the least and greatest depth of the texels below them. Beyond the map's
 * border lie copies of its last row and column. */
static int wrong_texels(const float *level_pixels, int level_side, int scale, const float *depths, int side,
                        int layers) {
    int wrong = 0;
    for (int i = 0; i < level_side * level_side * layers; i++) {
        const int x0 = i % level_side * scale, y0 = i / level_side % level_side * scale,
                  layer = i / level_side / level_side;
        float least = INFINITY, greatest = -INFINITY;
        for (int y = y0; y < y0 + scale; y++)
            for (int x = x0; x < x0 + scale; x++) {
                const int column = x < side ? x : side - 1, row = y < side ? y : side - 1;
                const float depth =
                    depths[((size_t)layer * (size_t)side + (size_t)row) * (size_t)side + (size_t)column];
                least = fminf(least, depth);
                greatest = fmaxf(greatest, depth);
            }
        wrong += level_pixels[2 * i] != least || level_pixels[2 * i + 1] != greatest;
    }
    return wrong;
}

static void pyramid_is_exact(struct bench *bench, int side, int layers) {
    const struct gl *gl = &bench->backend.gl;
    struct gl_texture map = {0}, pyramid = {0};
    float *depths = malloc((size_t)side * (size_t)side * (size_t)layers * sizeof *depths);
    if (!CHECK(depths != NULL))
        return;
    upload_random_map(bench, side, layers, &map, depths);
    CHECK_RESULT(pass_min_max(&bench->frame, &map, &pyramid), PNB_OK);
    CHECK(2 * pyramid.width >= side && pyramid.width < side);
    CHECK_INT(pyramid.width >> (pyramid.levels - 1), 1);
    int wrong = 0;
    for (int level = 0; level < pyramid.levels; level++) {
        float *pixels = read_texture(gl, &pyramid, level, GL_RG, 2);
        if (CHECK(pixels != NULL))
            wrong += wrong_texels(pixels, pyramid.width >> level, 2 << level, depths, side, layers);
        free(pixels);
    }
    printf("pyramid of %d x %d x %d: %d levels from %d, %d wrong texels\n", side, side, layers, pyramid.levels,
           pyramid.width, wrong);
    CHECK_INT(wrong, 0);
    gl_texture_free(gl, &map);
    gl_texture_free(gl, &pyramid);
    free(depths);
}

/* ---- Shadow maps ---- */

/* Linear depth of every texel of a tilted plane, met at the texel's centre; 1 where it is missed. */
static double map_error(const struct light_view *view, const float *depths, int side, int *missed) {
    const double normal[3] = {0.3, -0.2, -1},
                 distance = -4; /* normal . p = distance, of the plane z = 4 + .3 x - .2 y */
    double worst = 0;
    for (int i = 0; i < side * side; i++) {
        const double q[2] = {(double)view->rect[0] + (i % side + 0.5) / side / (double)view->rect[2],
                             (double)view->rect[1] + (i / side + 0.5) / side / (double)view->rect[3]};
        const double slope = normal[0] * q[0] + normal[1] * q[1];
        const double z = view->perspective != 0.0f ? distance / (slope + normal[2]) : (distance - slope) / normal[2];
        const double x = view->perspective != 0.0f ? q[0] * z : q[0], y = view->perspective != 0.0f ? q[1] * z : q[1];
        const double depth =
            (double)depths[i] * ((double)view->far_depth - (double)view->near_depth) + (double)view->near_depth;
        /* The plane's square: -2..2; its border texels may go either way. */
        const double inside = 2 - fmax(fabs(x), fabs(y));
        if (inside > 0.01)
            worst = fmax(worst, fabs(depth - z) / z);
        if (inside < -0.01)
            *missed += depths[i] != 1.0f;
    }
    return worst;
}

/* The plane above as a mesh, drawn into a map whose view is 5 m wide at 4 m: depths at texel centres, right way up. */
static void maps_hold_linear_depth(struct bench *bench, int side, bool perspective) {
    static const float positions[] = {-2, -2, 3.8f, 2, -2, 5, 2, 2, 4.2f, -2, 2, 3};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.vertex_count = desc.corner_count = 4;
    desc.triangle_count = 2;
    desc.positions.data = positions;
    desc.triangles.data = triangles;
    pnb_mesh *mesh;
    if (!CHECK_RESULT(pnb_mesh_create(&desc, &mesh), PNB_OK))
        return;
    pnb_instance instance = {
        .struct_size = sizeof instance, .mesh = mesh, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    pnb_scene from = {.struct_size = sizeof from,
                      .instance_count = 1,
                      .instances = &instance,
                      .camera = {.struct_size = sizeof(pnb_camera)}};
    struct scene *scene;
    CHECK_RESULT(scene_create(&from, &bench->messages, &scene), PNB_OK);
    bench->frame.scene = scene;
    const float half = perspective ? 0.625f : 2.5f; /* wider than the plane on three sides, narrower on one */
    struct light_views views = {.count = 1, .single = true};
    views.views[0] = (struct light_view){.rect = {-half, -half, 1 / (1.7f * half), 1 / (2 * half)},
                                         .near_depth = 1,
                                         .far_depth = 9,
                                         .perspective = perspective ? 1.0f : 0.0f};
    glm_mat4_identity(views.views[0].from_world);
    struct gl_texture map = {0};
    CHECK_RESULT(gpu_scene_update(bench->renderer->scene, &bench->frame), PNB_OK);
    CHECK_RESULT(pass_shadow_map(&bench->frame, &views, side, TRANSLUCENCY_CUT, &map), PNB_OK);
    float *depths = read_texture(&bench->backend.gl, &map, 0, GL_DEPTH_COMPONENT, 1);
    int missed = 0;
    const double error = depths ? map_error(&views.views[0], depths, side, &missed) : INFINITY;
    printf("%s map of %d: depth off by up to %.2g of itself, %d texels drawn beside the plane\n",
           perspective ? "perspective" : "orthographic", side, error, missed);
    CHECK_AT_MOST(error, 1e-6); /* a texel's shift would be 1e-3 of it */
    CHECK_INT(missed, 0);
    free(depths);
    gl_texture_free(&bench->backend.gl, &map);
    memory_free(bench->frame.casters);
    bench->frame.casters = NULL;
    bench->frame.caster_count = 0;
    scene_destroy(&scene);
    pnb_mesh_destroy(&mesh);
}

/* ---- The skip ---- */

static int skip_changes_pixels(const char *name, enum test_light light, uint32_t map_size) {
    struct test_scene *test = quality_scene(name, light, 0, NAN);
    pnb_settings settings = quality_scene_settings("PCSS", test, 144);
    settings.shadow_map_size = map_size;
    settings.passes = PNB_PASS_SHADOW;
    settings.value_count = 1;
    pnb_value value = {"min_max", 0};
    settings.values = &value;
    struct render without = quality_render(test_scene_get(test), &settings);
    value.value = 1;
    struct render with = quality_render(test_scene_get(test), &settings);
    int different = -1;
    if (with.job && without.job) {
        different = 0;
        for (size_t i = 0; i < (size_t)with.width * with.height; i++)
            different += memcmp(with.shadow + 3 * i, without.shadow + 3 * i, 3 * sizeof(float)) != 0;
    }
    render_free(&with);
    render_free(&without);
    test_scene_destroy(&test);
    return different;
}

static void skip_changes_nothing(void) {
    const struct test_scene_info *info;
    int renders = 0, different = 0;
    for (uint32_t i = 0; (info = test_scene_info(i)); i++)
        for (int light = 0; light < scene_light_kinds(info); light++) {
            const uint32_t map_size = (i + (uint32_t)light) % 3 == 0 ? 1000 : 512;
            const int pixels = skip_changes_pixels(info->name, (enum test_light)light, map_size);
            if (!CHECK_INT(pixels, 0))
                printf("  scene %s, light %s, map %u\n", info->name, test_light_names[light], map_size);
            different += pixels != 0;
            renders++;
        }
    printf("min-max skip: %d scenes with and without, %d differ\n", renders, different);
}

int main(void) {
    quality_open();
    static struct bench bench;
    if (bench_open(&bench)) {
        static const int sides[] = {16, 100, 256, 1000, 1024};
        for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
            pyramid_is_exact(&bench, sides[i], i == 1 ? 6 : 1);
        for (int perspective = 0; perspective < 2; perspective++) {
            maps_hold_linear_depth(&bench, 100, perspective);
            maps_hold_linear_depth(&bench, 1024, perspective);
        }
        bench_close(&bench);
    }
    skip_changes_nothing();
    return quality_close();
}
