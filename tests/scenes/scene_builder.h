/* SPDX-License-Identifier: GPL-3.0-or-later
 * Collects meshes, instances, materials, lights and a camera into one pnb_scene. */
#ifndef SCENE_BUILDER_H
#define SCENE_BUILDER_H

#include "shapes.h"
#include "test_scenes.h"

#define BUILDER_MAX_INSTANCES 4096
#define BUILDER_MAX_MESHES    64
#define BUILDER_MAX_MATERIALS 16
#define BUILDER_MAX_TEXTURES  16
#define BUILDER_MAX_LIGHTS    64

struct scene_builder {
    struct test_scene_options options; /* defaults filled in */
    int failed;
    pnb_mesh *meshes[BUILDER_MAX_MESHES];
    pnb_instance instances[BUILDER_MAX_INSTANCES];
    pnb_material materials[BUILDER_MAX_MATERIALS];
    uint32_t slots[BUILDER_MAX_MATERIALS]; /* slot i is material i */
    pnb_light lights[BUILDER_MAX_LIGHTS];
    pnb_texture *textures[BUILDER_MAX_TEXTURES];
    uint32_t mesh_count, texture_count;
    pnb_scene scene;
    pnb_settings settings;
};

/* Materials every builder starts with. */
enum builder_material { MATERIAL_WHITE, MATERIAL_GREY, MATERIAL_RED, MATERIAL_BLUE, MATERIAL_GREEN, MATERIAL_YELLOW };

void builder_init(struct scene_builder *builder, const struct test_scene_options *options);
void builder_free(struct scene_builder *builder);

/* Finishes the shape and owns the mesh. */
const pnb_mesh *builder_mesh(struct scene_builder *builder, struct shape *shape, const char *name);

/* Where an instance stands. A zero scale is 1. Rotation: radians around X, then Y, then Z. */
struct placement {
    float position[3], rotation[3], scale[3];
};
/* NULL when there is no room (the builder has then failed). The result may be changed further. */
pnb_instance *builder_instance(struct scene_builder *builder, const pnb_mesh *mesh, enum builder_material material,
                               struct placement placement);

/* Adds a light of the given kind at `position` shining towards `target`. `size` is its full width in metres as seen
 * from the target, whatever the kind (a sun's angle follows from the distance). A surface at the target that faces
 * it receives `irradiance` (W/m2, white). */
pnb_light *builder_light(struct scene_builder *builder, enum test_light kind, const float position[3],
                         const float target[3], float size, float irradiance);
/* The light of a scene with one: kind and size are the options', `size` where they have none. */
pnb_light *builder_key_light(struct scene_builder *builder, const float position[3], const float target[3], float size);

/* Perspective camera whose image is `field` radians high; 16:9, 640 pixels wide. */
void builder_camera(struct scene_builder *builder, const float position[3], const float target[3], float field);
/* Orthographic camera looking straight down on the square of side `side` around the origin; 512 x 512 pixels. */
void builder_camera_above(struct scene_builder *builder, float side);

#endif
