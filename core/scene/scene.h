/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checked, immutable copies of host data. Nothing here knows OpenGL. */
#ifndef PNB_SCENE_H
#define PNB_SCENE_H

#include "../messages.h"

#include <stdatomic.h>
#include <stdbool.h>

/* 128-bit hash of content: equal hashes are taken for equal data. */
struct content_key {
    uint64_t words[2];
};

/* One welded vertex, as OpenGL reads it: 28 bytes. */
struct vertex {
    float position[3];
    int16_t normal[2]; /* octahedral, signed normalised; unit length after decoding */
    float uv[2];
    uint8_t color[4]; /* square roots of linear values, 255 = 1; color[3] is 0 */
};

/* Consecutive triangles of one material slot. */
struct mesh_range {
    uint32_t slot;
    uint32_t first_index, index_count;
};

struct pnb_mesh {
    atomic_uint references;
    char *name;
    char *warning;              /* "" if the data was good */
    struct content_key content; /* of vertices, indices and ranges */
    struct vertex *vertices;
    uint32_t *indices;          /* three per triangle, sorted by slot */
    struct mesh_range *ranges;
    uint32_t vertex_count, index_count, range_count;
    float bounds[2][3];         /* minimum, maximum of the used positions; min > max if there are none */
};

struct pnb_texture {
    atomic_uint references;
    char *name;
    struct content_key content;
    uint32_t width, height, flags;
    bool has_alpha;             /* without it alpha is 1, and as an alpha texture its grey counts */
    float *rgba;                /* linear, 4 per texel, rows bottom-up; colour 0..65504 (half floats), alpha 0..1 */
};

pnb_mesh *mesh_retain(pnb_mesh *mesh);
pnb_texture *texture_retain(pnb_texture *texture);

struct scene_instance {
    pnb_mesh *mesh;             /* retained */
    char *name;
    uint32_t flags;
    uint32_t first_slot, slot_count; /* into scene.slots, checked; at least one */
    float matrix[16];
    uint64_t unlit_by, unshadowed_by; /* bits of scene.lights */
};

struct scene_material {
    float base_color[3], alpha, emission[3];
    float clearness[3];               /* 1 - absorption */
    float uv_matrix[6];
    float shadow_threshold;           /* 0: none; else there is an alpha_texture */
    uint32_t flags;
    pnb_texture *base_color_texture, *alpha_texture, *emission_texture; /* retained, or NULL */
};

/* Whether a base colour texture tints what shines through. */
static inline bool material_is_tinted(const struct scene_material *material) {
    return (material->flags & PNB_MATERIAL_TINTED) && material->base_color_texture;
}

/* Whether it casts a shadow that some light shines through. */
static inline bool material_is_translucent(const struct scene_material *material) {
    const float *clear = material->clearness;
    return (material->alpha < 1 || material->alpha_texture) &&
           (clear[0] > 0 || clear[1] > 0 || clear[2] > 0 || material->shadow_threshold > 0) &&
           !(material->flags & (PNB_MATERIAL_NO_SHADOW | PNB_MATERIAL_OPAQUE_SHADOW));
}

/* pnb_light with every default filled in, degenerate sizes clamped, and finite numbers; members that do not belong
 * to its type are 0. The axes are linearly independent. An AREA is at least SCENE_MIN_EMITTER wide and high in the
 * world; angle is at most SCENE_MAX_SUN_ANGLE, spot_angle in (0, pi]. */
#define SCENE_MIN_EMITTER   1e-4f  /* metres */
#define SCENE_MAX_SUN_ANGLE 3.124f /* 179 degrees: the tangent of half of it is finite */
struct scene_light {
    char *name;                 /* unique within the scene */
    pnb_light_type type;
    pnb_area_shape shape;
    uint32_t flags;
    float matrix[16];
    float emission[3];
    float size[2], radius, angle, spot_angle, spot_blend;
    float spread; /* AREA: below pi, or 0 */
    char *technique; /* NULL: the settings'; not checked, since a scene knows no techniques */
    uint32_t shadow_map_size; /* 0: the settings'; not checked */
    float shadow_color[3];
};

struct scene_camera {
    pnb_projection projection;
    float matrix[16];           /* orthonormal axes */
    float window[4];
    bool window_is_default;     /* the host gave none: the window is square until scene_camera_fit */
    float clip_start, clip_end;
};

struct scene {
    struct scene_instance *instances;
    struct scene_material *materials; /* one more than the host's: materials[material_count - 1] is the default */
    uint32_t *slots;                  /* checked indices into materials; one more than the host's: the default */
    struct scene_light *lights;
    uint32_t instance_count, material_count, slot_count, light_count;
    struct scene_camera camera;
    float world_color[3];
    bool emissive;                    /* some material emits */
    bool catches_shadows;             /* some instance is a shadow catcher */
    bool translucent;                 /* some material lets light through to what it shadows */
    bool colored;                     /* and tints it */
    bool light_linked;                /* some instance is not lit by every light */
};

/* Copies and checks. What cannot be used is dropped or clamped with a message that names it; only broken
 * structures (wrong struct_size, NULL meshes or arrays, more than MAX_LIGHTS lights) are errors. */
#define MAX_LIGHTS 64
pnb_result scene_create(const pnb_scene *from, struct messages *messages, struct scene **scene);
void scene_destroy(struct scene **scene);
/* Gives a default window the aspect of an image of so many pixels, which are square. */
void scene_camera_fit(struct scene_camera *camera, uint32_t width, uint32_t height);

#endif
