/* SPDX-License-Identifier: GPL-3.0-or-later
 * Camera and shadow rays through a scene's opaque triangles, in packets, on several threads. */
#ifndef TRACER_H
#define TRACER_H

#include "emitter_samples.h"

#include <embree3/rtcore.h>

/* What a camera ray hit. */
struct receiver {
    float position[3];  /* moved off the surface, towards the camera */
    float normal[3];    /* shading normal, unit, on the camera's side */
    bool hit, shadowed; /* shadowed: the instance receives shadows */
};

struct tracer {
    RTCDevice device;
    RTCScene camera_scene, shadow_scene; /* the same one where every instance is seen and casts */
    const struct scene *scene;
    uint64_t triangle_count; /* of the shadow scene */
    double transform_ms, build_ms;
    uint32_t width, height, threads;
    struct receiver *receivers; /* width * height, rows bottom-up */
};

enum build_quality { BUILD_LOW, BUILD_MEDIUM, BUILD_HIGH };

/* `scene` must outlive the tracer. False, with a message on stderr, on failure. */
bool tracer_create(struct tracer *tracer, const struct scene *scene, uint32_t width, uint32_t height, uint32_t threads,
                   enum build_quality quality);
void tracer_free(struct tracer *tracer);

/* One ray through each pixel's centre; fills the receivers. */
void tracer_trace_camera(struct tracer *tracer);
/* Shadowed over unshadowed irradiance of all lights, RGB per pixel; 1 where no light reaches. */
void tracer_trace_shadows(struct tracer *tracer, const struct emitter_samples *lights, uint32_t light_count,
                          float *visibility);

double milliseconds_now(void);

#endif
