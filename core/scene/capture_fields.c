/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "capture.h"

const char capture_tags[SECTION_COUNT][5] = {
    [SECTION_MESHES] = "MESH", [SECTION_TEXTURES] = "TEXT",  [SECTION_MATERIALS] = "MATE",
    [SECTION_SLOTS] = "SLOT",  [SECTION_INSTANCES] = "INST", [SECTION_LIGHTS] = "LGHT",
    [SECTION_VIEW] = "VIEW",   [SECTION_SETTINGS] = "SETT",
};

#define FIELD(type, member)                                                                                            \
    { offsetof(type, member), sizeof((type){0}.member) }
#define FIELD_LIST(name) const struct field_list name = {name##_table, sizeof name##_table / sizeof *name##_table}

static const struct field instance_fields_table[] = {
    FIELD(pnb_instance, flags),  FIELD(pnb_instance, first_slot), FIELD(pnb_instance, slot_count),
    FIELD(pnb_instance, matrix), FIELD(pnb_instance, unlit_by),   FIELD(pnb_instance, unshadowed_by),
};
FIELD_LIST(instance_fields);

static const struct field material_fields_table[] = {
    FIELD(pnb_material, base_color), FIELD(pnb_material, transparency), FIELD(pnb_material, flags),
    FIELD(pnb_material, emission),   FIELD(pnb_material, absorption),   FIELD(pnb_material, uv_matrix),
    FIELD(pnb_material, shadow_threshold),
};
FIELD_LIST(material_fields);

static const struct field light_fields_table[] = {
    FIELD(pnb_light, flags),        FIELD(pnb_light, type),     FIELD(pnb_light, shape),
    FIELD(pnb_light, matrix),       FIELD(pnb_light, emission), FIELD(pnb_light, size),
    FIELD(pnb_light, radius),       FIELD(pnb_light, angle),    FIELD(pnb_light, spot_angle),
    FIELD(pnb_light, spot_blend),   FIELD(pnb_light, spread),   FIELD(pnb_light, shadow_map_size),
    FIELD(pnb_light, shadow_color),
};
FIELD_LIST(light_fields);

static const struct field camera_fields_table[] = {
    FIELD(pnb_camera, projection), FIELD(pnb_camera, matrix),   FIELD(pnb_camera, window),
    FIELD(pnb_camera, clip_start), FIELD(pnb_camera, clip_end),
};
FIELD_LIST(camera_fields);

static const struct field scene_fields_table[] = {
    FIELD(pnb_scene, world_color),
};
FIELD_LIST(scene_fields);

static const struct field settings_fields_table[] = {
    FIELD(pnb_settings, flags),           FIELD(pnb_settings, width),
    FIELD(pnb_settings, height),          FIELD(pnb_settings, crop),
    FIELD(pnb_settings, samples),         FIELD(pnb_settings, filter_width),
    FIELD(pnb_settings, shadow_map_size), FIELD(pnb_settings, light_samples),
    FIELD(pnb_settings, passes),
};
FIELD_LIST(settings_fields);

size_t fields_size(const struct field_list *list) {
    size_t size = 0;
    for (size_t i = 0; i < list->count; i++) {
        size += list->fields[i].size;
    }
    return size;
}

void write_fields(struct byte_writer *writer, const struct field_list *list, const void *structure) {
    for (size_t i = 0; i < list->count; i++) {
        write_bytes(writer, (const unsigned char *)structure + list->fields[i].offset, list->fields[i].size);
    }
}

void read_fields(struct byte_reader *reader, const struct field_list *list, void *structure) {
    for (size_t i = 0; i < list->count; i++) {
        read_bytes(reader, (unsigned char *)structure + list->fields[i].offset, list->fields[i].size);
    }
}
