/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "example_scene.h"
#include "memory.h"
#include "scene/axes.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- An example, its copy and the messages about it ---- */

struct fixture {
    int64_t blocks;
    struct example example;
    struct messages messages;
    struct scene *scene;
};

static int setup(void **state) {
    static struct fixture fixture;
    memset(&fixture, 0, sizeof fixture);
    fixture.blocks = memory_live_blocks();
    *state = &fixture;
    messages_init(&fixture.messages);
    return example_create(&fixture.example) == PNB_OK ? 0 : -1;
}

/* Every test ends with all memory given back. */
static int teardown(void **state) {
    struct fixture *fixture = *state;
    scene_destroy(&fixture->scene);
    messages_free(&fixture->messages);
    example_destroy(&fixture->example);
    return memory_live_blocks() == fixture->blocks ? 0 : -1;
}

/* Copies the example anew; the warning about its plane is expected always. */
static const struct scene *create(struct fixture *fixture) {
    scene_destroy(&fixture->scene);
    messages_free(&fixture->messages);
    messages_init(&fixture->messages);
    assert_int_equal(scene_create(&fixture->example.scene, &fixture->messages, &fixture->scene), PNB_OK);
    return fixture->scene;
}

static bool was_told(const struct fixture *fixture, const char *part) {
    for (uint32_t i = 0; i < fixture->messages.count; i++) {
        if (strstr(fixture->messages.texts[i], part)) {
            return true;
        }
    }
    return false;
}

#define assert_told(fixture, part) assert_true(was_told(fixture, part))

static void assert_near(float actual, double expected, double tolerance) {
    if (!(fabs((double)actual - expected) <= tolerance)) {
        print_error("%.9g is not %.9g\n", (double)actual, expected);
        fail();
    }
}

/* Unit axes at right angles, right-handed. Single precision rounds each of them by 6e-8. */
static void assert_orthonormal(const float matrix[16]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double dot = 0;
            for (int k = 0; k < 3; k++) {
                dot += (double)matrix[4 * i + k] * (double)matrix[4 * j + k];
            }
            assert_near((float)dot, i == j, 1e-6);
        }
    }
    assert_true(axes_determinant(matrix) > 0);
}

/* ---- Good scenes ---- */

static void good_scenes_are_copied(void **state) {
    struct fixture *fixture = *state;
    const struct example *example = &fixture->example;
    const struct scene *scene = create(fixture);
    assert_int_equal(fixture->messages.count, 1);
    assert_told(fixture, "mesh 'Plane': 1 of 3 triangles dropped: 1 has no area");
    assert_int_equal(scene->instance_count, 4);
    for (uint32_t i = 0; i < 4; i++) {
        assert_ptr_equal(scene->instances[i].mesh, example->instances[i].mesh);
        assert_int_equal(scene->instances[i].flags, example->instances[i].flags);
        assert_memory_equal(scene->instances[i].matrix, example->instances[i].matrix, sizeof(float[16]));
    }
    assert_string_equal(scene->instances[1].name, "Left");
    assert_string_equal(scene->instances[2].name, "Pyramid"); /* NULL: the mesh's */
    assert_int_equal(scene->instances[1].first_slot, 1);
    assert_int_equal(scene->instances[1].slot_count, 3);
    assert_int_equal(scene->material_count, 4);
    assert_true(scene->materials[1].alpha == 0.875f);
    assert_ptr_equal(scene->materials[1].base_color_texture, example->colors);
    assert_ptr_equal(scene->materials[2].alpha_texture, example->mask);
    assert_true(scene->materials[3].base_color[0] == 0.8f && scene->materials[3].alpha == 1);
    assert_int_equal(scene->slot_count, 5);
    assert_int_equal(scene->slots[2], 2);
    assert_int_equal(scene->slots[4], 3);
    assert_true(scene->world_color[2] == 0.0625f);
}

static void lights_keep_what_belongs_to_their_type(void **state) {
    struct fixture *fixture = *state;
    const struct scene *scene = create(fixture);
    assert_int_equal(scene->light_count, 4);
    const struct scene_light *area = &scene->lights[0], *point = &scene->lights[1], *spot = &scene->lights[2],
                             *sun = &scene->lights[3];
    assert_true(area->shape == PNB_AREA_ELLIPSE && area->size[0] == 0.5f && area->size[1] == 0.25f);
    assert_true(area->radius == 0 && area->angle == 0 && area->spot_angle == 0 && area->spot_blend == 0);
    assert_true(point->radius == 0.1f && point->size[0] == 0 && point->shape == 0 && point->spot_angle == 0);
    assert_true(spot->radius == 0.1f && spot->spot_angle == 1.5f && spot->spot_blend == 0.25f);
    assert_true(sun->angle == 0.01f && sun->radius == 0);
    assert_string_equal(spot->name, "light");
    assert_int_equal(point->flags, PNB_LIGHT_NO_SHADOW);
}

/* The scene keeps meshes and textures alive and nothing of the host's memory. */
static void scenes_outlive_their_sources(void **state) {
    struct fixture *fixture = *state;
    const struct scene *scene = create(fixture);
    example_destroy(&fixture->example);
    memset(&fixture->example, 0xAA, sizeof fixture->example);
    assert_string_equal(scene->instances[0].mesh->name, "Plane");
    assert_string_equal(scene->materials[1].base_color_texture->name, "Colors");
    assert_true(scene->lights[0].matrix[14] == 4);
    memset(&fixture->example, 0, sizeof fixture->example);
}

static void empty_scenes_are_valid(void **state) {
    struct fixture *fixture = *state;
    fixture->example.scene = (pnb_scene){.struct_size = sizeof(pnb_scene), .camera = PNB_INIT(pnb_camera)};
    const struct scene *scene = create(fixture);
    assert_int_equal(scene->instance_count + scene->light_count, 0);
    assert_int_equal(scene->material_count, 1);
    assert_orthonormal(scene->camera.matrix);
}

/* ---- Broken structures ---- */

static void assert_refused(struct fixture *fixture, const char *part) {
    struct scene *scene = NULL;
    assert_int_equal(scene_create(&fixture->example.scene, &fixture->messages, &scene), PNB_ERROR_INVALID_ARGUMENT);
    assert_null(scene);
    if (!strstr(pnb_last_error(), part)) {
        print_error("\"%s\" lacks \"%s\"\n", pnb_last_error(), part);
        fail();
    }
}

/* Calls assert_refused with a member set to another value. */
#define REFUSED_WITH(member, value, part)                                                                              \
    do {                                                                                                               \
        __typeof__(member) kept = member;                                                                              \
        member = value;                                                                                                \
        assert_refused(fixture, part);                                                                                 \
        member = kept;                                                                                                 \
    } while (0)

static void broken_structures_are_errors(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    REFUSED_WITH(example->scene.struct_size, 1, "pnb_scene");
    REFUSED_WITH(example->scene.camera.struct_size, 0, "pnb_camera");
    REFUSED_WITH(example->scene.camera.projection, (pnb_projection)2, "projection 2");
    REFUSED_WITH(example->scene.instances, NULL, "instances is NULL");
    REFUSED_WITH(example->scene.materials, NULL, "materials is NULL");
    REFUSED_WITH(example->scene.slots, NULL, "slots is NULL");
    REFUSED_WITH(example->scene.lights, NULL, "lights is NULL");
    REFUSED_WITH(example->scene.instance_count, UINT32_MAX, "too many");
    REFUSED_WITH(example->scene.material_count, UINT32_MAX, "too many");
    REFUSED_WITH(example->scene.light_count, 65, "65 lights");
    REFUSED_WITH(example->instances[2].struct_size, 4, "instance 2");
    REFUSED_WITH(example->instances[1].mesh, NULL, "instance 1 'Left': its mesh is NULL");
    REFUSED_WITH(example->instances[1].flags, 0x80000000u, "instance 1 'Left': unknown flags 0x80000000");
    REFUSED_WITH(example->materials[2].struct_size, 4, "material 2");
    REFUSED_WITH(example->materials[2].flags, 0x80000000u, "material 2: unknown flags 0x80000000");
    REFUSED_WITH(example->lights[1].struct_size, 4, "light 1");
    REFUSED_WITH(example->lights[1].type, (pnb_light_type)4, "light 1 'Bulb'");
    REFUSED_WITH(example->lights[1].type, (pnb_light_type)-1, "light 1 'Bulb'");
    REFUSED_WITH(example->lights[1].shape, (pnb_area_shape)2, "light 1 'Bulb'");
    REFUSED_WITH(example->lights[1].flags, 0x80000000u, "unknown flags 0x80000000");
    struct scene *scene = NULL;
    assert_int_equal(scene_create(NULL, &fixture->messages, &scene), PNB_ERROR_INVALID_ARGUMENT);
    create(fixture); /* all members are as before */
}

/* ---- Instances, slots, materials ---- */

static void unusable_instances_are_dropped(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    example->instances[0].matrix[5] = NAN;
    example->instances[1].matrix[12] = INFINITY;
    example->instances[2].matrix[0] = 9e8f; /* far away, but with what can be computed */
    example->instances[3].matrix[0] = example->instances[3].matrix[4] = 9e8f;
    const struct scene *scene = create(fixture);
    assert_int_equal(scene->instance_count, 1);
    assert_string_equal(scene->instances[0].name, "Pyramid");
    assert_told(fixture, "instance 'Floor': dropped");
    assert_told(fixture, "instance 'Left': dropped");
    assert_told(fixture, "instance '': dropped");
}

static void singular_and_mirrored_instances_stay(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    memset(example->instances[0].matrix, 0, sizeof example->instances[0].matrix);
    example->instances[1].matrix[0] = -1;
    example->instances[2].matrix[3] = 5; /* not affine */
    const struct scene *scene = create(fixture);
    assert_int_equal(scene->instance_count, 4);
    assert_int_equal(fixture->messages.count, 1);
    assert_true(scene->instances[0].matrix[15] == 1);
    assert_true(scene->instances[1].matrix[0] == -1);
    assert_true(scene->instances[2].matrix[3] == 0);
}

static void slots_are_clamped(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    example->instances[0].slot_count = 0;
    example->instances[1].first_slot = 3; /* 3 slots from here, but there are 4 in all */
    example->instances[2].first_slot = UINT32_MAX;
    example->instances[3].slot_count = UINT32_MAX;
    example->slots[1] = 3;
    const struct scene *scene = create(fixture);
    static const uint32_t expected[4][2] = {{4, 1}, {3, 1}, {4, 1}, {1, 3}};
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(scene->instances[i].first_slot, expected[i][0]);
        assert_int_equal(scene->instances[i].slot_count, expected[i][1]);
    }
    assert_int_equal(scene->slots[1], 3); /* the default, behind the host's three */
    assert_told(fixture, "instance 'Left': 2 of its 3 material slots do not exist");
    assert_told(fixture, "instance 'Pyramid': 3 of its 3");
    assert_told(fixture, "slot 1: material 3 does not exist");
    assert_false(was_told(fixture, "'Floor'"));
}

static void materials_are_clamped(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    example->materials[0].base_color[0] = -1;
    example->materials[0].base_color[1] = NAN;
    example->materials[0].base_color[2] = 2;
    example->materials[0].transparency = 1.5f;
    example->materials[1].transparency = NAN;
    example->materials[2].transparency = -INFINITY;
    example->materials[1].emission[2] = INFINITY;
    const struct scene *scene = create(fixture);
    assert_true(scene->emissive && scene->materials[1].emission[2] == 0 && scene->materials[2].emission[2] == 0.5f);
    assert_true(scene->materials[0].base_color[0] == 0 && scene->materials[0].base_color[1] == 0);
    assert_true(scene->materials[0].base_color[2] == 2 && scene->materials[0].alpha == 0);
    assert_true(scene->materials[1].alpha == 1 && scene->materials[2].alpha == 1);
    assert_told(fixture, "material 0");
    assert_told(fixture, "material 1");
    assert_told(fixture, "material 2");
}

static void world_is_clamped(void **state) {
    struct fixture *fixture = *state;
    fixture->example.scene.world_color[0] = NAN;
    fixture->example.scene.world_color[1] = -1;
    const struct scene *scene = create(fixture);
    assert_true(scene->world_color[0] == 0 && scene->world_color[1] == 0 && scene->world_color[2] == 0.0625f);
    assert_told(fixture, "world");
}

/* ---- Lights ---- */

static void unusable_lights_are_dropped(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    example->lights[0].size[1] = NAN;
    example->lights[1].matrix[13] = INFINITY;
    example->lights[2].emission[1] = NAN;
    example->lights[3].radius = NAN; /* not a sun's */
    example->instances[0].unlit_by = 0xA;
    example->instances[0].unshadowed_by = 0x7;
    const struct scene *scene = create(fixture);
    assert_int_equal(scene->light_count, 1);
    assert_true(scene->instances[0].unlit_by == 1); /* the links follow the light that is left */
    assert_true(scene->instances[0].unshadowed_by == 0);
    assert_true(scene->light_linked);
    assert_string_equal(scene->lights[0].name, "Sun");
    assert_told(fixture, "light 'Lamp': dropped");
    assert_told(fixture, "light 'Bulb': dropped");
    assert_told(fixture, "light 'light': dropped");
}

static void light_values_are_clamped(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    example->lights[0].size[0] = -0.5f;
    example->lights[0].size[1] = 0;
    example->lights[0].matrix[5] = 4; /* Y axis */
    example->lights[1].radius = -0.1f;
    example->lights[1].emission[0] = -3;
    example->lights[2].spot_angle = 4;
    example->lights[2].spot_blend = -1;
    example->lights[3].angle = 3.5f;
    const struct scene *scene = create(fixture);
    assert_true(scene->lights[0].size[0] == 0.5f);
    assert_near(scene->lights[0].size[1] * 4, (double)SCENE_MIN_EMITTER, 1e-10);
    assert_true(scene->lights[1].radius == 0.1f && scene->lights[1].emission[0] == 0);
    assert_near(scene->lights[2].spot_angle, 3.14159265, 1e-6);
    assert_true(scene->lights[2].spot_blend == 0);
    assert_true(scene->lights[3].angle == SCENE_MAX_SUN_ANGLE);
    assert_true(isfinite(tanf(scene->lights[3].angle / 2)));
    assert_told(fixture, "light 'Bulb': its emission of -3 is taken as 0");
    assert_told(fixture, "light 'light': its cone angle of 4");
    assert_told(fixture, "light 'light': its cone blend of -1");
    assert_told(fixture, "light 'Sun': its angle of 3.5");
    assert_told(fixture, "light 'Lamp': its width of -0.5 is taken as 0.5");
    assert_false(was_told(fixture, "'Lamp': its height")); /* of 0: small sizes are ordinary */
    assert_told(fixture, "light 'Bulb': its radius of -0.1 is taken as 0.1");
}

static void negative_angles_are_told(void **state) {
    struct fixture *fixture = *state;
    fixture->example.lights[2].spot_angle = -1;
    fixture->example.lights[3].angle = -0.5f;
    const struct scene *scene = create(fixture);
    assert_true(scene->lights[2].spot_angle == 1 && scene->lights[3].angle == 0.5f);
    assert_told(fixture, "light 'light': its cone angle of -1 is taken as 1");
    assert_told(fixture, "light 'Sun': its angle of -0.5 is taken as 0.5");
}

static void light_defaults_are_filled_in(void **state) {
    struct fixture *fixture = *state;
    fixture->example.lights[2].spot_angle = 0;
    fixture->example.lights[1].radius = 0;
    fixture->example.lights[3].angle = 0;
    const struct scene *scene = create(fixture);
    assert_near(scene->lights[2].spot_angle, 3.14159265 / 4, 1e-6);
    assert_true(scene->lights[1].radius == 0 && scene->lights[3].angle == 0);
    assert_int_equal(fixture->messages.count, 1);
}

/* Whatever axes are zero or parallel: a finite light with independent axes, and a message. */
static void singular_lights_get_axes(void **state) {
    struct fixture *fixture = *state;
    for (unsigned kind = 0; kind < 4; kind++) {
        for (unsigned zero = 1; zero < 16; zero++) {
            pnb_light *light = &fixture->example.lights[kind];
            memcpy(light->matrix, example_identity, sizeof light->matrix);
            for (unsigned axis = 0; axis < 3; axis++) {
                if (zero & 1u << axis) {
                    light->matrix[5 * axis] = 0;
                }
            }
            if (zero & 8) { /* Y along X */
                light->matrix[4] = 2;
                light->matrix[5] = 0;
            }
            const struct scene *scene = create(fixture);
            const struct scene_light *copy = &scene->lights[kind];
            assert_true(fabs(axes_determinant(copy->matrix)) > 0.5);
            assert_told(fixture, "its matrix is singular");
            if (kind == PNB_LIGHT_AREA && (zero & 1)) {
                assert_near(copy->size[0] * axis_length(copy->matrix), (double)SCENE_MIN_EMITTER, 1e-9);
            }
            if (!(zero & 4)) { /* the direction is kept */
                assert_near(copy->matrix[10], 1, 1e-6);
            }
            memcpy(light->matrix, example_identity, sizeof light->matrix);
        }
    }
}

static void light_names_are_unique(void **state) {
    struct fixture *fixture = *state;
    static const char *const names[4] = {"Key", "Key", "Key.001", "Key"};
    for (int i = 0; i < 4; i++) {
        fixture->example.lights[i].name = names[i];
    }
    const struct scene *scene = create(fixture);
    assert_string_equal(scene->lights[0].name, "Key");
    assert_string_equal(scene->lights[1].name, "Key.001");
    assert_string_equal(scene->lights[2].name, "Key.001.001");
    assert_string_equal(scene->lights[3].name, "Key.002");
    assert_told(fixture, "light 'Key': another light has this name; this one is called 'Key.001'");
}

static void sixty_four_lights_are_allowed(void **state) {
    struct fixture *fixture = *state;
    pnb_light lights[MAX_LIGHTS];
    for (int i = 0; i < MAX_LIGHTS; i++) {
        lights[i] = fixture->example.lights[i % 4];
    }
    fixture->example.scene.lights = lights;
    fixture->example.scene.light_count = MAX_LIGHTS;
    assert_int_equal(create(fixture)->light_count, MAX_LIGHTS);
    fixture->example.scene.light_count = 0;
    assert_int_equal(create(fixture)->light_count, 0);
}

/* ---- Camera ---- */

static void camera_scale_is_removed(void **state) {
    struct fixture *fixture = *state;
    float *matrix = fixture->example.scene.camera.matrix;
    for (int axis = 0; axis < 3; axis++) {
        matrix[5 * axis] *= 0.01f * (float)(1 + axis);
    }
    const struct scene *scene = create(fixture);
    assert_memory_equal(scene->camera.matrix, example_identity, sizeof(float[14]));
    assert_true(scene->camera.matrix[14] == 10);
    assert_int_equal(fixture->messages.count, 1);
    matrix[1] = 0.02f; /* sheared */
    create(fixture);
    assert_orthonormal(fixture->scene->camera.matrix);
    assert_true(fixture->scene->camera.matrix[10] == 1);
}

static void mirrored_cameras_stay(void **state) {
    struct fixture *fixture = *state;
    fixture->example.scene.camera.matrix[0] = -3;
    const struct scene *scene = create(fixture);
    const float *matrix = scene->camera.matrix;
    assert_true(matrix[0] == -1 && matrix[5] == 1 && matrix[10] == 1 && axes_determinant(matrix) < 0);
}

static void singular_cameras_get_axes(void **state) {
    struct fixture *fixture = *state;
    for (unsigned zero = 1; zero < 8; zero++) {
        float *matrix = fixture->example.scene.camera.matrix;
        memcpy(matrix, example_identity, sizeof(float[16]));
        for (unsigned axis = 0; axis < 3; axis++) {
            if (zero & 1u << axis) {
                matrix[5 * axis] = 0;
            }
        }
        assert_orthonormal(create(fixture)->camera.matrix);
        assert_told(fixture, "camera: its matrix is singular");
        matrix[12] = NAN;
        assert_orthonormal(create(fixture)->camera.matrix);
        assert_true(fixture->scene->camera.matrix[12] == 0);
        assert_told(fixture, "camera: its matrix is not finite");
    }
}

static void camera_windows_have_a_default(void **state) {
    struct fixture *fixture = *state;
    pnb_camera *camera = &fixture->example.scene.camera;
    create(fixture);
    struct scene_camera fitted = fixture->scene->camera;
    assert_false(fitted.window_is_default);
    scene_camera_fit(&fitted, 100, 1);
    assert_memory_equal(fitted.window, camera->window, sizeof fitted.window); /* the host's own stays */

    memset(camera->window, 0, sizeof camera->window);
    create(fixture);
    assert_int_equal(fixture->messages.count, 1);
    fitted = fixture->scene->camera;
    assert_true(fitted.window[0] == -0.36f && fitted.window[3] == 0.36f); /* square until it is fitted */
    scene_camera_fit(&fitted, 200, 100);
    assert_true(fitted.window[1] == 0.36f && fitted.window[2] == -0.18f && fitted.window[3] == 0.18f);
    camera->projection = PNB_ORTHOGRAPHIC;
    assert_true(create(fixture)->camera.window[1] == 3);

    static const float bad[][4] = {{1, 1, 0, 1}, {1, 0, 0, 1}, {0, 1, 1, 1}, {0, NAN, 0, 1}, {0, 1, -INFINITY, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        memcpy(camera->window, bad[i], sizeof camera->window);
        assert_true(create(fixture)->camera.window_is_default);
        assert_true(fixture->scene->camera.window[1] == 3);
        assert_told(fixture, "camera: its window");
    }
}

static void camera_clipping_is_sane(void **state) {
    struct fixture *fixture = *state;
    pnb_camera *camera = &fixture->example.scene.camera;
    camera->clip_start = camera->clip_end = 0;
    create(fixture);
    assert_true(fixture->scene->camera.clip_start == 0.1f && fixture->scene->camera.clip_end == 1000);
    assert_int_equal(fixture->messages.count, 1);
    static const float bad[][2] = {{-1, 10}, {10, 10},      {20, 10}, {NAN, 10},
                                   {1, NAN}, {1, INFINITY}, {1, -5},  {2000, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        camera->clip_start = bad[i][0];
        camera->clip_end = bad[i][1];
        create(fixture);
        assert_true(fixture->scene->camera.clip_start == 0.1f && fixture->scene->camera.clip_end == 1000);
        assert_told(fixture, "camera: it cannot clip");
    }
}

/* ---- Memory ---- */

static void every_allocation_may_fail(void **state) {
    struct fixture *fixture = *state;
    int64_t before = memory_live_blocks();
    uint64_t failures = 0;
    for (bool complete = false; !complete; failures++) {
        struct messages messages;
        struct scene *scene = NULL;
        messages_init(&messages);
        memory_fail_at(failures + 1);
        pnb_result result = scene_create(&fixture->example.scene, &messages, &scene);
        memory_fail_at(0);
        if (result == PNB_OK) {
            complete = messages.count == 1; /* a message that finds no memory is lost without an error */
        } else {
            assert_int_equal(result, PNB_ERROR_OUT_OF_MEMORY);
            assert_null(scene);
        }
        scene_destroy(&scene);
        messages_free(&messages);
        assert_int_equal(memory_live_blocks(), before);
    }
    print_message("%d allocations failed\n", (int)failures - 1);
    assert_true(failures > 12);
}

static void destroying_nothing_is_harmless(void **state) {
    (void)state;
    struct scene *scene = NULL;
    scene_destroy(&scene);
    scene_destroy(NULL);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, setup, teardown)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(good_scenes_are_copied),
        TEST(lights_keep_what_belongs_to_their_type),
        TEST(scenes_outlive_their_sources),
        TEST(empty_scenes_are_valid),
        TEST(broken_structures_are_errors),
        TEST(unusable_instances_are_dropped),
        TEST(singular_and_mirrored_instances_stay),
        TEST(slots_are_clamped),
        TEST(materials_are_clamped),
        TEST(world_is_clamped),
        TEST(unusable_lights_are_dropped),
        TEST(light_values_are_clamped),
        TEST(negative_angles_are_told),
        TEST(light_defaults_are_filled_in),
        TEST(singular_lights_get_axes),
        TEST(light_names_are_unique),
        TEST(sixty_four_lights_are_allowed),
        TEST(camera_scale_is_removed),
        TEST(mirrored_cameras_stay),
        TEST(singular_cameras_get_axes),
        TEST(camera_windows_have_a_default),
        TEST(camera_clipping_is_sane),
        TEST(every_allocation_may_fail),
        TEST(destroying_nothing_is_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
