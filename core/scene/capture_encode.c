/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "capture.h"
#include "content_key.h"
#include "handle_map.h"

#include <string.h>

struct encoder {
    struct byte_writer *writer;
    const pnb_scene *scene;
    const pnb_settings *settings;
    struct handle_map meshes, textures;
};

static void encode_meshes(struct encoder *encoder) {
    struct byte_writer *writer = encoder->writer;
    for (uint32_t i = 0; i < encoder->meshes.count; i++) {
        const struct pnb_mesh *mesh = encoder->meshes.handles[i];
        write_string(writer, mesh->name);
        write_string(writer, mesh->warning);
        write_u32(writer, mesh->vertex_count);
        write_u32(writer, mesh->index_count);
        write_u32(writer, mesh->range_count);
        write_bytes(writer, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
        write_bytes(writer, mesh->indices, mesh->index_count * sizeof *mesh->indices);
        write_bytes(writer, mesh->ranges, mesh->range_count * sizeof *mesh->ranges);
    }
}

static void encode_textures(struct encoder *encoder) {
    struct byte_writer *writer = encoder->writer;
    for (uint32_t i = 0; i < encoder->textures.count; i++) {
        const struct pnb_texture *texture = encoder->textures.handles[i];
        write_string(writer, texture->name);
        write_u32(writer, texture->width);
        write_u32(writer, texture->height);
        write_u32(writer, texture->has_alpha);
        write_u32(writer, texture->flags);
        write_bytes(writer, texture->rgba, (size_t)texture->width * texture->height * 4 * sizeof *texture->rgba);
    }
}

static void encode_texture_reference(struct encoder *encoder, const pnb_texture *texture) {
    write_u32(encoder->writer, texture ? handle_map_add(&encoder->textures, texture) : CAPTURE_NONE);
}

static void encode_materials(struct encoder *encoder) {
    for (uint32_t i = 0; i < encoder->scene->material_count; i++) {
        const pnb_material *material = &encoder->scene->materials[i];
        write_fields(encoder->writer, &material_fields, material);
        encode_texture_reference(encoder, material->base_color_texture);
        encode_texture_reference(encoder, material->alpha_texture);
        encode_texture_reference(encoder, material->emission_texture);
    }
}

static void encode_slots(struct encoder *encoder) {
    const pnb_scene *scene = encoder->scene;
    write_bytes(encoder->writer, scene->slots, scene->slot_count * sizeof *scene->slots);
}

static void encode_instances(struct encoder *encoder) {
    for (uint32_t i = 0; i < encoder->scene->instance_count; i++) {
        const pnb_instance *instance = &encoder->scene->instances[i];
        write_u32(encoder->writer, handle_map_add(&encoder->meshes, instance->mesh));
        write_string(encoder->writer, instance->name);
        write_fields(encoder->writer, &instance_fields, instance);
    }
}

static void encode_lights(struct encoder *encoder) {
    for (uint32_t i = 0; i < encoder->scene->light_count; i++) {
        const pnb_light *light = &encoder->scene->lights[i];
        write_string(encoder->writer, light->name);
        write_string(encoder->writer, light->technique);
        write_fields(encoder->writer, &light_fields, light);
    }
}

static void encode_view(struct encoder *encoder) {
    write_fields(encoder->writer, &camera_fields, &encoder->scene->camera);
    write_fields(encoder->writer, &scene_fields, encoder->scene);
}

static void encode_settings(struct encoder *encoder) {
    const pnb_settings *settings = encoder->settings;
    write_fields(encoder->writer, &settings_fields, settings);
    write_string(encoder->writer, settings->technique);
    for (uint32_t i = 0; i < settings->value_count; i++) {
        write_string(encoder->writer, settings->values[i].name);
        write_bytes(encoder->writer, &settings->values[i].value, sizeof settings->values[i].value);
    }
}

static void (*const section_encoders[SECTION_COUNT])(struct encoder *) = {
    [SECTION_MESHES] = encode_meshes, [SECTION_TEXTURES] = encode_textures,   [SECTION_MATERIALS] = encode_materials,
    [SECTION_SLOTS] = encode_slots,   [SECTION_INSTANCES] = encode_instances, [SECTION_LIGHTS] = encode_lights,
    [SECTION_VIEW] = encode_view,     [SECTION_SETTINGS] = encode_settings,
};

static uint32_t section_count(const struct encoder *encoder, int section) {
    const uint32_t counts[SECTION_COUNT] = {
        [SECTION_MESHES] = encoder->meshes.count,
        [SECTION_TEXTURES] = encoder->textures.count,
        [SECTION_MATERIALS] = encoder->scene->material_count,
        [SECTION_SLOTS] = encoder->scene->slot_count,
        [SECTION_INSTANCES] = encoder->scene->instance_count,
        [SECTION_LIGHTS] = encoder->scene->light_count,
        [SECTION_VIEW] = 1,
        [SECTION_SETTINGS] = encoder->settings->value_count,
    };
    return counts[section];
}

/* Numbers all handles, so that meshes and textures can be written before what uses them. */
static bool encoder_collect(struct encoder *encoder) {
    const pnb_scene *scene = encoder->scene;
    if (!handle_map_init(&encoder->meshes, scene->instance_count) ||
        !handle_map_init(&encoder->textures, 3 * (size_t)scene->material_count)) {
        return false;
    }
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        handle_map_add(&encoder->meshes, scene->instances[i].mesh);
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const pnb_material *material = &scene->materials[i];
        const pnb_texture *const used[] = {material->base_color_texture, material->alpha_texture,
                                           material->emission_texture};
        for (int j = 0; j < 3; j++) {
            if (used[j]) {
                handle_map_add(&encoder->textures, used[j]);
            }
        }
    }
    return true;
}

/* Header and section table come first, but tell what lies behind: they are written as zeros and filled in later. */
static void encode_file(struct encoder *encoder) {
    struct byte_writer *writer = encoder->writer;
    struct section_entry table[SECTION_COUNT] = {0};
    unsigned char header[CAPTURE_HEADER_SIZE] = {0};
    write_bytes(writer, header, sizeof header);
    write_u32(writer, SECTION_COUNT);
    size_t table_offset = writer->size;
    write_bytes(writer, table, sizeof table);
    for (int section = 0; section < SECTION_COUNT; section++) {
        size_t start = writer->size;
        section_encoders[section](encoder);
        memcpy(table[section].tag, capture_tags[section], sizeof table[section].tag);
        table[section].count = section_count(encoder, section);
        table[section].size = writer->size - start;
    }
    if (writer->failed) {
        return;
    }
    memcpy(writer->data + table_offset, table, sizeof table);
    const uint32_t version = CAPTURE_VERSION;
    const uint64_t size = writer->size;
    struct content_key key = {{0}};
    content_key_add(&key, writer->data + CAPTURE_HEADER_SIZE, writer->size - CAPTURE_HEADER_SIZE);
    memcpy(writer->data, "PNB1", 4);
    memcpy(writer->data + 4, &version, sizeof version);
    memcpy(writer->data + 8, &size, sizeof size);
    memcpy(writer->data + CAPTURE_KEY_OFFSET, &key, sizeof key);
}

pnb_result capture_encode(const pnb_scene *scene, const pnb_settings *settings, struct byte_writer *writer) {
    struct encoder encoder = {.writer = writer, .scene = scene, .settings = settings};
    bool collected = encoder_collect(&encoder);
    if (collected) {
        encode_file(&encoder);
    }
    handle_map_free(&encoder.meshes);
    handle_map_free(&encoder.textures);
    return collected && !writer->failed ? PNB_OK : PNB_ERROR_OUT_OF_MEMORY;
}
