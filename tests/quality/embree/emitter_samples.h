/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stratified points on a light. */
#ifndef EMITTER_SAMPLES_H
#define EMITTER_SAMPLES_H

#include "scene/scene.h"

/* Different sets of points; each pixel takes one of them, so that noise does not repeat visibly. A power of two. */
#define SAMPLE_SETS 64

struct emitter_samples {
    pnb_light_type type;
    bool shadows;                           /* false: nothing shadows it */
    bool one_sided;                         /* AREA: shines along `direction` only */
    float position[3];                      /* centre; unused for SUN */
    float direction[3];                     /* of emission; SUN: from the light */
    float axis_u[3], axis_v[3];             /* AREA: half axes of the emitter */
    float radius;                           /* POINT, SPOT: metres; SUN: at distance 1 */
    float emission[3];                      /* times the emitter's area for AREA */
    float cos_cone, blend, cone_axes[2][3]; /* SPOT */
    uint32_t count;                         /* points per set */
    float *points;                          /* SAMPLE_SETS x count pairs in -1..1: inside the unit square or disk */
};

/* False without memory. */
bool emitter_samples_create(struct emitter_samples *samples, const struct scene_light *light, uint32_t count,
                            uint32_t seed);
void emitter_samples_free(struct emitter_samples *samples);

/* What a receiver needs to turn a pair into a point: for lights that turn towards it, axes across the way to it. */
struct emitter_view {
    float axis_u[3], axis_v[3]; /* half axes as this receiver sees them */
    float attenuation;          /* SPOT: share of the intensity that goes its way; else 1 */
};
struct emitter_view emitter_view(const struct emitter_samples *samples, const float position[3]);

#endif
