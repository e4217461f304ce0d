/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lights as emitters, and the views their shadow maps are drawn from. Pure geometry, no OpenGL.
 *
 * "Relative world" is world space with the origin at the frame's origin (the camera), so that scenes far from the
 * world's origin keep their precision. Light space of a view has the emitter's centre at the origin, +Z along the view
 * and metres on all axes. A point's map coordinate q is xy / z in a perspective view and xy in an orthographic one. */
#ifndef PNB_LIGHT_H
#define PNB_LIGHT_H

#include "../scene/scene.h"

#include <cglm/cglm.h>

#define MAX_LIGHT_VIEWS 6

/* Axis-aligned box in relative world space; empty when minimum > maximum. */
struct box {
    vec3 minimum, maximum;
};

/* Convex hull of eight points, relative world: a box, or what a piece of the image may show. */
struct hull {
    vec3 corners[8];
};

void hull_of_box(const struct box *box, struct hull *hull);

struct emitter {
    pnb_light_type type;
    bool ellipse;          /* the emitter's outline is an ellipse or disk, not a rectangle */
    bool casts_shadow;
    vec3 position;         /* centre, relative world; unused for SUN */
    mat3 frame;            /* columns: orthonormal X, Y and Z = direction of emission, relative world */
    vec3 half_u, half_v;   /* AREA: half axes of the emitter, metres, relative world */
    float tan_half_spread; /* AREA: 0 without a grid */
    float radius;          /* POINT, SPOT: metres */
    float tan_half_angle;  /* SUN */
    vec3 emission;
    float cos_cone;        /* SPOT: cosine of the half cone angle */
    float blend;           /* SPOT: scene_light.spot_blend */
    vec2 cone_scale;       /* SPOT: X and Y axes of its matrix over Z */
    bool cosine_spot;      /* PNB_LIGHT_COSINE_SPOT */
    float cone_offset;     /* SPOT: how far from `position` the tip of the cone may lie */
};

void emitter_init(struct emitter *emitter, const struct scene_light *light, const vec3 origin);

/* As the shaders read it (std140, common_light.glsl). */
struct light_view {
    mat4 from_world; /* relative world to light space */
    vec4 rect;       /* lower left corner of the map in q, and 1 / its extent: uv = (q - rect.xy) * rect.zw */
    float near_depth, far_depth; /* light-space z of map depth 0 and 1 */
    float perspective;           /* 1 or 0 */
    float texel;                 /* larger side of a texel in q */
};

struct light_views {
    struct light_view views[MAX_LIGHT_VIEWS];
    int count;                   /* 0: nothing to shadow */
    int layer_of_face[MAX_LIGHT_VIEWS]; /* map layer of the faces +Z +X -X +Y -Y -Z of the frame, -1: none */
    bool single;                 /* one view for every receiver, whatever its direction */
    bool clip_behind;            /* some look behind an emitter of one side, where nothing hides its light */
    vec4 front;                  /* the plane of that emitter, positive before it, relative world */
};

/* Fits views of map_size texels to the receivers that light can reach and the casters that can shadow them. */
void light_views_fit(struct light_views *views, const struct emitter *emitter, const struct hull *receivers,
                     size_t receiver_count, const struct box *casters, size_t caster_count, int map_size);

/* Whether views fitted before, to the same emitter and casters, still show what these must, about as finely. */
bool light_views_cover(const struct light_views *before, const struct light_views *views, int map_size);
/* Lets the light space of a SUN, which begins at the origin, begin at another. */
void light_views_move(struct light_views *views, const vec3 origin, const vec3 other);
/* Gives the views room for what they will have to show while the camera goes on moving. */
void light_views_loosen(struct light_views *views);
/* Gives the views the maps of those. */
void light_views_take_maps(struct light_views *views, const struct light_views *before);

/* Light space to clip space of a view's map: linear depth goes to gl_FragDepth, clip z only clips at near and far. */
void light_view_projection(const struct light_view *view, mat4 projection);

#endif
