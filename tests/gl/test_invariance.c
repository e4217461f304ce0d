/* SPDX-License-Identifier: GPL-3.0-or-later
 * What must not change an image: the order of objects, triangles and lights, the unit of length, what was rendered
 * before, and the locale, folder, home and umask of the host. */
#include "fault/room.h"
#include "fault/spawn.h"
#include "test_scenes.h"

#include <inttypes.h>
#include <locale.h>
#include <stdlib.h>
#include <sys/stat.h>

/* ---- Order --------------------------------------------------------------------------------------------------- */

static void reverse(void *items, size_t count, size_t size) {
    unsigned char *first = items, *last = first + (count - 1) * size;
    for (; count > 0 && first < last; first += size, last -= size) {
        for (size_t i = 0; i < size; ++i) {
            const unsigned char kept = first[i];
            first[i] = last[i];
            last[i] = kept;
        }
    }
}

static void room_prepare(struct room *room) {
    room_reset(room);
    room->settings.width = 200;
    room->settings.height = 150;
    room->settings.samples = 2;
    room->settings.shadow_map_size = 256;
}

static pnb_job *render(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings) {
    pnb_job *job = NULL;
    CHECK_RESULT(pnb_render(context, scene, settings, &job), PNB_OK);
    return job;
}

static pnb_job *render_room(pnb_context *context, struct room *room) {
    CHECK_RESULT(room_make(room), PNB_OK);
    pnb_job *job = render(context, &room->scene, &room->settings);
    room_free(room);
    return job;
}

static bool find_image(const pnb_job *job, const char *name, pnb_image *image) {
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i) {
        if (pnb_job_get_image(job, i, image) == PNB_OK && strcmp(image->name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Pixels of all images, matched by name, whose relative difference is above the tolerance. */
static size_t count_different(const pnb_job *a, const pnb_job *b, double tolerance) {
    size_t different = 0;
    for (uint32_t i = 0; i < pnb_job_image_count(a); ++i) {
        pnb_image first = PNB_INIT(pnb_image), second = PNB_INIT(pnb_image);
        pnb_job_get_image(a, i, &first);
        if (!CHECK(find_image(b, first.name, &second))) {
            continue;
        }
        const size_t pixels = (size_t)first.width * first.height;
        for (size_t p = 0; p < pixels; ++p) {
            double largest = 0;
            for (size_t c = p * first.channels; c < (p + 1) * first.channels; ++c) {
                const double difference = fabs((double)first.pixels[c] - (double)second.pixels[c]);
                largest = fmax(largest, difference / fmax(1, fabs((double)first.pixels[c])));
            }
            different += largest > tolerance;
        }
    }
    return different;
}

static void permute(pnb_context *context, struct room *room, double tolerance, const char *what) {
    struct room original;
    room_prepare(&original);
    pnb_job *expected = render_room(context, &original), *permuted = render_room(context, room);
    const size_t different = count_different(expected, permuted, tolerance);
    printf("%s: %zu pixels of all passes differ\n", what, different);
    CHECK_INT((long long)different, 0);
    pnb_job_destroy(&expected);
    pnb_job_destroy(&permuted);
}

static void order_does_not_count(pnb_context *context) {
    struct room room;
    room_prepare(&room);
    reverse(room.instances, ROOM_MESHES, sizeof *room.instances);
    reverse(room.data, ROOM_MESHES, sizeof *room.data);
    /* The arrays have moved with their meshes. */
    for (int i = 0; i < ROOM_MESHES; ++i) {
        struct room_mesh *mesh = &room.data[i];
        mesh->desc.positions.data = mesh->positions;
        mesh->desc.corner_vertices.data = mesh->corner_vertices;
        mesh->desc.corner_normals.data = mesh->normals;
        mesh->desc.corner_uvs.data = mesh->uvs;
        mesh->desc.triangles.data = mesh->triangles;
        mesh->desc.polygon_materials.data = mesh->materials;
    }
    permute(context, &room, 0, "instances reversed");

    room_prepare(&room);
    for (int i = 0; i < ROOM_MESHES; ++i) {
        reverse(room.data[i].triangles, room.data[i].desc.triangle_count, sizeof *room.data[i].triangles);
    }
    permute(context, &room, 0, "triangles reversed");

    /* A sum of floats depends on the order of its terms. */
    room_prepare(&room);
    reverse(room.lights, ROOM_LAMPS, sizeof *room.lights);
    permute(context, &room, 1e-6, "lights reversed");
}

/* Many instances of few meshes. */
static void instances_have_no_order(pnb_context *context) {
    struct test_scene *fence = test_scene_create("fence", NULL);
    if (!CHECK(fence != NULL)) {
        return;
    }
    pnb_scene scene = *test_scene_get(fence);
    pnb_settings settings = *test_scene_settings(fence);
    settings.width = 320;
    settings.height = 180;
    pnb_job *expected = render(context, &scene, &settings);
    pnb_instance *instances = malloc(scene.instance_count * sizeof *instances);
    if (CHECK(instances != NULL)) {
        memcpy(instances, scene.instances, scene.instance_count * sizeof *instances);
        reverse(instances, scene.instance_count, sizeof *instances);
        scene.instances = instances;
        pnb_job *permuted = render(context, &scene, &settings);
        CHECK_INT((long long)count_different(expected, permuted, 0), 0);
        pnb_job_destroy(&permuted);
    }
    pnb_job_destroy(&expected);
    free(instances);
    test_scene_destroy(&fence);
}

/* ---- Scale --------------------------------------------------------------------------------------------------- */

static void scale_room(struct room *room, float scale) {
    for (int i = 0; i < ROOM_MESHES; ++i) {
        for (int j = 0; j < 15; ++j) {
            room->instances[i].matrix[j] *= scale;
        }
    }
    for (int i = 0; i < ROOM_LAMPS; ++i) {
        pnb_light *light = &room->lights[i];
        for (int j = 12; j < 15; ++j) {
            light->matrix[j] *= scale;
        }
        light->size[0] *= scale;
        light->size[1] *= scale;
        light->radius *= scale;
    }
    for (int j = 12; j < 15; ++j) {
        room->scene.camera.matrix[j] *= scale;
    }
    room->scene.camera.clip_start = 0.1f * scale;
    room->scene.camera.clip_end = 100 * scale;
}

/* From millimetres to ten thousand kilometres, by powers of two, so that no rounding differs. */
static void scale_does_not_count(pnb_context *context, const char *technique) {
    static const int exponents[] = {0, -10, -5, 10, 20, 24};
    pnb_job *expected = NULL;
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; ++i) {
        struct room room;
        room_prepare(&room);
        scale_room(&room, ldexpf(1, exponents[i]));
        room.settings.technique = technique;
        room.settings.passes = PNB_PASS_NORMAL | PNB_PASS_LIGHT_SHADOWS;
        pnb_job *job = render_room(context, &room);
        const size_t different = i == 0 ? 0 : count_different(expected, job, 0);
        if (!CHECK_INT((long long)different, 0)) {
            printf("with %s, scaled by 2^%d\n", technique, exponents[i]);
        }
        if (i == 0) {
            expected = job;
        } else {
            pnb_job_destroy(&job);
        }
    }
    pnb_job_destroy(&expected);
}

static void scales_do_not_count(pnb_context *context) {
    for (uint32_t i = 0; i < pnb_technique_count(); ++i) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        pnb_technique_get_info(i, &info);
        scale_does_not_count(context, info.id);
    }
}

/* ---- History ------------------------------------------------------------------------------------------------- */

/* A red and a green floor at one height: at every pixel depths are equal, so that the first drawn wins. */
static void room_with_two_floors(struct room *room) {
    room_prepare(room);
    struct room_mesh *floor = &room->data[ROOM_FLOOR], *leaf = &room->data[ROOM_LEAF];
    memcpy(leaf->positions, floor->positions, sizeof leaf->positions);
    for (int i = 0; i < 16; ++i) {
        (&room->pixels[0][0])[i][3] = 1; /* opaque */
    }
}

/* Meshes that are in OpenGL memory already, in another order, or were and are gone again. */
static void history_does_not_count(pnb_context *context) {
    struct room room;
    room_with_two_floors(&room);
    pnb_job *expected = render_room(context, &room);
    for (int first = 0; first < ROOM_MESHES; ++first) {
        for (int i = 0; i < 12; ++i) {
            room_with_two_floors(&room);
            room.scene.instances = &room.instances[first];
            room.scene.instance_count = 1;
            pnb_job *other = render_room(context, &room);
            pnb_job_destroy(&other);
        }
        room_with_two_floors(&room);
        pnb_job *again = render_room(context, &room);
        CHECK_INT((long long)count_different(expected, again, 0), 0);
        pnb_job_destroy(&again);
    }
    pnb_job_destroy(&expected);
}

/* ---- Surroundings -------------------------------------------------------------------------------------------- */

/* In a process of its own: prints the decimal point and a hash of what every technique makes of the room. */
static int print_hash(const char *folder) {
    pnb_context *context = NULL;
    uint64_t sum = 0;
    setlocale(LC_ALL, "");
    if (chdir(folder) != 0 || create_context(NULL, &context) != PNB_OK) {
        return 1;
    }
    for (uint32_t i = 0; i < pnb_technique_count(); ++i) {
        struct room room;
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        pnb_technique_get_info(i, &info);
        room_prepare(&room);
        room.settings.technique = info.id;
        pnb_job *job = render_room(context, &room);
        sum = 31 * sum + images_hash(job);
        pnb_job_destroy(&job);
    }
    pnb_context_destroy(&context);
    printf("decimal point %s\nimages %016" PRIx64 "\n", localeconv()->decimal_point, sum);
    return checks_failed > 0 || memory_live_blocks() != 0;
}

static void hash_in(const struct spawn *spawn, char *output, size_t size) {
    int status = spawn_self(spawn, output, size);
    if (!CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
        printf("%s", output);
    }
}

static void surroundings_do_not_count(void) {
    char expected[1024], output[1024], locales[] = "/tmp/penumbra_locale_XXXXXX", command[256], path[256];
    hash_in(&(struct spawn){.argument = ".", .variables = {"LC_ALL=C"}}, expected, sizeof expected);
    CHECK_CONTAINS(expected, "decimal point .\n");
    const char *images = strstr(expected, "images");
    if (!CHECK(images != NULL && mkdtemp(locales) != NULL)) {
        return;
    }
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 2>/dev/null", locales);
    snprintf(path, sizeof path, "LOCPATH=%s", locales);
    if (system(command) == 0) {
        hash_in(&(struct spawn){.argument = ".", .variables = {path, "LC_ALL=de_DE.UTF-8"}}, output, sizeof output);
        CHECK_CONTAINS(output, "decimal point ,\n");
        CHECK_CONTAINS(output, images);
    } else {
        printf("not tested: a decimal comma; localedef cannot make the locale de_DE\n");
    }
    /* "NAME" alone removes a variable. */
    const mode_t mask = umask(0777);
    hash_in(&(struct spawn){.argument = "/", .variables = {"HOME", "XDG_CACHE_HOME", "PATH", "TMPDIR=/nonexistent"}},
            output, sizeof output);
    umask(mask);
    CHECK_CONTAINS(output, images);
    snprintf(command, sizeof command, "rm -rf %s", locales);
    CHECK_INT(system(command), 0);
}

int main(int argc, char **argv) {
    if (argc > 1) {
        return print_hash(argv[1]);
    }
    pnb_context *context = NULL;
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    order_does_not_count(context);
    instances_have_no_order(context);
    history_does_not_count(context);
    scales_do_not_count(context);
    pnb_context_destroy(&context);
    surroundings_do_not_count();
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
