/* SPDX-License-Identifier: GPL-3.0-or-later
 * The capture file: a scene and its settings as the host gave them, with every mesh and texture stored once.
 *
 *   "PNB1", u32 version, u64 file size, 128-bit content key of everything behind it
 *   u32 section count, then for each section: 4 characters tag, u32 element count, u64 size in bytes
 *   the sections, in the order of the enumeration below, without gaps
 *
 * A string is its length and its characters; meshes and textures are numbered in the order of their first use. So
 * there is exactly one file for a scene, and reading accepts no other: what was read is written back byte for byte. */
#ifndef PNB_CAPTURE_H
#define PNB_CAPTURE_H

#include "bytes.h"
#include "scene.h"

#define CAPTURE_VERSION     6u
#define CAPTURE_HEADER_SIZE 32u
#define CAPTURE_KEY_OFFSET  16u /* of the content key within the header */

enum capture_section {
    SECTION_MESHES,
    SECTION_TEXTURES,
    SECTION_MATERIALS,
    SECTION_SLOTS,
    SECTION_INSTANCES,
    SECTION_LIGHTS,
    SECTION_VIEW,     /* camera and world */
    SECTION_SETTINGS, /* elements are the parameter values */
    SECTION_COUNT
};
extern const char capture_tags[SECTION_COUNT][5];

struct section_entry {
    char tag[4];
    uint32_t count;
    uint64_t size;
};

/* A reference to no texture. */
#define CAPTURE_NONE UINT32_MAX

/* Plain members of a structure, in file order. The tables serve writing and reading. */
struct field {
    uint16_t offset, size;
};
struct field_list {
    const struct field *fields;
    size_t count;
};
extern const struct field_list instance_fields, material_fields, light_fields, camera_fields, scene_fields,
    settings_fields;

size_t fields_size(const struct field_list *list);
void write_fields(struct byte_writer *writer, const struct field_list *list, const void *structure);
void read_fields(struct byte_reader *reader, const struct field_list *list, void *structure);

struct pnb_capture {
    pnb_scene scene;
    pnb_settings settings;
    /* What scene and settings point to. The names in the arrays are owned, too. */
    pnb_mesh **meshes;
    pnb_texture **textures;
    uint32_t mesh_count, texture_count;
    pnb_instance *instances;
    pnb_material *materials;
    uint32_t *slots;
    pnb_light *lights;
    pnb_value *values;
    char *technique;
};

/* The whole file, of a checked scene; the caller frees writer->data, also on failure. */
pnb_result capture_encode(const pnb_scene *scene, const pnb_settings *settings, struct byte_writer *writer);
/* Checks the 32 bytes that a file of this size starts with. */
pnb_result capture_check_header(const unsigned char header[CAPTURE_HEADER_SIZE], uint64_t file_size);
/* The whole file back. The data may be anything: PNB_ERROR_FILE says what is wrong with it. */
pnb_result capture_decode(const unsigned char *data, size_t size, pnb_capture **capture);

#endif
