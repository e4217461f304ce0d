/* SPDX-License-Identifier: GPL-3.0-or-later
 * Everything of one render that passes and techniques share. Lives on the OpenGL thread. */
#ifndef PNB_FRAME_H
#define PNB_FRAME_H

#include "../gl/buffer.h"
#include "../gl/texture.h"
#include "job.h"
#include "light.h"
#include "sampling.h"

struct renderer;
struct gpu_scene;
struct technique;

/* The camera of one sample, std140 as common_camera.glsl reads it. */
struct camera_block {
    vec4 axis_x, axis_y, axis_z;
    vec4 window; /* left, bottom, width, height of the full image at distance 1 or in metres */
    vec4 image;  /* full width and height, lower left pixel of the crop */
    float perspective, sample_index, sample_count, padding;
    vec4 lit; /* see reuse.c */
};

/* One level of filtered fragment lists, a list for each texel of each view. */
#define MAX_FRAGMENT_LEVELS 14
struct fragment_level {
    uint32_t first_head;
    int side;       /* texels */
    int log2_texel; /* side of a texel in texels of the map */
    int stack;      /* 0: of a MIP map, whose texel i covers i .. i + 1; n: the n-th of a stack */
    int border;     /* of a stack: texels on each side whose filters reach into the map; texel i lies at i - border */
    float filter_width; /* of the box of equal variance, bilinear interpolation included, in texels of the map */
};

/* The fragments of casters, as lists in order of depth for every texel of a light's views (common_fragments.glsl), and
 * levels of them that are filtered ever wider. */
struct fragment_lists {
    struct gl_buffer heads, fragments;
    uint32_t count; /* fragments in all lists, with the gaps between them */
    struct fragment_level levels[MAX_FRAGMENT_LEVELS];
    uint32_t level_count;
};

/* Textures a technique may make of one light's shadow map. */
#define MAX_PREFILTERED 3

struct frame_light {
    const struct scene_light *source;
    const struct technique *technique; /* how its shadow is made */
    const double *parameters;          /* of the technique, in the order of its row */
    int map_size;                      /* texels per side */
    struct emitter emitter;
    struct light_views views;
    vec3 views_origin; /* of relative world space when they were fitted */
    struct gl_texture shadow_map, min_max, planes;  /* a layer per view; kept over the samples of a pixel */
    struct gl_texture prefiltered[MAX_PREFILTERED]; /* the same, of the technique's own making */
    int prefiltered_tile; /* of summed-area tables among them: texels along the side of a tile */
    struct fragment_lists lists;
};

/* Images of a job; from IMAGE_LIGHT_SHADOWS on there is one for each light. */
enum {
    IMAGE_COMBINED,
    IMAGE_DEPTH,
    IMAGE_NORMAL,
    IMAGE_SHADOW,
    IMAGE_LIGHT_SHADOWS,
    IMAGE_BLOCKERS,
    IMAGE_PENUMBRAE,
    IMAGE_SHADOW_MAPS,
    IMAGE_KINDS
};

/* light_maps.c: the textures and lists of a light; move: those of `to` must be free. */
void light_maps_free(const struct gl *gl, struct frame_light *light);
void light_maps_move(struct frame_light *to, struct frame_light *from);
uint64_t light_maps_bytes(const struct frame_light *light);

/* What the camera sees lies in these, see tiles.c: by tiles, and fewer for techniques that fit many views. */
struct receivers {
    struct hull *tiles, *groups;
    size_t tile_count, group_count;
};

void receivers_free(struct receivers *receivers);

struct frame {
    const struct gl *gl;
    struct renderer *renderer;
    struct pnb_job *job;
    const struct scene *scene;
    const struct settings *settings;
    vec3 origin; /* of relative world space: the camera's position */
    struct camera_block camera;
    int width, height;     /* of the crop */
    uint32_t sample;       /* anti-aliasing sample being drawn */
    uint32_t light;        /* light being drawn */
    bool binds_lists;      /* fragment lists, which the driver must let go of afterwards */
    bool reuses;           /* samples use the key sample's irradiance where they can, reuse.c */
    vec4 key_window;       /* camera.window of the key sample */
    uint32_t sums_samples; /* in the sums, with the one being drawn */

    struct receivers receivers;
    struct content_key surfaces; /* of a QUICK job, see kept.c */
    struct box *casters; /* bounds of the instances that cast shadows */
    size_t caster_count;
    float *images[IMAGE_KINDS][MAX_LIGHTS]; /* pixels of the job's images, NULL: not wanted */

    struct frame_light lights[MAX_LIGHTS];
};

/* camera.c. Relative world to clip space of the sample, with planes around what is in view. */
void camera_block_init(struct camera_block *block, const struct scene_camera *camera, const struct settings *settings,
                       uint32_t sample);
/* As in common_camera.glsl: relative world position of a coordinate of the full image and a depth. */
void camera_position(const struct camera_block *block, const float coordinate[2], float depth, vec3 position);
void camera_projection(const struct camera_block *block, float near_depth, float far_depth, mat4 projection);

#endif
