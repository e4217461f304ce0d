/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads captures from bytes that may be anything: a hash can be forged, so every count, index and number is checked
 * before it is used, and nothing is allocated that the bytes at hand could not fill. */
#include "../memory.h"
#include "capture.h"
#include "content_key.h"
#include "mesh.h"
#include "numbers.h"
#include "scene_parts.h"
#include "texture.h"

#include <inttypes.h>
#include <string.h>

#define DAMAGED(...) error_set(PNB_ERROR_FILE, __VA_ARGS__)

struct decoder {
    struct byte_reader reader; /* of one section */
    uint32_t count;            /* elements of it */
    pnb_capture *capture;
    uint32_t used_meshes, used_textures;
};

/* ---- Pieces ---- */

/* Allocates and reads count * size bytes that must be there. */
static pnb_result decode_array(struct byte_reader *reader, uint64_t count, size_t size, void *array) {
    if (reader->failed || count > reader->left / size) {
        return DAMAGED("data ends too early");
    }
    void *block = memory_array((size_t)count, size);
    if (!block) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    read_bytes(reader, block, (size_t)count * size);
    memcpy(array, &block, sizeof block);
    return PNB_OK;
}

/* NULL is read as NULL. */
static pnb_result decode_string(struct byte_reader *reader, const char **text) {
    uint32_t length = read_u32(reader);
    if (!reader->failed && length == STRING_ABSENT) {
        *text = NULL;
        return PNB_OK;
    }
    if (reader->failed || length > reader->left || memchr(reader->next, '\0', length)) {
        return DAMAGED("a name is broken");
    }
    char *copy = memory_array((size_t)length + 1, 1);
    if (!copy) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    read_bytes(reader, copy, length);
    *text = copy;
    return PNB_OK;
}

static pnb_result decode_present_string(struct byte_reader *reader, char **text) {
    const char *read = NULL;
    pnb_result result = decode_string(reader, &read);
    if (result == PNB_OK && !read) {
        return DAMAGED("a name is missing");
    }
    if (result == PNB_OK) {
        memory_free(*text);
        *text = (char *)read;
    }
    return result;
}

/* Allocates the elements of a section that has at least `smallest` bytes for each. */
static pnb_result decode_elements(struct decoder *decoder, size_t smallest, size_t size, void *array) {
    if (decoder->count > decoder->reader.left / smallest) {
        return DAMAGED("data ends too early");
    }
    void *block = memory_array(decoder->count, size);
    if (!block) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    memcpy(array, &block, sizeof block);
    return PNB_OK;
}

/* ---- Meshes ---- */

static pnb_result mesh_check_ranges(const pnb_mesh *mesh) {
    uint64_t next = 0;
    for (uint32_t i = 0; i < mesh->range_count; i++) {
        const struct mesh_range *range = &mesh->ranges[i];
        bool ascending = i == 0 || range->slot > mesh->ranges[i - 1].slot;
        if (!ascending || range->slot > MESH_MAX_SLOT || range->first_index != next || range->index_count == 0 ||
            range->index_count % 3 != 0) {
            return DAMAGED("mesh '%s': range %" PRIu32 " is broken", mesh->name, i);
        }
        next += range->index_count;
    }
    if (next != mesh->index_count) {
        return DAMAGED("mesh '%s': its ranges do not cover its triangles", mesh->name);
    }
    return PNB_OK;
}

static pnb_result mesh_check_content(const pnb_mesh *mesh) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (!numbers_usable(mesh->vertices[i].position, 3) || !numbers_usable(mesh->vertices[i].uv, 2)) {
            return DAMAGED("mesh '%s': vertex %" PRIu32 " is not finite", mesh->name, i);
        }
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        if (mesh->indices[i] >= mesh->vertex_count) {
            return DAMAGED("mesh '%s': vertex %" PRIu32 " does not exist", mesh->name, mesh->indices[i]);
        }
    }
    return mesh_check_ranges(mesh);
}

static pnb_result decode_mesh(struct byte_reader *reader, pnb_mesh *mesh) {
    pnb_result result = decode_present_string(reader, &mesh->name);
    if (result == PNB_OK) {
        result = decode_present_string(reader, &mesh->warning);
    }
    mesh->vertex_count = read_u32(reader);
    mesh->index_count = read_u32(reader);
    mesh->range_count = read_u32(reader);
    if (result == PNB_OK) {
        result = decode_array(reader, mesh->vertex_count, sizeof *mesh->vertices, &mesh->vertices);
    }
    if (result == PNB_OK) {
        result = decode_array(reader, mesh->index_count, sizeof *mesh->indices, &mesh->indices);
    }
    if (result == PNB_OK) {
        result = decode_array(reader, mesh->range_count, sizeof *mesh->ranges, &mesh->ranges);
    }
    if (result == PNB_OK) {
        result = mesh_check_content(mesh);
    }
    if (result == PNB_OK) {
        mesh_finish(mesh);
    }
    return result;
}

static pnb_result decode_meshes(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    pnb_result result = decode_elements(decoder, 5 * sizeof(uint32_t), sizeof *capture->meshes, &capture->meshes);
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        capture->meshes[i] = mesh_allocate(NULL);
        if (!capture->meshes[i]) {
            return PNB_ERROR_OUT_OF_MEMORY;
        }
        capture->mesh_count++;
        result = decode_mesh(&decoder->reader, capture->meshes[i]);
    }
    return result;
}

/* ---- Textures and materials ---- */

static pnb_result texture_check_content(const pnb_texture *texture) {
    size_t count = (size_t)texture->width * texture->height * 4;
    for (size_t i = 0; i < count; i++) {
        float value = texture->rgba[i], maximum = i % 4 == 3 ? 1 : TEXTURE_MAX_COLOR;
        bool good = value >= 0 && value <= maximum && (i % 4 < 3 || texture->has_alpha || value == 1);
        if (!good) {
            return DAMAGED("texture '%s': texel %zu is out of range", texture->name, i / 4);
        }
    }
    return PNB_OK;
}

static pnb_result decode_texture(struct byte_reader *reader, pnb_texture *texture) {
    pnb_result result = decode_present_string(reader, &texture->name);
    uint32_t width = read_u32(reader), height = read_u32(reader), has_alpha = read_u32(reader);
    uint32_t flags = read_u32(reader);
    if (result != PNB_OK) {
        return result;
    }
    if (width < 1 || width > TEXTURE_MAX_SIDE || height < 1 || height > TEXTURE_MAX_SIDE || has_alpha > 1 ||
        (flags & ~TEXTURE_FLAGS)) {
        return DAMAGED("texture '%s': its size is broken", texture->name);
    }
    texture->width = width;
    texture->height = height;
    texture->has_alpha = has_alpha == 1;
    texture->flags = flags;
    result = decode_array(reader, (uint64_t)width * height, 4 * sizeof *texture->rgba, &texture->rgba);
    if (result == PNB_OK) {
        result = texture_check_content(texture);
    }
    if (result == PNB_OK) {
        texture_finish(texture);
    }
    return result;
}

static pnb_result decode_textures(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    pnb_result result = decode_elements(decoder, 5 * sizeof(uint32_t) + 4 * sizeof(float), sizeof *capture->textures,
                                        &capture->textures);
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        capture->textures[i] = texture_allocate(NULL);
        if (!capture->textures[i]) {
            return PNB_ERROR_OUT_OF_MEMORY;
        }
        capture->texture_count++;
        result = decode_texture(&decoder->reader, capture->textures[i]);
    }
    return result;
}

/* True for a number that was used before or is the next one. */
static bool number_is_next(uint32_t number, uint32_t count, uint32_t *used) {
    if (number >= count || number > *used) {
        return false;
    }
    *used += number == *used;
    return true;
}

static pnb_result decode_texture_reference(struct decoder *decoder, const pnb_texture **texture) {
    uint32_t number = read_u32(&decoder->reader);
    if (decoder->reader.failed || number == CAPTURE_NONE) {
        return PNB_OK;
    }
    if (!number_is_next(number, decoder->capture->texture_count, &decoder->used_textures)) {
        return DAMAGED("texture %" PRIu32 " does not exist or is out of order", number);
    }
    *texture = decoder->capture->textures[number];
    return PNB_OK;
}

static pnb_result decode_materials(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    size_t smallest = fields_size(&material_fields) + 3 * sizeof(uint32_t);
    pnb_result result = decode_elements(decoder, smallest, sizeof *capture->materials, &capture->materials);
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        pnb_material *material = &capture->materials[i];
        material->struct_size = sizeof *material;
        read_fields(&decoder->reader, &material_fields, material);
        result = decode_texture_reference(decoder, &material->base_color_texture);
        if (result == PNB_OK) {
            result = decode_texture_reference(decoder, &material->alpha_texture);
        }
        if (result == PNB_OK) {
            result = decode_texture_reference(decoder, &material->emission_texture);
        }
    }
    if (result == PNB_OK) {
        capture->scene.materials = capture->materials;
        capture->scene.material_count = decoder->count;
    }
    return result;
}

static pnb_result decode_slots(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    pnb_result result = decode_array(&decoder->reader, decoder->count, sizeof *capture->slots, &capture->slots);
    if (result == PNB_OK) {
        capture->scene.slots = capture->slots;
        capture->scene.slot_count = decoder->count;
    }
    return result;
}

/* ---- Instances, lights, view, settings ---- */

/* The counts grow with the elements, so that a partly read capture can be freed. */

static pnb_result decode_instances(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    size_t smallest = fields_size(&instance_fields) + 2 * sizeof(uint32_t);
    pnb_result result = decode_elements(decoder, smallest, sizeof *capture->instances, &capture->instances);
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        pnb_instance *instance = &capture->instances[i];
        instance->struct_size = sizeof *instance;
        uint32_t mesh = read_u32(&decoder->reader);
        if (!number_is_next(mesh, capture->mesh_count, &decoder->used_meshes)) {
            return DAMAGED("instance %" PRIu32 ": mesh %" PRIu32 " does not exist or is out of order", i, mesh);
        }
        instance->mesh = capture->meshes[mesh];
        capture->scene.instance_count++;
        result = decode_string(&decoder->reader, &instance->name);
        read_fields(&decoder->reader, &instance_fields, instance);
    }
    capture->scene.instances = capture->instances;
    return result;
}

static pnb_result decode_lights(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    size_t smallest = fields_size(&light_fields) + 2 * sizeof(uint32_t);
    pnb_result result = decode_elements(decoder, smallest, sizeof *capture->lights, &capture->lights);
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        pnb_light *light = &capture->lights[i];
        light->struct_size = sizeof *light;
        capture->scene.light_count++;
        result = decode_string(&decoder->reader, &light->name);
        if (result == PNB_OK) {
            result = decode_string(&decoder->reader, &light->technique);
        }
        read_fields(&decoder->reader, &light_fields, light);
    }
    capture->scene.lights = capture->lights;
    return result;
}

static pnb_result decode_view(struct decoder *decoder) {
    pnb_scene *scene = &decoder->capture->scene;
    read_fields(&decoder->reader, &camera_fields, &scene->camera);
    read_fields(&decoder->reader, &scene_fields, scene);
    return decoder->count == 1 ? PNB_OK : DAMAGED("there must be one camera");
}

static pnb_result decode_settings(struct decoder *decoder) {
    pnb_capture *capture = decoder->capture;
    const char *technique = NULL;
    read_fields(&decoder->reader, &settings_fields, &capture->settings);
    pnb_result result = decode_string(&decoder->reader, &technique);
    capture->technique = (char *)technique;
    capture->settings.technique = technique;
    if (result == PNB_OK) {
        result = decode_elements(decoder, sizeof(uint32_t) + sizeof(double), sizeof *capture->values, &capture->values);
    }
    for (uint32_t i = 0; result == PNB_OK && i < decoder->count; i++) {
        char *name = NULL;
        result = decode_present_string(&decoder->reader, &name);
        capture->values[i].name = name;
        capture->settings.value_count++;
        read_bytes(&decoder->reader, &capture->values[i].value, sizeof capture->values[i].value);
    }
    capture->settings.values = capture->values;
    return result;
}

/* ---- Files ---- */

static pnb_result (*const section_decoders[SECTION_COUNT])(struct decoder *) = {
    [SECTION_MESHES] = decode_meshes, [SECTION_TEXTURES] = decode_textures,   [SECTION_MATERIALS] = decode_materials,
    [SECTION_SLOTS] = decode_slots,   [SECTION_INSTANCES] = decode_instances, [SECTION_LIGHTS] = decode_lights,
    [SECTION_VIEW] = decode_view,     [SECTION_SETTINGS] = decode_settings,
};

pnb_result capture_check_header(const unsigned char header[CAPTURE_HEADER_SIZE], uint64_t file_size) {
    uint32_t version;
    uint64_t size;
    memcpy(&version, header + 4, sizeof version);
    memcpy(&size, header + 8, sizeof size);
    if (memcmp(header, "PNB1", 4) != 0) {
        return DAMAGED("it is not a Penumbra capture");
    }
    if (version != CAPTURE_VERSION) {
        return DAMAGED("it has format version %" PRIu32 ", this library reads version %u", version, CAPTURE_VERSION);
    }
    if (size > file_size) {
        return DAMAGED("it is truncated: %" PRIu64 " of %" PRIu64 " bytes", file_size, size);
    }
    if (size < file_size) {
        return DAMAGED("it is damaged: %" PRIu64 " bytes instead of %" PRIu64, file_size, size);
    }
    return PNB_OK;
}

static pnb_result decode_section(struct decoder *decoder, int section, struct byte_reader *file,
                                 const struct section_entry *entry) {
    if (memcmp(entry->tag, capture_tags[section], sizeof entry->tag) != 0) {
        return DAMAGED("section %s is missing", capture_tags[section]);
    }
    decoder->reader = read_part(file, entry->size);
    decoder->count = entry->count;
    pnb_result result = section_decoders[section](decoder);
    if (result == PNB_OK && (decoder->reader.failed || decoder->reader.left > 0)) {
        result = DAMAGED("its size is wrong");
    }
    return result == PNB_OK ? PNB_OK : error_set(result, "section %s: %s", capture_tags[section], pnb_last_error());
}

static pnb_result decode_file(struct decoder *decoder, struct byte_reader *file) {
    struct section_entry table[SECTION_COUNT];
    uint32_t count = read_u32(file);
    read_bytes(file, table, sizeof table);
    if (file->failed || count != SECTION_COUNT) {
        return DAMAGED("its section table is broken");
    }
    for (int section = 0; section < SECTION_COUNT; section++) {
        pnb_result result = decode_section(decoder, section, file, &table[section]);
        if (result != PNB_OK) {
            return result;
        }
    }
    const pnb_capture *capture = decoder->capture;
    if (file->left > 0 || decoder->used_meshes != capture->mesh_count ||
        decoder->used_textures != capture->texture_count) {
        return DAMAGED("it contains more than is used");
    }
    return scene_check(&capture->scene) == PNB_OK ? PNB_OK : DAMAGED("%s", pnb_last_error());
}

pnb_result capture_decode(const unsigned char *data, size_t size, pnb_capture **capture) {
    if (size < CAPTURE_HEADER_SIZE) {
        return DAMAGED("it is truncated: %zu bytes", size);
    }
    pnb_result result = capture_check_header(data, size);
    if (result != PNB_OK) {
        return result;
    }
    struct byte_reader file = {.next = data + CAPTURE_HEADER_SIZE, .left = size - CAPTURE_HEADER_SIZE};
    struct content_key key = {{0}}, expected;
    memcpy(&expected, data + CAPTURE_KEY_OFFSET, sizeof expected);
    content_key_add(&key, file.next, file.left);
    if (!content_key_equal(&key, &expected)) {
        return DAMAGED("it is damaged: its content does not match its checksum");
    }
    pnb_capture *made = memory_array(1, sizeof *made);
    if (!made) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    made->scene = (pnb_scene){.struct_size = sizeof made->scene, .camera = PNB_INIT(pnb_camera)};
    made->settings = (pnb_settings)PNB_INIT(pnb_settings);
    struct decoder decoder = {.capture = made};
    result = decode_file(&decoder, &file);
    if (result != PNB_OK) {
        pnb_capture_destroy(&made);
        return result;
    }
    *capture = made;
    return PNB_OK;
}
