/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bad input through the public API. Every row spoils a good scene, renders it and demands finite images with a message
 * that names the object, or the error it should be; the same through a capture; then a good scene still gives the image
 * it always gave; and nothing leaks. */
#include "room.h"

#include <float.h>
#include <unistd.h>

static pnb_context *context;
static struct room room, good;
static uint64_t good_hash;
static char capture_path[] = "/tmp/penumbra_door_XXXXXX";

static pnb_result render_good(uint64_t *hash) {
    pnb_job *job = NULL;
    pnb_result result = pnb_render(context, &good.scene, &good.settings, &job);
    *hash = images_hash(job);
    pnb_job_destroy(&job);
    return result;
}

static bool has_message(const pnb_job *job, const char *text) {
    for (uint32_t i = 0; i < pnb_job_message_count(job); ++i) {
        if (strstr(pnb_job_message(job, i), text)) {
            return true;
        }
    }
    return false;
}

static const char *all_messages(const pnb_job *job) {
    static char text[4096];
    text[0] = '\0';
    for (uint32_t i = 0; i < pnb_job_message_count(job); ++i) {
        size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s\n", pnb_job_message(job, i));
    }
    return text;
}

/* ---- One row ------------------------------------------------------------------------------------------------- */

/* What a row demands. OK: `text` is in a message of the job, or there is no message if it is "". Otherwise `text` is in
 * the error. */
struct expectation {
    const char *row;
    pnb_result result;
    const char *text;
};

static bool check_render(const struct expectation *expected, const pnb_scene *scene, const pnb_settings *settings,
                         uint64_t *hash) {
    pnb_job *job = NULL;
    pnb_result result = pnb_render(context, scene, settings, &job);
    bool good_row = CHECK_RESULT(result, expected->result);
    *hash = 0;
    if (result != PNB_OK) {
        good_row = CHECK_CONTAINS(pnb_last_error(), expected->text) && CHECK(!job) && good_row;
    } else {
        good_row = CHECK(images_are_sound(job)) && good_row;
        good_row = CHECK(pnb_job_image_count(job) > 0) && good_row;
        const bool told = expected->text[0] ? has_message(job, expected->text) : pnb_job_message_count(job) == 0;
        if (!CHECK(told)) {
            printf("messages: %swanted: %s\n", all_messages(job), expected->text);
            good_row = false;
        }
        *hash = images_hash(job);
    }
    pnb_job_destroy(&job);
    return good_row;
}

/* The same scene, written and read: the same image, or no file. */
static bool check_capture(uint64_t hash) {
    pnb_capture *capture = NULL;
    pnb_job *job = NULL;
    unlink(capture_path);
    if (pnb_capture_write(capture_path, &room.scene, &room.settings) != PNB_OK) {
        return CHECK(pnb_last_error()[0]) && CHECK(access(capture_path, F_OK) != 0);
    }
    bool same = CHECK_RESULT(pnb_capture_read(capture_path, &capture), PNB_OK);
    pnb_result result =
        same ? pnb_render(context, pnb_capture_scene(capture), pnb_capture_settings(capture), &job) : PNB_ERROR_FILE;
    if (result == PNB_OK) {
        same = CHECK(images_hash(job) == hash) && same;
    } else {
        same = CHECK(hash == 0) && same;
    }
    pnb_job_destroy(&job);
    pnb_capture_destroy(&capture);
    return same;
}

/* What a scene's numbers do to a technique's arithmetic is tried with every technique, where that does not take long;
 * the rest with one technique after the other. */
static bool try_every_technique;

static void run_row(const struct expectation *expected) {
    static uint32_t row_count;
    uint64_t hash = 0, after = 0;
    const uint32_t count = expected->result == PNB_OK && !room.settings.technique ? pnb_technique_count() : 0;
    bool good_row = CHECK_RESULT(room_make(&room), PNB_OK);
    row_count++;
    for (uint32_t i = 0; good_row && i < count; ++i) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        pnb_settings settings = room.settings;
        if (!try_every_technique && i != row_count % count) {
            continue;
        }
        pnb_technique_get_info(i, &info);
        settings.technique = info.id;
        if (!check_render(expected, &room.scene, &settings, &hash)) {
            printf("with %s, ", info.id);
            good_row = false;
        }
    }
    good_row = good_row && check_render(expected, &room.scene, &room.settings, &hash);
    good_row = good_row && check_capture(hash);
    good_row = CHECK_RESULT(render_good(&after), PNB_OK) && CHECK(after == good_hash) && good_row;
    if (!good_row) {
        printf("in row: %s\n", expected->row);
    }
    room_free(&room);
}

/* Spoils the room by the statement and checks what the library makes of it. */
#define ROW(result, text, ...)                                                                                         \
    do {                                                                                                               \
        room_reset(&room);                                                                                             \
        __VA_ARGS__;                                                                                                   \
        run_row(&(struct expectation){#__VA_ARGS__, result, text});                                                    \
    } while (0)

#define INVALID PNB_ERROR_INVALID_ARGUMENT

/* ---- Rows ---------------------------------------------------------------------------------------------------- */

static struct room_mesh *const box = &room.data[ROOM_BOX];

static void fill(void *floats, size_t size, float value) {
    for (size_t i = 0; i < size / sizeof value; ++i) {
        memcpy((char *)floats + i * sizeof value, &value, sizeof value);
    }
}
#define FILL(array, value) fill(array, sizeof(array), value)

static void bad_meshes(void) {
    ROW(PNB_OK, "mesh 'Box': 3 of 10 triangles dropped", box->positions[0][0] = NAN);
    ROW(PNB_OK, "mesh 'Box': 10 of 10 triangles dropped", FILL(box->positions, NAN));
    ROW(PNB_OK, "mesh 'Box'", box->positions[7][2] = INFINITY);
    ROW(PNB_OK, "mesh 'Box'", box->positions[7][2] = -INFINITY);
    ROW(PNB_OK, "mesh 'Box'", box->positions[7][2] = FLT_MAX);
    ROW(PNB_OK, "", box->positions[7][2] = 1e6f);
    ROW(PNB_OK, "", box->positions[7][2] = 1e9f);
    ROW(PNB_OK, "instance 'Box': dropped", box->positions[7][2] = 1e17f);
    ROW(PNB_OK, "", box->positions[7][2] = FLT_TRUE_MIN);
    ROW(PNB_OK, "mesh 'Box': 10 of 10 triangles dropped: 10 have no area", FILL(box->positions, 1.0f));
    ROW(PNB_OK, "no area", box->positions[0][0] = box->positions[1][0]);
    ROW(PNB_OK, "mesh 'Box': 1 of 10 triangles dropped", box->triangles[3][1] = 30);
    ROW(PNB_OK, "mesh 'Box'", box->triangles[3][1] = UINT32_MAX);
    ROW(PNB_OK, "mesh 'Box'", box->corner_vertices[4] = 8);
    ROW(PNB_OK, "mesh 'Box'", box->corner_vertices[4] = UINT32_MAX);
    ROW(PNB_OK, "mesh 'Box'", box->triangles[3][1] = box->triangles[3][0]);
    ROW(PNB_OK, "mesh 'Box'", FILL(box->uvs, NAN));
    ROW(PNB_OK, "", FILL(box->normals, NAN));
    ROW(PNB_OK, "", FILL(box->normals, INFINITY));
    ROW(PNB_OK, "", FILL(box->normals, 1e-30f));
    ROW(PNB_OK, "", FILL(box->normals, 1e30f));
    ROW(PNB_OK, "", FILL(room.data[ROOM_LEAF].uvs, 1e18f));
    ROW(PNB_OK, "", box->materials[2] = -1);
    ROW(PNB_OK, "", box->materials[2] = INT32_MAX);
    ROW(PNB_OK, "", box->materials[2] = INT32_MIN);
    ROW(PNB_OK, "", box->desc.triangle_count = 0);
    ROW(PNB_OK, "", box->desc.triangle_count = box->desc.corner_count = box->desc.vertex_count = 0);
    ROW(PNB_OK, "", for (int i = 0; i < ROOM_MESHES; ++i) room.data[i].desc.triangle_count = 0);
}

static void bad_instances(void) {
    pnb_instance *const instance = &room.instances[ROOM_BOX];
    ROW(PNB_OK, "", room.scene.instance_count = 0);
    ROW(PNB_OK, "instance 'Box': dropped", instance->matrix[5] = NAN);
    ROW(PNB_OK, "instance 'Named': dropped", instance->name = "Named"; instance->matrix[12] = INFINITY);
    ROW(PNB_OK, "instance 'Box': dropped", instance->matrix[12] = 1e30f);
    ROW(PNB_OK, "", instance->matrix[12] = 1e6f);
    ROW(PNB_OK, "instance 'Box': dropped", instance->matrix[12] = 1.1e9f);
    ROW(PNB_OK, "", instance->matrix[10] = 1e8f);
    ROW(PNB_OK, "instance 'Box': dropped", instance->matrix[10] = 1e17f);
    ROW(PNB_OK, "", instance->matrix[0] = -1);
    ROW(PNB_OK, "", instance->matrix[10] = 0);
    ROW(PNB_OK, "", instance->matrix[0] = instance->matrix[5] = 0);
    ROW(PNB_OK, "", FILL(instance->matrix, 0));
    ROW(PNB_OK, "", FILL(instance->matrix, 1e-30f));
    ROW(PNB_OK, "", instance->matrix[0] = instance->matrix[5] = instance->matrix[10] = 1e-30f);
    ROW(PNB_OK, "instance 'Box'", instance->first_slot = 7);
    ROW(PNB_OK, "instance 'Box'", instance->first_slot = UINT32_MAX; instance->slot_count = UINT32_MAX);
    ROW(PNB_OK, "instance 'Box'", instance->slot_count = UINT32_MAX);
    ROW(PNB_OK, "", instance->slot_count = 0);
    ROW(PNB_OK, "", instance->name = "");
    ROW(PNB_OK, "", for (int i = 0; i < ROOM_MESHES; ++i) room.instances[i].flags = 1);
    ROW(PNB_OK, "", for (int i = 0; i < ROOM_MESHES; ++i) room.instances[i].flags = 2);
    ROW(PNB_OK, "", for (int i = 0; i < ROOM_MESHES; ++i) room.instances[i].flags = 7);
    ROW(INVALID, "instance 1", instance->flags = 1u << 31);
    ROW(INVALID, "instance 1", instance->struct_size = 0);
    ROW(INVALID, "instance 1", instance->struct_size += 8);
    ROW(INVALID, "instances", room.scene.instances = NULL);
    ROW(INVALID, "instances", room.scene.instance_count = UINT32_MAX);
}

static void bad_materials(void) {
    pnb_material *const material = &room.materials[1];
    ROW(PNB_OK, "material 1", material->base_color[0] = NAN);
    ROW(PNB_OK, "material 1", material->base_color[1] = -1);
    ROW(PNB_OK, "material 1", material->base_color[1] = INFINITY);
    ROW(PNB_OK, "", material->base_color[1] = 1e17f);
    ROW(PNB_OK, "material 1", material->transparency = NAN);
    ROW(PNB_OK, "material 1", material->transparency = 2);
    ROW(PNB_OK, "material 1", material->transparency = -1);
    ROW(PNB_OK, "", material->transparency = 1);
    ROW(PNB_OK, "", material->transparency = 0.5f; room.settings.samples = 3);
    ROW(PNB_OK, "material 1", material->transparency = 1; material->absorption[1] = NAN);
    ROW(PNB_OK, "material 1", material->transparency = 1; material->absorption[2] = 2);
    ROW(PNB_OK, "material 1", material->shadow_threshold = NAN);
    ROW(PNB_OK, "material 1", material->shadow_threshold = 2);
    ROW(PNB_OK, "", material->shadow_threshold = 0.5f; material->transparency = 0.5f);
    ROW(PNB_OK, "", material->transparency = 1; material->absorption[0] = 1; room.settings.samples = 2);
    ROW(PNB_OK, "", material->flags = PNB_MATERIAL_TINTED);
    ROW(PNB_OK, "", material->flags = PNB_MATERIAL_NO_SHADOW | PNB_MATERIAL_TINTED);
    ROW(PNB_OK, "", material->flags = PNB_MATERIAL_OPAQUE_SHADOW | PNB_MATERIAL_CULL_SHADOW);
    ROW(PNB_OK, "slot 1", room.slots[1] = 2);
    ROW(PNB_OK, "slot 1", room.slots[1] = UINT32_MAX);
    ROW(PNB_OK, "slot", room.scene.material_count = 0);
    ROW(PNB_OK, "instance", room.scene.slot_count = 0);
    ROW(PNB_OK, "", FILL(room.pixels, NAN));
    ROW(PNB_OK, "", FILL(room.pixels, FLT_MAX));
    ROW(PNB_OK, "", FILL(room.pixels, -1));
    ROW(PNB_OK, "", room.texture_desc.channels = 1);
    ROW(PNB_OK, "", room.texture_desc.channels = 2; room.texture_desc.is_srgb = 1);
    ROW(PNB_OK, "", room.texture_desc.channels = 3);
    ROW(PNB_OK, "", room.texture_desc.width = 1; room.texture_desc.height = 1);
    ROW(PNB_OK, "", room.texture_desc.height = 1);
    ROW(INVALID, "material 1", material->struct_size = 4);
    ROW(INVALID, "materials", room.scene.materials = NULL);
    ROW(INVALID, "slots", room.scene.slots = NULL);
}

/* Every one of the lamps. */
#define LAMPS(...)                                                                                                     \
    for (int i = 0; i < ROOM_LAMPS; ++i) {                                                                             \
        pnb_light *const light = &room.lights[i];                                                                      \
        __VA_ARGS__;                                                                                                   \
    }

static void bad_lights(void) {
    ROW(PNB_OK, "", room.scene.light_count = 0);
    ROW(PNB_OK, "light 'Lamp': another light", room.scene.light_count = 64);
    ROW(INVALID, "65 lights", room.scene.light_count = 65);
    ROW(INVALID, "lights", room.scene.light_count = UINT32_MAX);
    ROW(INVALID, "lights", room.scene.lights = NULL);
    ROW(INVALID, "light 2: struct_size is 1", room.lights[2].struct_size = 1);
    ROW(INVALID, "light 1 'Point'", room.lights[1].type = (pnb_light_type)4);
    ROW(INVALID, "light 1 'Point'", room.lights[1].type = (pnb_light_type)-1);
    ROW(INVALID, "light 0 'Area'", room.lights[0].shape = (pnb_area_shape)2);
    ROW(INVALID, "light 3 'Sun'", room.lights[3].flags = 1u << 31);
    ROW(PNB_OK, "", LAMPS(light->name = NULL); room.scene.light_count = 1);
    ROW(PNB_OK, "light 'Spot': dropped", LAMPS(light->matrix[0] = NAN));
    ROW(PNB_OK, "light 'Sun': dropped", LAMPS(light->matrix[13] = INFINITY));
    ROW(PNB_OK, "light 'Area': dropped", LAMPS(light->emission[2] = NAN));
    ROW(PNB_OK, "light 'Area'", LAMPS(light->emission[2] = -1));
    ROW(PNB_OK, "", room.lights[ROOM_AREA].shape = PNB_AREA_ELLIPSE);
    ROW(PNB_OK, "", LAMPS(FILL(light->emission, 0)));
    ROW(PNB_OK, "", LAMPS(FILL(light->emission, 1e17f)));
    ROW(PNB_OK, "light 'Area': dropped", room.lights[ROOM_AREA].size[0] = NAN);
    ROW(PNB_OK, "light 'Point': dropped", room.lights[ROOM_POINT].radius = NAN);
    ROW(PNB_OK, "light 'Sun': dropped", room.lights[ROOM_SUN].angle = INFINITY);
    ROW(PNB_OK, "light 'Spot': dropped", room.lights[ROOM_SPOT].spot_angle = NAN);
    ROW(PNB_OK, "", LAMPS(FILL(light->size, 0); light->radius = light->angle = 0));
    ROW(PNB_OK, "", LAMPS(light->size[0] = 0));
    ROW(PNB_OK, "light 'Area': its height of -1 is taken as 1",
        LAMPS(FILL(light->size, -1); light->radius = light->angle = -0.3f));
    ROW(PNB_OK, "", LAMPS(FILL(light->size, 1e-30f); light->radius = light->angle = 1e-30f));
    ROW(PNB_OK, "", LAMPS(FILL(light->size, 1e6f); light->radius = 1e6f; light->angle = 3));
    ROW(PNB_OK, "light 'Point': dropped", LAMPS(FILL(light->size, 1e17f); light->radius = 1e17f; light->angle = 1e17f));
    ROW(PNB_OK, "light 'Sun': its angle", LAMPS(FILL(light->size, 1e9f); light->radius = 1e9f; light->angle = 1e9f));
    ROW(PNB_OK, "", LAMPS(FILL(light->size, 100); light->radius = 100; light->angle = 3.1f));
    ROW(PNB_OK, "light 'Spot'", room.lights[ROOM_SPOT].spot_angle = 7);
    ROW(PNB_OK, "", room.lights[ROOM_SPOT].spot_angle = 3.14159f);
    ROW(PNB_OK, "", room.lights[ROOM_SPOT].spot_angle = 0; room.lights[ROOM_SPOT].spot_blend = 1);
    ROW(PNB_OK, "light 'Spot'", room.lights[ROOM_SPOT].spot_angle = 1e-10f);
    ROW(PNB_OK, "light 'Spot'", room.lights[ROOM_SPOT].spot_blend = 5);
    ROW(PNB_OK, "light 'Spot'", room.lights[ROOM_SPOT].spot_blend = -1);
    ROW(PNB_OK, "light 'Spot': its matrix is singular", LAMPS(light->matrix[10] = 0));
    ROW(PNB_OK, "light 'Area': its matrix is singular", LAMPS(light->matrix[0] = 0));
    ROW(PNB_OK, "light 'Sun': its matrix is singular", LAMPS(FILL(light->matrix, 0)));
    ROW(PNB_OK, "light 'Sun': its matrix is singular", LAMPS(FILL(light->matrix, 1)));
    ROW(PNB_OK, "", LAMPS(light->matrix[0] = -1));
    ROW(PNB_OK, "", LAMPS(light->matrix[4] = 3; light->matrix[1] = 0.5f));
    ROW(PNB_OK, "", LAMPS(light->matrix[0] = light->matrix[5] = light->matrix[10] = 1e-15f));
    ROW(PNB_OK, "light 'Area': dropped", LAMPS(light->matrix[0] = light->matrix[5] = light->matrix[10] = 1e15f));
    ROW(PNB_OK, "", LAMPS(light->matrix[0] = 1000; light->matrix[5] = 0.001f));
    ROW(PNB_OK, "", LAMPS(light->flags = PNB_LIGHT_NO_SHADOW));
    ROW(PNB_OK, "", LAMPS(light->flags = PNB_LIGHT_COSINE_SPOT));
    ROW(PNB_OK, "", room.settings.passes = PNB_PASS_BLOCKERS | PNB_PASS_PENUMBRAE | PNB_PASS_SHADOW_MAPS);
    ROW(PNB_OK, "", room.lights[ROOM_AREA].shape = PNB_AREA_ELLIPSE; LAMPS(light->spread = 1);
        room.settings.passes = PNB_PASS_BLOCKERS);
    ROW(PNB_OK, "light 'Area': its spread of -1 is taken as 0", room.lights[ROOM_AREA].spread = -1);
    ROW(PNB_OK, "light 'Area': its spread of 7 is taken as 3.14159", room.lights[ROOM_AREA].spread = 7);
}

static void bad_overrides(void) {
    pnb_light *const point = &room.lights[ROOM_POINT];
    ROW(INVALID, "light 'Point': there is no technique 'NONE'", point->technique = "NONE");
    ROW(PNB_OK, "", point->technique = "");
    ROW(PNB_OK, "", point->technique = "reference");
    ROW(INVALID, "light 'Point': its shadow_map_size is 15", point->shadow_map_size = 15);
    ROW(PNB_ERROR_UNSUPPORTED, "light 'Point': its shadow_map_size", point->shadow_map_size = UINT32_MAX);
    ROW(PNB_OK, "", point->shadow_map_size = 16);
    ROW(PNB_OK, "light 'Point': its shadow colour", point->shadow_color[0] = -1);
    ROW(PNB_OK, "taken as (0, 0, 1)", point->shadow_color[2] = 2);
    ROW(PNB_OK, "light 'Point': its shadow colour", point->shadow_color[1] = NAN);
    ROW(PNB_OK, "", memcpy(point->shadow_color, (float[]){0, 0.5f, 1}, sizeof point->shadow_color));
}

/* Sums and products of the largest numbers there may be. */
static void bright_scenes(void) {
    for (int near = 0; near < 2; ++near) {
        ROW(PNB_OK, "", FILL(room.materials[0].base_color, 1e18f); FILL(room.scene.world_color, 1e18f);
            LAMPS(FILL(light->emission, 1e18f); light->matrix[14] = near ? 0.901f : 2); room.settings.samples = 3);
        ROW(
            PNB_OK, "another light", FILL(room.pixels, 1e18f); FILL(room.materials[1].base_color, 1e18f);
            room.scene.light_count = 64; for (int i = 0; i < 64; ++i) {
                FILL(room.lights[i].emission, 1e18f);
                room.lights[i].radius = 0;
                room.lights[i].matrix[14] = near ? 0.901f : 2;
            });
    }
}

/* Where lights can stand. */
static void misplaced_lights(void) {
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 0.5f)); /* inside the box */
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 0));    /* in the plane of the floor */
    ROW(PNB_OK, "", LAMPS(light->matrix[12] = 2; light->matrix[14] = 0));
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 0.9f)); /* flush on the box */
    ROW(PNB_OK, "", LAMPS(light->matrix[12] = 0.5f; light->matrix[14] = 0.5f));
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = -5)); /* below everything */
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 20; light->matrix[10] = -1; light->matrix[5] = -1)); /* turned away */
    ROW(PNB_OK, "", LAMPS(light->matrix[12] = 0; light->matrix[13] = 0; light->matrix[14] = 6));   /* at the camera */
    ROW(PNB_OK, "", LAMPS(light->matrix[12] = 1e6f));
    ROW(PNB_OK, "light 'Spot': dropped", LAMPS(light->matrix[12] = 1e17f));
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 1e6f));
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 1e9f));
    ROW(PNB_OK, "", LAMPS(light->matrix[14] = 1e-20f));
}

static void bad_cameras(void) {
    pnb_camera *const camera = &room.scene.camera;
    ROW(INVALID, "pnb_camera", camera->struct_size = 0);
    ROW(INVALID, "camera", camera->projection = (pnb_projection)2);
    ROW(PNB_OK, "camera: its matrix", camera->matrix[0] = NAN);
    ROW(PNB_OK, "camera: its matrix", camera->matrix[14] = INFINITY);
    ROW(PNB_OK, "camera: its matrix", FILL(camera->matrix, 0));
    ROW(PNB_OK, "camera: its matrix", camera->matrix[0] = 0);
    ROW(PNB_OK, "", camera->matrix[0] = -1);
    ROW(PNB_OK, "", camera->matrix[0] = camera->matrix[5] = camera->matrix[10] = 1e-10f);
    ROW(PNB_OK, "", camera->matrix[14] = 0.5f); /* inside the box */
    ROW(PNB_OK, "", camera->matrix[14] = 0);
    ROW(PNB_OK, "", camera->matrix[14] = 0.9f);
    ROW(PNB_OK, "", camera->matrix[14] = 1e6f; camera->clip_end = 1e7f);
    ROW(PNB_OK, "", camera->matrix[14] = 1e9f; camera->clip_end = 5e17f);
    ROW(PNB_OK, "camera: its matrix", camera->matrix[12] = 1e17f);
    ROW(PNB_OK, "", camera->clip_end = 1e18f; camera->clip_start = 1e-18f);
    ROW(PNB_OK, "camera: it cannot clip", camera->clip_start = 10; camera->clip_end = 5);
    ROW(PNB_OK, "camera: it cannot clip", camera->clip_start = camera->clip_end = 5);
    ROW(PNB_OK, "camera: it cannot clip", camera->clip_start = -1);
    ROW(PNB_OK, "camera: it cannot clip", camera->clip_start = NAN);
    ROW(PNB_OK, "camera: it cannot clip", camera->clip_end = INFINITY);
    ROW(PNB_OK, "", camera->clip_start = 5.5f; camera->clip_end = 5.6f);
    ROW(PNB_OK, "", camera->clip_start = 900);
    ROW(PNB_OK, "camera: its window", camera->window[0] = 1; camera->window[1] = -1);
    ROW(PNB_OK, "camera: its window", FILL(camera->window, 1));
    ROW(PNB_OK, "camera: its window", FILL(camera->window, NAN));
    ROW(PNB_OK, "camera: its window", camera->window[0] = -INFINITY);
    ROW(PNB_OK, "", memcpy(camera->window, (float[]){-1e17f, 1e17f, -1e17f, 1e17f}, 16));
    ROW(PNB_OK, "", memcpy(camera->window, (float[]){0, 1e-20f, 0, 1e-20f}, 16));
    ROW(PNB_OK, "", memcpy(camera->window, (float[]){1000, 1001, 1000, 1001}, 16));
    ROW(PNB_OK, "", camera->projection = PNB_ORTHOGRAPHIC);
    ROW(PNB_OK, "", camera->projection = PNB_ORTHOGRAPHIC; camera->matrix[14] = 0.5f);
    ROW(PNB_OK, "", camera->projection = PNB_ORTHOGRAPHIC;
        memcpy(camera->window, (float[]){-1e17f, 1e17f, -1e17f, 1e17f}, 16));
    ROW(PNB_OK, "", camera->projection = PNB_ORTHOGRAPHIC; memcpy(camera->window, (float[]){0, 1e-20f, 0, 1e-20f}, 16));
    ROW(PNB_OK, "world", room.scene.world_color[0] = NAN);
    ROW(PNB_OK, "world", room.scene.world_color[0] = -1);
    ROW(PNB_OK, "", FILL(room.scene.world_color, 1e17f));
}

static void move_room(float distance) {
    for (int i = 0; i < ROOM_MESHES; ++i) {
        room.instances[i].matrix[12] += distance;
    }
    LAMPS(light->matrix[12] += distance);
    room.scene.camera.matrix[12] += distance;
}

static void scale_room(float scale) {
    for (int i = 0; i < ROOM_MESHES; ++i) {
        for (int j = 0; j < 15; ++j) {
            room.instances[i].matrix[j] *= scale;
        }
    }
    LAMPS(light->radius *= scale; for (int j = 0; j < 15; ++j) light->matrix[j] *= scale);
    for (int j = 12; j < 15; ++j) {
        room.scene.camera.matrix[j] *= scale;
    }
    room.scene.camera.clip_start = 0.1f * scale;
    room.scene.camera.clip_end = 100 * scale;
}

/* The whole scene far from the origin, or of another size. */
static void far_scenes(void) {
    ROW(PNB_OK, "", move_room(1e6f));
    ROW(PNB_OK, "", move_room(9e8f));
    ROW(PNB_OK, "instance 'Floor': dropped", move_room(1e12f));
    ROW(PNB_OK, "camera: its matrix", move_room(1e18f));
    ROW(PNB_OK, "", scale_room(1e-15f));
    ROW(PNB_OK, "", scale_room(1e-6f));
    ROW(PNB_OK, "", scale_room(1e6f));
    ROW(PNB_OK, "light 'Area': dropped", scale_room(1e15f));
    ROW(PNB_OK, "dropped", scale_room(1e18f));
}

static void bad_settings(void) {
    pnb_settings *const settings = &room.settings;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    CHECK_RESULT(pnb_context_get_info(context, &info), PNB_OK);
    const uint32_t most = info.max_texture_size;
    ROW(INVALID, "pnb_settings", settings->struct_size = 0);
    ROW(INVALID, "width", settings->width = 0);
    ROW(INVALID, "height", settings->height = 0);
    ROW(INVALID, "width", settings->width = settings->height = 0);
    ROW(PNB_OK, "", settings->width = settings->height = 1);
    ROW(PNB_OK, "", settings->width = 1);
    ROW(PNB_OK, "", settings->height = 1);
    ROW(PNB_OK, "", settings->width = 8193; settings->height = 2);
    ROW(PNB_OK, "", settings->width = most; settings->height = 1);
    ROW(PNB_OK, "", settings->width = 1; settings->height = most);
    ROW(PNB_ERROR_UNSUPPORTED, "width", settings->width = most + 1);
    ROW(PNB_ERROR_UNSUPPORTED, "height", settings->height = UINT32_MAX);
    ROW(INVALID, "samples", settings->samples = 4097);
    ROW(PNB_OK, "filter_width is nan, taken as 1.5", settings->samples = 5; settings->filter_width = NAN);
    ROW(PNB_OK, "filter_width is -1, taken as 1.5", settings->samples = 5; settings->filter_width = -1);
    ROW(PNB_OK, "filter_width is 100, taken as 1.5", settings->samples = 5; settings->filter_width = 100);
    ROW(PNB_OK, "", settings->samples = 5; settings->filter_width = 99);
    ROW(PNB_OK, "", settings->samples = 5; settings->filter_width = 1e-30f);
    ROW(INVALID, "shadow_map_size", settings->shadow_map_size = 15);
    ROW(PNB_OK, "", settings->shadow_map_size = 16);
    ROW(PNB_OK, "", settings->shadow_map_size = 17);
    ROW(PNB_OK, "", settings->shadow_map_size = 1023; room.scene.light_count = 1);
    ROW(PNB_ERROR_UNSUPPORTED, "shadow_map_size", settings->shadow_map_size = most + 1);
    ROW(INVALID, "light_samples", settings->light_samples = 65);
    ROW(PNB_OK, "", settings->technique = "REFERENCE"; settings->light_samples = 1);
    ROW(PNB_OK, "", settings->technique = "REFERENCE"; settings->light_samples = 64;
        settings->width = settings->height = 2; room.scene.light_count = 1; settings->shadow_map_size = 16);
    ROW(INVALID, "passes", settings->passes = 256);
    ROW(INVALID, "flags", settings->flags = 1u << 31);
    ROW(PNB_OK, "", settings->flags = PNB_SETTINGS_FILM_TRANSPARENT);
    ROW(PNB_OK, "", settings->passes = 0);
    ROW(PNB_OK, "", settings->passes = PNB_PASS_LIGHT_SHADOWS);
    ROW(PNB_OK, "", settings->passes = PNB_PASS_DEPTH);
}

static void bad_crops(void) {
    pnb_settings *const settings = &room.settings;
    ROW(PNB_OK, "", memcpy(settings->crop, (uint32_t[]){39, 29, 1, 1}, 16));
    ROW(PNB_OK, "", memcpy(settings->crop, (uint32_t[]){0, 0, 40, 30}, 16));
    ROW(INVALID, "crop 40,0", memcpy(settings->crop, (uint32_t[]){40, 0, 1, 1}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){0, 0, 41, 30}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){1, 0, 40, 30}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){0, 30, 40, 1}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){0, 0, 4, 0}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){1, 1, UINT32_MAX, UINT32_MAX}, 16));
    ROW(INVALID, "crop", memcpy(settings->crop, (uint32_t[]){UINT32_MAX, UINT32_MAX, 2, 2}, 16));
}

static void bad_parameters(void) {
    pnb_settings *const settings = &room.settings;
    ROW(INVALID, "there is no technique 'NONE'", settings->technique = "NONE");
    ROW(INVALID, "there is no technique ''", settings->technique = "");
    ROW(PNB_OK, "", settings->technique = "pcss");
    ROW(INVALID, "values", settings->technique = "PCSS"; settings->value_count = 1; settings->values = NULL);
    ROW(INVALID, "'(null)'", settings->technique = "PCSS"; settings->value_count = 1);
    ROW(INVALID, "no parameter 'width'", settings->technique = "PCSS"; settings->value_count = 1;
        room.values[0] = (pnb_value){"width", 1});
    ROW(INVALID, "not a finite number", settings->technique = "PCF"; settings->value_count = 1;
        room.values[0] = (pnb_value){"kernel_width", NAN});
    ROW(INVALID, "not a finite number", settings->technique = "PCF"; settings->value_count = 1;
        room.values[0] = (pnb_value){"kernel_width", INFINITY});
    ROW(PNB_OK, "", settings->technique = "PCF"; settings->value_count = 2;
        room.values[0] = (pnb_value){"kernel_width", 3}; room.values[1] = (pnb_value){"kernel_width", 4});
    ROW(PNB_OK, "", settings->value_count = 1; room.values[0] = (pnb_value){"PCF.kernel_width", 4});
    ROW(PNB_OK, "'kernel_width' is 400", settings->value_count = 1;
        room.values[0] = (pnb_value){"PCF.kernel_width", 400});
    ROW(INVALID, "there is no technique 'NONE'", settings->value_count = 1;
        room.values[0] = (pnb_value){"NONE.kernel_width", 4});
    ROW(INVALID, "technique PCF has no parameter 'width'", settings->value_count = 1;
        room.values[0] = (pnb_value){"PCF.width", 4});
    ROW(INVALID, "has no parameter ''", settings->value_count = 1; room.values[0] = (pnb_value){"PCF.", 4});
    ROW(INVALID, "there is no technique ''", settings->value_count = 1; room.values[0] = (pnb_value){".", 4});
}

/* Every parameter of every technique at and beyond its ends. */
static void parameter_ranges(void) {
    for (uint32_t t = 0; t < pnb_technique_count(); ++t) {
        pnb_technique_info technique = PNB_INIT(pnb_technique_info);
        CHECK_RESULT(pnb_technique_get_info(t, &technique), PNB_OK);
        for (uint32_t p = 0; p < technique.parameter_count; ++p) {
            pnb_parameter_info info = PNB_INIT(pnb_parameter_info);
            CHECK_RESULT(pnb_technique_get_parameter(t, p, &info), PNB_OK);
            const double values[] = {info.minimum, info.maximum, info.minimum - 1, info.maximum + 1, -1e300, 1e300};
            for (int i = 0; i < 6; ++i) {
                ROW(PNB_OK, i < 2 ? "" : info.name, room.settings.technique = technique.id;
                    room.settings.value_count = 1; room.values[0] = (pnb_value){info.name, values[i]};
                    room.settings.width = room.settings.height = 8);
            }
        }
    }
}

/* ---- Without a row ------------------------------------------------------------------------------------------- */

static void bad_handles(void) {
    pnb_technique_info technique = PNB_INIT(pnb_technique_info);
    pnb_parameter_info parameter = PNB_INIT(pnb_parameter_info);
    pnb_context_info info = {.struct_size = 1};
    pnb_context *none = NULL;
    pnb_capture *capture = NULL;
    CHECK_RESULT(pnb_technique_get_info(pnb_technique_count(), &technique), INVALID);
    CHECK_RESULT(pnb_technique_get_info(0, NULL), INVALID);
    CHECK_RESULT(pnb_technique_get_parameter(0, 1000, &parameter), INVALID);
    CHECK_RESULT(pnb_technique_get_parameter(UINT32_MAX, 0, &parameter), INVALID);
    CHECK_RESULT(pnb_technique_get_parameter(0, 0, NULL), INVALID);
    technique.struct_size = parameter.struct_size = 12;
    CHECK_RESULT(pnb_technique_get_info(0, &technique), INVALID);
    CHECK_CONTAINS(pnb_last_error(), "pnb_technique_info");
    CHECK_RESULT(pnb_technique_get_parameter(0, 0, &parameter), INVALID);
    CHECK_CONTAINS(pnb_last_error(), "pnb_parameter_info");
    CHECK_RESULT(pnb_context_get_info(context, &info), INVALID);
    CHECK_RESULT(pnb_context_get_info(context, NULL), INVALID);
    CHECK_RESULT(pnb_context_get_info(NULL, &info), INVALID);
    CHECK_RESULT(pnb_context_create(NULL, NULL), INVALID);
    CHECK_RESULT(pnb_context_create(&(pnb_context_desc){.struct_size = 1}, &none), INVALID);
    CHECK(!none);
    CHECK_RESULT(pnb_mesh_create(NULL, NULL), INVALID);
    CHECK_RESULT(pnb_texture_create(NULL, NULL), INVALID);
    CHECK_STRING(pnb_mesh_warning(NULL), "");
    CHECK_RESULT(pnb_capture_write(NULL, &good.scene, &good.settings), INVALID);
    CHECK_RESULT(pnb_capture_write("/nonexistent/x.pnb", &good.scene, &good.settings), PNB_ERROR_FILE);
    CHECK_CONTAINS(pnb_last_error(), "/nonexistent/x.pnb");
    CHECK_RESULT(pnb_capture_write(capture_path, NULL, &good.settings), INVALID);
    CHECK_RESULT(pnb_capture_write(capture_path, &good.scene, NULL), INVALID);
    CHECK_RESULT(pnb_capture_read("/nonexistent", &capture), PNB_ERROR_FILE);
    CHECK_RESULT(pnb_capture_read("/", &capture), PNB_ERROR_FILE);
    CHECK_RESULT(pnb_capture_read("/dev/null", &capture), PNB_ERROR_FILE);
    CHECK_RESULT(pnb_capture_read(NULL, &capture), INVALID);
    CHECK(!capture && !pnb_capture_scene(NULL) && !pnb_capture_settings(NULL));
    pnb_mesh_destroy(NULL);
    pnb_texture_destroy(NULL);
    pnb_context_destroy(NULL);
    pnb_context_destroy(&none);
    pnb_capture_destroy(NULL);
    pnb_capture_destroy(&capture);
    CHECK_STRING(pnb_result_name((pnb_result)-42), "unknown");
}

/* ---- All ----------------------------------------------------------------------------------------------------- */

static const struct group {
    const char *name;
    void (*run)(void);
    bool every_technique;
} groups[] = {
#define GROUP(rows, every_technique)                                                                                   \
    { #rows, rows, every_technique }
    GROUP(bad_handles, false),    GROUP(bad_meshes, true),        GROUP(bad_instances, true),
    GROUP(bad_materials, true),   GROUP(bad_lights, true),        GROUP(bright_scenes, true),
    GROUP(bad_overrides, true),   GROUP(misplaced_lights, true),  GROUP(bad_cameras, true),
    GROUP(far_scenes, true),      GROUP(bad_settings, false),     GROUP(bad_crops, false),
    GROUP(bad_parameters, false), GROUP(parameter_ranges, false),
};

/* A context of its own for each group shows which one leaks. */
static void run_group(const struct group *group) {
    const int before = checks_passed + checks_failed;
    CHECK_RESULT(create_context(NULL, &context), PNB_OK);
    room_reset(&good);
    CHECK_RESULT(room_make(&good), PNB_OK);
    CHECK_RESULT(render_good(&good_hash), PNB_OK);
    try_every_technique = group->every_technique && !UNDER_ADDRESS_SANITIZER;
    group->run();
    room_free(&good);
    pnb_context_destroy(&context);
    CHECK_INT(memory_live_blocks(), 0);
    printf("%s: %d checks\n", group->name, checks_passed + checks_failed - before);
    fflush(stdout);
}

/* Arguments: the groups to run; none: all. */
int main(int argc, char **argv) {
    if (!backend_works(NULL)) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    int file = mkstemp(capture_path);
    CHECK(file >= 0);
    close(file);
    for (size_t i = 0; i < sizeof groups / sizeof *groups; ++i) {
        bool wanted = argc < 2;
        for (int j = 1; j < argc; ++j) {
            wanted = wanted || strcmp(argv[j], groups[i].name) == 0;
        }
        if (wanted) {
            run_group(&groups[i]);
        }
    }
    unlink(capture_path);
    return check_report();
}
