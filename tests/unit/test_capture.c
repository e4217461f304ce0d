/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "example_scene.h"
#include "memory.h"
#include "scene/capture.h"
#include "scene/content_key.h"

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- An example, its capture in memory, and a folder for files ---- */

struct fixture {
    int64_t blocks;
    struct example example;
    struct byte_writer file; /* the example, encoded */
    char folder[256], path[300];
};

static int setup(void **state) {
    static struct fixture fixture;
    memset(&fixture, 0, sizeof fixture);
    *state = &fixture;
    fixture.blocks = memory_live_blocks();
    const char *parent = getenv("TMPDIR");
    snprintf(fixture.folder, sizeof fixture.folder, "%s/penumbra-capture-XXXXXX", parent ? parent : P_tmpdir);
    if (!mkdtemp(fixture.folder) || example_create(&fixture.example) != PNB_OK) {
        return -1;
    }
    snprintf(fixture.path, sizeof fixture.path, "%s/frame.pnb", fixture.folder);
    return capture_encode(&fixture.example.scene, &fixture.example.settings, &fixture.file) == PNB_OK ? 0 : -1;
}

/* Every test ends with all memory given back and at most its own file in the folder: nothing half-written. */
static int teardown(void **state) {
    struct fixture *fixture = *state;
    memory_free(fixture->file.data);
    example_destroy(&fixture->example);
    unlink(fixture->path);
    bool clean = rmdir(fixture->folder) == 0;
    return clean && memory_live_blocks() == fixture->blocks ? 0 : -1;
}

static pnb_result write_example(struct fixture *fixture) {
    return pnb_capture_write(fixture->path, &fixture->example.scene, &fixture->example.settings);
}

/* The file's bytes, to be freed. */
static unsigned char *load(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    unsigned char *data = malloc(1 << 20);
    assert_non_null(data);
    *size = fread(data, 1, 1 << 20, file);
    fclose(file);
    return data;
}

static void store(const char *path, const void *data, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void assert_error(const char *part) {
    if (!strstr(pnb_last_error(), part)) {
        print_error("\"%s\" lacks \"%s\"\n", pnb_last_error(), part);
        fail();
    }
}

/* Decodes from a block of exactly this size, so that a sanitizer sees the first byte read beyond it. */
static pnb_result decode_copy(const unsigned char *data, size_t size, pnb_capture **capture) {
    unsigned char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    pnb_result result = capture_decode(copy, size, capture);
    free(copy);
    return result;
}

/* ---- Good captures ---- */

static void captures_are_written_back_exactly(void **state) {
    struct fixture *fixture = *state;
    pnb_capture *capture = NULL;
    assert_int_equal(write_example(fixture), PNB_OK);
    size_t first_size, second_size;
    unsigned char *first = load(fixture->path, &first_size);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_OK);
    assert_int_equal(pnb_capture_write(fixture->path, pnb_capture_scene(capture), pnb_capture_settings(capture)),
                     PNB_OK);
    unsigned char *second = load(fixture->path, &second_size);
    assert_int_equal(first_size, second_size);
    assert_memory_equal(first, second, first_size);
    assert_int_equal(first_size, fixture->file.size);
    assert_memory_equal(first, fixture->file.data, first_size);
    pnb_capture_destroy(&capture);
    assert_null(capture);
    free(first);
    free(second);
}

static void assert_same_text(const char *a, const char *b) {
    assert_true(a && b ? strcmp(a, b) == 0 : a == b);
}

/* Pointers aside, the structures are compared as a whole: a member that is not stored would differ. */
static void everything_survives(void **state) {
    struct fixture *fixture = *state;
    const struct example *example = &fixture->example;
    pnb_capture *capture = NULL;
    assert_int_equal(decode_copy(fixture->file.data, fixture->file.size, &capture), PNB_OK);
    const pnb_scene *scene = pnb_capture_scene(capture);
    assert_int_equal(scene->instance_count, 4);
    for (uint32_t i = 0; i < 4; i++) {
        pnb_instance copy = scene->instances[i];
        const pnb_instance *instance = &example->instances[i];
        assert_same_text(copy.name, instance->name);
        assert_same_text(copy.mesh->name, instance->mesh->name);
        assert_same_text(pnb_mesh_warning(copy.mesh), pnb_mesh_warning(instance->mesh));
        assert_true(content_key_equal(&copy.mesh->content, &instance->mesh->content));
        assert_memory_equal(copy.mesh->bounds, instance->mesh->bounds, sizeof copy.mesh->bounds);
        copy.name = instance->name;
        copy.mesh = instance->mesh;
        assert_memory_equal(&copy, instance, sizeof copy);
        pnb_light light = scene->lights[i];
        assert_same_text(light.name, example->lights[i].name);
        assert_same_text(light.technique, example->lights[i].technique);
        light.name = example->lights[i].name;
        light.technique = example->lights[i].technique;
        assert_memory_equal(&light, &example->lights[i], sizeof light);
        assert_int_equal(scene->slots[i], example->slots[i]);
    }
    assert_ptr_equal(scene->instances[1].mesh, scene->instances[2].mesh); /* shared */
    for (uint32_t i = 0; i < 3; i++) {
        pnb_material copy = scene->materials[i];
        copy.base_color_texture = example->materials[i].base_color_texture;
        copy.alpha_texture = example->materials[i].alpha_texture;
        copy.emission_texture = example->materials[i].emission_texture;
        assert_memory_equal(&copy, &example->materials[i], sizeof copy);
    }
    const pnb_texture *texture = scene->materials[1].base_color_texture;
    assert_ptr_equal(texture, scene->materials[1].alpha_texture);
    assert_ptr_equal(texture, scene->materials[1].emission_texture);
    assert_null(scene->materials[0].base_color_texture);
    assert_string_equal(texture->name, "Colors");
    assert_true(content_key_equal(&texture->content, &example->colors->content));
    assert_true(texture->has_alpha && !scene->materials[2].alpha_texture->has_alpha);
    assert_memory_equal(&scene->camera, &example->scene.camera, sizeof scene->camera);
    assert_memory_equal(scene->world_color, example->scene.world_color, sizeof scene->world_color);
    pnb_settings settings = *pnb_capture_settings(capture);
    assert_same_text(settings.technique, "PCSS");
    for (uint32_t i = 0; i < 2; i++) {
        assert_same_text(settings.values[i].name, example->values[i].name);
        assert_true(settings.values[i].value == example->values[i].value);
    }
    settings.technique = example->settings.technique;
    settings.values = example->settings.values;
    assert_memory_equal(&settings, &example->settings, offsetof(pnb_settings, passes) + sizeof settings.passes);
    pnb_capture_destroy(&capture);
}

/* What the host gave is kept as it is, even where rendering would clamp it. */
static void unusable_numbers_survive(void **state) {
    struct fixture *fixture = *state;
    fixture->example.instances[1].matrix[3] = NAN;
    fixture->example.lights[0].emission[0] = -INFINITY;
    fixture->example.values[0].value = (double)NAN;
    fixture->example.settings.technique = NULL;
    struct byte_writer again = {0}, file = {0};
    assert_int_equal(capture_encode(&fixture->example.scene, &fixture->example.settings, &file), PNB_OK);
    pnb_capture *capture = NULL;
    assert_int_equal(decode_copy(file.data, file.size, &capture), PNB_OK);
    assert_true(isnan(pnb_capture_scene(capture)->instances[1].matrix[3]));
    assert_null(pnb_capture_settings(capture)->technique);
    assert_int_equal(capture_encode(pnb_capture_scene(capture), pnb_capture_settings(capture), &again), PNB_OK);
    assert_int_equal(file.size, again.size);
    assert_memory_equal(file.data, again.data, file.size);
    pnb_capture_destroy(&capture);
    memory_free(again.data);
    memory_free(file.data);
}

static void empty_scenes_survive(void **state) {
    struct fixture *fixture = *state;
    fixture->example.scene = (pnb_scene){.struct_size = sizeof(pnb_scene), .camera = PNB_INIT(pnb_camera)};
    fixture->example.settings = (pnb_settings)PNB_INIT(pnb_settings);
    pnb_capture *capture = NULL;
    assert_int_equal(write_example(fixture), PNB_OK);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_OK);
    assert_int_equal(pnb_capture_scene(capture)->instance_count, 0);
    pnb_capture_destroy(&capture);
}

static void unnamed_lights_survive(void **state) {
    struct fixture *fixture = *state;
    for (int i = 0; i < 4; i++) {
        fixture->example.lights[i].name = NULL;
        fixture->example.instances[i].name = NULL;
    }
    pnb_capture *capture = NULL;
    assert_int_equal(write_example(fixture), PNB_OK);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_OK);
    assert_null(pnb_capture_scene(capture)->lights[3].name);
    pnb_capture_destroy(&capture);
}

/* Many instances of one mesh cost their matrices and names. */
static void meshes_are_stored_once(void **state) {
    struct fixture *fixture = *state;
    enum { COUNT = 5000 };
    pnb_instance *instances = calloc(COUNT, sizeof *instances);
    assert_non_null(instances);
    for (int i = 0; i < COUNT; i++) {
        instances[i] = fixture->example.instances[i % 2];
        instances[i].name = NULL;
    }
    fixture->example.scene.instances = instances;
    fixture->example.scene.instance_count = COUNT;
    struct byte_writer file = {0};
    assert_int_equal(capture_encode(&fixture->example.scene, &fixture->example.settings, &file), PNB_OK);
    assert_true(file.size < fixture->file.size + COUNT * (fields_size(&instance_fields) + 2 * sizeof(uint32_t)));
    pnb_capture *capture = NULL;
    assert_int_equal(decode_copy(file.data, file.size, &capture), PNB_OK);
    assert_int_equal(capture->mesh_count, 2);
    pnb_capture_destroy(&capture);
    memory_free(file.data);
    free(instances);
}

/* ---- Damage ---- */

static void truncation_is_found_at_every_byte(void **state) {
    struct fixture *fixture = *state;
    for (size_t size = 0; size < fixture->file.size; size++) {
        pnb_capture *capture = NULL;
        assert_int_equal(decode_copy(fixture->file.data, size, &capture), PNB_ERROR_FILE);
        assert_null(capture);
        assert_error("truncated");
    }
    for (size_t size = 0; size < fixture->file.size; size += 97) {
        pnb_capture *capture = NULL;
        store(fixture->path, fixture->file.data, size);
        assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
        assert_error("frame.pnb");
        assert_error("truncated");
    }
}

static void every_flipped_bit_is_found(void **state) {
    struct fixture *fixture = *state;
    for (size_t bit = 0; bit < 8 * fixture->file.size; bit++) {
        unsigned char *byte = &fixture->file.data[bit / 8], mask = (unsigned char)(1u << bit % 8);
        pnb_capture *capture = NULL;
        *byte ^= mask;
        assert_int_equal(capture_decode(fixture->file.data, fixture->file.size, &capture), PNB_ERROR_FILE);
        *byte ^= mask;
        assert_null(capture);
    }
}

static void foreign_files_are_refused(void **state) {
    struct fixture *fixture = *state;
    pnb_capture *capture = NULL;
    unsigned char *longer = calloc(fixture->file.size + 1, 1);
    assert_non_null(longer);
    memcpy(longer, fixture->file.data, fixture->file.size);
    store(fixture->path, longer, fixture->file.size + 1);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
    assert_error("it is damaged");
    longer[4] = CAPTURE_VERSION + 1;
    store(fixture->path, longer, fixture->file.size);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
    assert_error("has format version 7");
    memcpy(longer, "BLENDER-v304RENDH", 17);
    store(fixture->path, longer, fixture->file.size);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
    assert_error("not a Penumbra capture");
    free(longer);
    assert_null(capture);
}

/* ---- Forgery: damage with the right checksum ---- */

struct section {
    size_t entry, start, size; /* offset of the table entry, offset and size of the data */
};

static struct section find_section(const struct byte_writer *file, int wanted) {
    size_t entry = CAPTURE_HEADER_SIZE + sizeof(uint32_t);
    struct section section = {entry, entry + SECTION_COUNT * sizeof(struct section_entry), 0};
    for (int i = 0;; i++, section.entry += sizeof(struct section_entry), section.start += section.size) {
        struct section_entry found;
        memcpy(&found, file->data + section.entry, sizeof found);
        section.size = (size_t)found.size;
        if (i == wanted) {
            return section;
        }
    }
}

/* Overwrites bytes, corrects the checksum and expects a refusal that says `part`. */
static void assert_forgery_found(const struct fixture *fixture, size_t offset, const void *bytes, size_t size,
                                 const char *part) {
    assert_true(offset + size <= fixture->file.size);
    unsigned char *copy = malloc(fixture->file.size);
    assert_non_null(copy);
    memcpy(copy, fixture->file.data, fixture->file.size);
    memcpy(copy + offset, bytes, size);
    struct content_key key = {{0}};
    content_key_add(&key, copy + CAPTURE_HEADER_SIZE, fixture->file.size - CAPTURE_HEADER_SIZE);
    memcpy(copy + CAPTURE_KEY_OFFSET, &key, sizeof key);
    pnb_capture *capture = NULL;
    assert_int_equal(capture_decode(copy, fixture->file.size, &capture), PNB_ERROR_FILE);
    assert_null(capture);
    assert_error(part);
    free(copy);
}

static void assert_number_found(const struct fixture *fixture, size_t offset, uint32_t number, const char *part) {
    assert_forgery_found(fixture, offset, &number, sizeof number, part);
}

static void forged_meshes_are_found(void **state) {
    struct fixture *fixture = *state;
    const struct pnb_mesh *plane = fixture->example.plane; /* the first mesh */
    struct section section = find_section(&fixture->file, SECTION_MESHES);
    size_t name = section.start, warning = name + 4 + strlen(plane->name);
    size_t counts = warning + 4 + strlen(plane->warning), vertices = counts + 12;
    size_t indices = vertices + plane->vertex_count * sizeof(struct vertex);
    size_t ranges = indices + plane->index_count * sizeof(uint32_t);
    const uint32_t not_finite = 0x7fc00000;
    assert_number_found(fixture, name, STRING_ABSENT - 1, "name");
    assert_number_found(fixture, name, STRING_ABSENT, "name");
    assert_forgery_found(fixture, name + 4, "", 1, "name"); /* a zero inside */
    for (size_t i = 0; i < 3; i++) {
        assert_number_found(fixture, counts + 4 * i, UINT32_MAX, "too early");
        assert_number_found(fixture, counts + 4 * i, 0, "section MESH");
    }
    assert_number_found(fixture, vertices, not_finite, "vertex 0 is not finite");
    assert_number_found(fixture, vertices + offsetof(struct vertex, uv), not_finite, "vertex 0 is not finite");
    assert_number_found(fixture, indices + 4, plane->vertex_count, "mesh 'Plane': vertex 4 does not exist");
    assert_number_found(fixture, ranges + offsetof(struct mesh_range, slot), 32768, "range 0");
    assert_number_found(fixture, ranges + offsetof(struct mesh_range, first_index), 3, "range 0");
    assert_number_found(fixture, ranges + offsetof(struct mesh_range, index_count), 0, "range 0");
    assert_number_found(fixture, ranges + offsetof(struct mesh_range, index_count), 4, "range 0");
    assert_number_found(fixture, ranges + offsetof(struct mesh_range, index_count), 9, "do not cover");
}

static void forged_textures_are_found(void **state) {
    struct fixture *fixture = *state;
    struct section section = find_section(&fixture->file, SECTION_TEXTURES);
    size_t size = section.start + 4 + strlen("Colors"), texels = size + 16;
    assert_number_found(fixture, size, 0, "its size is broken");
    assert_number_found(fixture, size, 16385, "its size is broken");
    assert_number_found(fixture, size + 4, 16384, "too early");
    assert_number_found(fixture, size + 8, 2, "its size is broken");
    static const float bad[] = {-1, 65505, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++) {
        assert_forgery_found(fixture, texels + 16, &bad[i], sizeof bad[i], "texture 'Colors': texel 1 is out of range");
    }
    assert_forgery_found(fixture, texels + 12, &(float){1.5f}, 4, "texel 0 is out of range"); /* alpha */
}

static void forged_references_are_found(void **state) {
    struct fixture *fixture = *state;
    struct section materials = find_section(&fixture->file, SECTION_MATERIALS);
    size_t reference = materials.start + fields_size(&material_fields);
    assert_number_found(fixture, reference, 2, "texture 2 does not exist");
    assert_number_found(fixture, reference, 1, "out of order");
    size_t last = materials.start + materials.size - 2 * sizeof(uint32_t); /* the only use of texture 1 */
    assert_number_found(fixture, last, 0, "more than is used");
    struct section instances = find_section(&fixture->file, SECTION_INSTANCES);
    assert_number_found(fixture, instances.start, 2, "mesh 2 does not exist");
    assert_number_found(fixture, instances.start, 1, "out of order");
    size_t second = instances.start + 8 + strlen("Floor") + fields_size(&instance_fields);
    assert_number_found(fixture, second + 8 + strlen("Left"), 0x80000000u, "unknown flags");
    assert_number_found(fixture, second, UINT32_MAX, "does not exist");
    struct section lights = find_section(&fixture->file, SECTION_LIGHTS);
    assert_number_found(fixture, lights.start + 4 + strlen("Lamp") + 4 + 4, 9, "unknown type 9");
    struct section settings = find_section(&fixture->file, SECTION_SETTINGS);
    size_t technique = settings.start + fields_size(&settings_fields);
    assert_number_found(fixture, technique, 1000, "name");
    size_t name = fixture->file.size - sizeof(double) - strlen("light_size_scale") - sizeof(uint32_t);
    assert_number_found(fixture, name, 100, "a name is broken"); /* no zero up to the end, and beyond it */
    assert_number_found(fixture, technique + 4 + strlen("PCSS"), STRING_ABSENT, "name is missing");
}

static void forged_tables_are_found(void **state) {
    struct fixture *fixture = *state;
    assert_number_found(fixture, CAPTURE_HEADER_SIZE, SECTION_COUNT + 1, "section table");
    for (int i = 0; i < SECTION_COUNT; i++) {
        struct section section = find_section(&fixture->file, i);
        assert_forgery_found(fixture, section.entry, "XXXX", 4, "is missing");
        assert_number_found(fixture, section.entry + 4, UINT32_MAX, capture_tags[i]);
        assert_number_found(fixture, section.entry + 4, 0, "");
        for (int change = -1; change <= 1; change += 2) {
            uint64_t size = section.size + (uint64_t)(int64_t)change;
            assert_forgery_found(fixture, section.entry + 8, &size, sizeof size, capture_tags[i]);
        }
        assert_forgery_found(fixture, section.entry + 8, &(uint64_t){UINT64_MAX}, 8, capture_tags[i]);
    }
}

/* ---- Files ---- */

static uint32_t count_files(const char *folder) {
    DIR *stream = opendir(folder);
    assert_non_null(stream);
    uint32_t count = 0;
    while (readdir(stream)) {
        count++;
    }
    closedir(stream);
    return count - 2; /* . and .. */
}

static void unreadable_paths_are_errors(void **state) {
    struct fixture *fixture = *state;
    pnb_capture *capture = NULL;
    assert_int_equal(pnb_capture_read(NULL, &capture), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_read("", &capture), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_read(fixture->path, NULL), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
    assert_error("No such file");
    assert_int_equal(pnb_capture_read(fixture->folder, &capture), PNB_ERROR_FILE);
    assert_error("not a regular file");
    assert_int_equal(mkfifo(fixture->path, 0600), 0);
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE); /* and does not wait */
    assert_error("not a regular file");
    assert_null(capture);
    assert_null(pnb_capture_scene(NULL));
    assert_null(pnb_capture_settings(NULL));
    pnb_capture_destroy(&capture);
    pnb_capture_destroy(NULL);
}

static void unwritable_paths_are_errors(void **state) {
    struct fixture *fixture = *state;
    const struct example *example = &fixture->example;
    assert_int_equal(pnb_capture_write(NULL, &example->scene, &example->settings), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_write("", &example->scene, &example->settings), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_write(fixture->folder, &example->scene, &example->settings), PNB_ERROR_FILE);
    assert_error("not a regular file");
    char missing[400];
    snprintf(missing, sizeof missing, "%s/missing/frame.pnb", fixture->folder);
    assert_int_equal(pnb_capture_write(missing, &example->scene, &example->settings), PNB_ERROR_FILE);
    assert_error("missing/frame.pnb");
    assert_int_equal(mkfifo(fixture->path, 0600), 0);
    assert_int_equal(write_example(fixture), PNB_ERROR_FILE); /* a device must not be replaced by a file */
    struct stat status;
    assert_true(stat(fixture->path, &status) == 0 && S_ISFIFO(status.st_mode));
    assert_int_equal(count_files(fixture->folder), 1);
}

/* A limit on the size of files acts like a full disk. */
static void full_disks_leave_nothing_behind(void **state) {
    struct fixture *fixture = *state;
    static const char old[] = "what was there before";
    store(fixture->path, old, sizeof old);
    struct rlimit before, limit;
    getrlimit(RLIMIT_FSIZE, &before);
    limit = before;
    limit.rlim_cur = 100;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    pnb_result result = write_example(fixture);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    assert_int_equal(result, PNB_ERROR_FILE);
    assert_error("cannot write");
    assert_int_equal(count_files(fixture->folder), 1);
    size_t size;
    unsigned char *kept = load(fixture->path, &size);
    assert_int_equal(size, sizeof old);
    assert_memory_equal(kept, old, sizeof old);
    free(kept);
    assert_int_equal(write_example(fixture), PNB_OK);
    assert_int_equal(count_files(fixture->folder), 1);
}

/* A sparse file of 1 TiB whose header fits its size. */
static void files_larger_than_memory_are_refused(void **state) {
    struct fixture *fixture = *state;
    const uint64_t size = (uint64_t)1 << 40;
    memcpy(fixture->file.data + 8, &size, sizeof size);
    store(fixture->path, fixture->file.data, fixture->file.size);
    if (truncate(fixture->path, (off_t)size) != 0) {
        print_message("no file of 1 TiB can be made here\n");
        return;
    }
    pnb_capture *capture = NULL;
    assert_int_equal(pnb_capture_read(fixture->path, &capture), PNB_ERROR_FILE);
    assert_error("do not fit into memory");
}

static void broken_descriptions_are_errors(void **state) {
    struct fixture *fixture = *state;
    struct example *example = &fixture->example;
    assert_int_equal(pnb_capture_write(fixture->path, NULL, &example->settings), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_capture_write(fixture->path, &example->scene, NULL), PNB_ERROR_INVALID_ARGUMENT);
    example->settings.struct_size++;
    assert_int_equal(write_example(fixture), PNB_ERROR_INVALID_ARGUMENT);
    example->settings.struct_size--;
    example->values[1].name = NULL;
    assert_int_equal(write_example(fixture), PNB_ERROR_INVALID_ARGUMENT);
    assert_error("values[1]");
    example->settings.values = NULL;
    assert_int_equal(write_example(fixture), PNB_ERROR_INVALID_ARGUMENT);
    example_settings(example);
    example->instances[3].mesh = NULL;
    assert_int_equal(write_example(fixture), PNB_ERROR_INVALID_ARGUMENT);
    assert_error("instance 3");
    assert_int_equal(count_files(fixture->folder), 0);
}

/* ---- Memory ---- */

static void every_allocation_may_fail(void **state) {
    struct fixture *fixture = *state;
    int64_t before = memory_live_blocks();
    uint64_t writing = 0, reading = 0;
    pnb_result result;
    do {
        memory_fail_at(writing + 1);
        result = write_example(fixture);
        memory_fail_at(0);
        assert_true(result == PNB_OK || result == PNB_ERROR_OUT_OF_MEMORY);
        assert_int_equal(memory_live_blocks(), before);
        assert_int_equal(count_files(fixture->folder), result == PNB_OK);
        writing++;
    } while (result != PNB_OK);
    do {
        pnb_capture *capture = NULL;
        memory_fail_at(reading + 1);
        result = pnb_capture_read(fixture->path, &capture);
        memory_fail_at(0);
        assert_true(result == PNB_OK ? capture != NULL : result == PNB_ERROR_OUT_OF_MEMORY && !capture);
        pnb_capture_destroy(&capture);
        assert_int_equal(memory_live_blocks(), before);
        reading++;
    } while (result != PNB_OK);
    print_message("%d allocations failed writing, %d reading\n", (int)writing - 1, (int)reading - 1);
    assert_true(writing > 6 && reading > 25);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, setup, teardown)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(captures_are_written_back_exactly),
        TEST(everything_survives),
        TEST(unusable_numbers_survive),
        TEST(empty_scenes_survive),
        TEST(unnamed_lights_survive),
        TEST(meshes_are_stored_once),
        TEST(truncation_is_found_at_every_byte),
        TEST(every_flipped_bit_is_found),
        TEST(foreign_files_are_refused),
        TEST(forged_meshes_are_found),
        TEST(forged_textures_are_found),
        TEST(forged_references_are_found),
        TEST(forged_tables_are_found),
        TEST(unreadable_paths_are_errors),
        TEST(unwritable_paths_are_errors),
        TEST(full_disks_leave_nothing_behind),
        TEST(files_larger_than_memory_are_refused),
        TEST(broken_descriptions_are_errors),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
