/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random scenes: a good one with a few of its numbers replaced by others, among them those at which arithmetic goes
 * wrong; and meshes of random bits. Each gives finite images in their range, the same ones again, or an error with a
 * text. The sequence is fixed. Arguments: the number of one scene, to look into it. */
#include "room.h"

#include <float.h>
#include <stdlib.h>

#define SCENES 400
#define MESHES 2000

static pnb_context *context;
static struct room room;

/* ---- Random numbers ------------------------------------------------------------------------------------------ */

static uint64_t random_state;

static void random_seed(uint64_t seed) {
    random_state = (seed + 1) * 0x9e3779b97f4a7c15u;
}

/* xorshift64*: the same sequence everywhere. */
static uint32_t random_bits(void) {
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)((random_state * 0x2545f4914f6cdd1du) >> 32);
}

static uint32_t random_below(uint32_t limit) {
    return random_bits() % limit;
}

static float random_between(float low, float high) {
    return low + (high - low) * (float)(random_bits() >> 8) * 0x1p-24f;
}

static float random_float_bits(void) {
    uint32_t bits = random_bits();
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Mostly of the size scenes have; sometimes one at which checks and arithmetic go wrong. */
static float random_number(void) {
    static const float special[] = {0,    -0.0f, 1e-40f, 1e-30f, 1e-18f,  1e-9f,    1e-6f, 1e3f, 1e6f,
                                    1e9f, 1e12f, 1e18f,  1e30f,  FLT_MAX, INFINITY, NAN,   1};
    if (random_below(3) > 0) {
        return random_between(-3, 3);
    }
    const float value = special[random_below(sizeof special / sizeof *special)];
    return random_below(2) ? value : -value;
}

static uint32_t random_count(void) {
    static const uint32_t special[] = {0, 1, 2, 3, 7, 15, 16, 64, 255, 65535, INT32_MAX, UINT32_MAX - 1, UINT32_MAX};
    return special[random_below(sizeof special / sizeof *special)];
}

/* ---- Random scenes ------------------------------------------------------------------------------------------- */

#define FLOATS(member)                                                                                                 \
    { (float *)&(member), sizeof(member) / sizeof(float) }
#define LIGHT_FLOATS(i)                                                                                                \
    FLOATS(room.lights[i].matrix), FLOATS(room.lights[i].emission), FLOATS(room.lights[i].size),                       \
        FLOATS(room.lights[i].radius), FLOATS(room.lights[i].angle), FLOATS(room.lights[i].spot_angle),                \
        FLOATS(room.lights[i].spot_blend), FLOATS(room.lights[i].shadow_color)

static const struct {
    float *first;
    uint32_t count;
} floats[] = {
    FLOATS(room.data[ROOM_FLOOR].positions),
    FLOATS(room.data[ROOM_BOX].positions),
    FLOATS(room.data[ROOM_LEAF].positions),
    FLOATS(room.data[ROOM_BOX].normals),
    FLOATS(room.data[ROOM_LEAF].uvs),
    FLOATS(room.pixels),
    FLOATS(room.instances[0].matrix),
    FLOATS(room.instances[1].matrix),
    FLOATS(room.instances[2].matrix),
    FLOATS(room.materials[0].base_color),
    FLOATS(room.materials[1].base_color),
    FLOATS(room.materials[1].transparency),
    FLOATS(room.scene.camera.matrix),
    FLOATS(room.scene.camera.window),
    FLOATS(room.scene.camera.clip_start),
    FLOATS(room.scene.camera.clip_end),
    FLOATS(room.scene.world_color),
    FLOATS(room.settings.filter_width),
    LIGHT_FLOATS(0),
    LIGHT_FLOATS(1),
    LIGHT_FLOATS(2),
    LIGHT_FLOATS(3),
};

static uint32_t *const counts[] = {
    &room.data[ROOM_BOX].triangles[3][1],
    &room.data[ROOM_BOX].corner_vertices[7],
    &room.slots[0],
    &room.slots[1],
    &room.instances[1].first_slot,
    &room.instances[1].slot_count,
    &room.instances[2].flags,
    &room.lights[0].flags,
    &room.lights[2].flags,
    &room.settings.flags,
    &room.settings.passes,
    &room.settings.crop[0],
    &room.settings.crop[2],
};

static const char *technique_id(uint32_t index) {
    pnb_technique_info technique = PNB_INIT(pnb_technique_info);
    pnb_technique_get_info(index, &technique);
    return technique.id;
}

/* What every scene has another of, within what is allowed. */
static void vary_room(void) {
    pnb_settings *const settings = &room.settings;
    settings->width = 1 + random_below(64);
    settings->height = 1 + random_below(64);
    settings->samples = 1 + random_below(3);
    settings->shadow_map_size = 16 + random_below(113);
    settings->light_samples = 1 + random_below(3);
    room.scene.light_count = random_below(ROOM_LAMPS + 1);
    room.scene.camera.projection = (pnb_projection)random_below(2);
    room.texture_desc.channels = 1 + random_below(4);
    for (uint32_t i = 0; i < ROOM_LAMPS; ++i) {
        pnb_light *light = &room.lights[i];
        light->type = (pnb_light_type)random_below(4);
        light->shape = (pnb_area_shape)random_below(2);
        light->technique = random_below(4) ? NULL : technique_id(random_below(pnb_technique_count()));
        light->shadow_map_size = random_below(4) ? 0 : 16 + random_below(113);
        for (int j = 0; j < 3; ++j) {
            light->matrix[12 + j] += random_between(-1, 1);
        }
        light->matrix[4] = random_between(-1, 1);
        light->matrix[8] = random_between(-1, 1);
        light->size[random_below(2)] *= random_between(0, 20);
        light->radius *= random_between(0, 10);
        light->spot_angle = random_between(0.01f, 3.14f);
    }
    for (int i = 0; i < 12; ++i) {
        room.scene.camera.matrix[i] += random_between(-0.5f, 0.5f);
    }
}

/* One of the technique's parameters, a bit beyond its range at times. */
static void vary_technique(void) {
    pnb_technique_info technique = PNB_INIT(pnb_technique_info);
    pnb_parameter_info parameter = PNB_INIT(pnb_parameter_info);
    const uint32_t index = random_below(pnb_technique_count());
    pnb_technique_get_info(index, &technique);
    room.settings.technique = technique.id;
    if (technique.parameter_count) {
        pnb_technique_get_parameter(index, random_below(technique.parameter_count), &parameter);
        const double span = parameter.maximum - parameter.minimum;
        room.values[0].name = parameter.name;
        room.values[0].value = parameter.minimum + span * (double)random_between(-0.1f, 1.1f);
        room.settings.value_count = 1;
    }
}

static void spoil_room(void) {
    for (uint32_t i = random_below(5); i > 0; --i) {
        const uint32_t which = random_below(sizeof floats / sizeof *floats);
        floats[which].first[random_below(floats[which].count)] = random_number();
    }
    if (random_below(4) == 0) {
        *counts[random_below(sizeof counts / sizeof *counts)] = random_count();
    }
}

static pnb_result render(uint64_t *hash) {
    pnb_job *job = NULL;
    pnb_result result = pnb_render(context, &room.scene, &room.settings, &job);
    if (result == PNB_OK) {
        CHECK(images_are_sound(job));
        CHECK(pnb_job_image_count(job) > 0 || room.settings.passes == PNB_PASS_LIGHT_SHADOWS);
    }
    *hash = images_hash(job);
    pnb_job_destroy(&job);
    return result;
}

/* True if the scene gave images. */
static bool run_scene(uint32_t number) {
    uint64_t hash = 0, again = 0;
    const int before = checks_failed;
    random_seed(number);
    room_reset(&room);
    vary_room();
    vary_technique();
    spoil_room();
    CHECK_RESULT(room_make(&room), PNB_OK);
    pnb_result result = render(&hash);
    if (result != PNB_OK) {
        CHECK_RESULT(result, PNB_ERROR_INVALID_ARGUMENT);
        CHECK(pnb_last_error()[0]);
    } else if (number % 8 == 0) {
        CHECK_RESULT(render(&again), PNB_OK);
        CHECK(again == hash);
    }
    room_free(&room);
    if (checks_failed > before) {
        printf("in scene %u, with %s\n", number, room.settings.technique);
    }
    return result == PNB_OK;
}

/* ---- Meshes of random bits ------------------------------------------------------------------------------------ */

/* Arrays that end with the last element, so that a sanitizer sees the first one beyond. */
static float *float_array(uint32_t count) {
    float *array = malloc((count ? count : 1) * sizeof *array);
    for (uint32_t i = 0; array && i < count; ++i) {
        array[i] = random_below(4) ? random_number() : random_float_bits();
    }
    return array;
}

/* Indices, a few of them beyond the count. */
static uint32_t *index_array(uint32_t count, uint32_t limit) {
    uint32_t *array = malloc((count ? count : 1) * sizeof *array);
    for (uint32_t i = 0; array && i < count; ++i) {
        array[i] = random_below(20) ? random_below(limit + 1) : random_bits();
    }
    return array;
}

static void run_mesh(uint32_t number) {
    uint64_t hash;
    random_seed(1000000 + number);
    room_reset(&room);
    const uint32_t vertices = random_below(20), corners = random_below(40), triangles = random_below(20);
    pnb_mesh_desc *desc = &room.data[ROOM_BOX].desc;
    void *arrays[] = {float_array(3 * vertices), index_array(corners, vertices),      float_array(3 * corners),
                      float_array(2 * corners),  index_array(3 * triangles, corners), index_array(triangles, triangles),
                      index_array(triangles, 3)};
    desc->vertex_count = vertices;
    desc->corner_count = corners;
    desc->triangle_count = triangles;
    desc->polygon_count = triangles;
    pnb_array *const targets[] = {&desc->positions,        &desc->corner_vertices, &desc->corner_normals,
                                  &desc->corner_uvs,       &desc->triangles,       &desc->triangle_polygons,
                                  &desc->polygon_materials};
    for (int i = 0; i < 7; ++i) {
        targets[i]->data = i == 0 || i == 4 || random_below(8) ? arrays[i] : NULL;
    }
    if (!desc->corner_vertices.data) {
        desc->corner_count = corners < vertices ? corners : vertices;
    }
    CHECK_RESULT(room_make(&room), PNB_OK);
    if (number % 20 == 0) {
        CHECK_RESULT(render(&hash), PNB_OK);
    }
    room_free(&room);
    for (int i = 0; i < 7; ++i) {
        free(arrays[i]);
    }
}

int main(int argc, char **argv) {
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    uint32_t rendered = 0;
    if (argc > 1) {
        run_scene((uint32_t)strtoul(argv[1], NULL, 10));
    } else {
        for (uint32_t i = 0; i < SCENES; ++i) {
            rendered += run_scene(i);
        }
        for (uint32_t i = 0; i < MESHES; ++i) {
            run_mesh(i);
        }
        CHECK(rendered > SCENES / 2 && rendered < SCENES);
        printf("%d scenes, %u of them with images; %d meshes\n", SCENES, rendered, MESHES);
    }
    pnb_context_destroy(&context);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
