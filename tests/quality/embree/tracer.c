/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tracer.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Rays of a packet: the processor's vector width. */
#ifdef __AVX512F__
#define PACKET 16
typedef struct RTCRayHit16 ray_hit_packet;
typedef struct RTCRay16 ray_packet;
#define intersect_packet rtcIntersect16
#define occluded_packet  rtcOccluded16
#else
#define PACKET           8
typedef struct RTCRayHit8 ray_hit_packet;
typedef struct RTCRay8 ray_packet;
#define intersect_packet rtcIntersect8
#define occluded_packet  rtcOccluded8
#endif

/* Pixels per side of the square that one thread takes at a time. */
#define TILE 16

double milliseconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* ---- Building ---- */

static void transform_point(const float m[16], const float p[3], float result[3]) {
    for (int i = 0; i < 3; i++)
        result[i] = m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
}

/* World-space copy of an instance's triangles; its index becomes the geometry's number. */
static void attach_instance(const struct tracer *tracer, RTCScene target, uint32_t index) {
    const struct scene_instance *instance = &tracer->scene->instances[index];
    const pnb_mesh *mesh = instance->mesh;
    if (mesh->index_count == 0)
        return;
    RTCGeometry geometry = rtcNewGeometry(tracer->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                              mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), mesh->index_count / 3);
    if (vertices && indices) {
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            transform_point(instance->matrix, mesh->vertices[i].position, vertices + 3 * (size_t)i);
        memcpy(indices, mesh->indices, mesh->index_count * sizeof(uint32_t));
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(target, geometry, index);
    }
    rtcReleaseGeometry(geometry);
}

/* A scene without the instances that have the flag. */
static RTCScene build_scene(struct tracer *tracer, uint32_t excluded, enum build_quality quality) {
    static const enum RTCBuildQuality qualities[] = {RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM,
                                                     RTC_BUILD_QUALITY_HIGH};
    RTCScene scene = rtcNewScene(tracer->device);
    rtcSetSceneBuildQuality(scene, qualities[quality]);
    double start = milliseconds_now();
    for (uint32_t i = 0; i < tracer->scene->instance_count; i++)
        if (!(tracer->scene->instances[i].flags & excluded))
            attach_instance(tracer, scene, i);
    double middle = milliseconds_now();
    rtcCommitScene(scene);
    tracer->transform_ms += middle - start;
    tracer->build_ms += milliseconds_now() - middle;
    return scene;
}

static void print_embree_error(void *user, enum RTCError code, const char *message) {
    (void)user;
    fprintf(stderr, "embree_baseline: Embree error %d: %s\n", (int)code, message);
}

bool tracer_create(struct tracer *tracer, const struct scene *scene, uint32_t width, uint32_t height, uint32_t threads,
                   enum build_quality quality) {
    *tracer = (struct tracer){.scene = scene, .width = width, .height = height, .threads = threads};
    char configuration[64];
    snprintf(configuration, sizeof configuration, "threads=%u", threads);
    tracer->device = rtcNewDevice(configuration);
    tracer->receivers = calloc((size_t)width * height, sizeof *tracer->receivers);
    if (!tracer->device || !tracer->receivers) {
        fputs("embree_baseline: no device, or out of memory\n", stderr);
        return false;
    }
    rtcSetDeviceErrorFunction(tracer->device, print_embree_error, NULL);
    bool same = true;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        same = same && !(instance->flags & (PNB_INSTANCE_HIDDEN_FROM_CAMERA | PNB_INSTANCE_NO_SHADOW));
        if (!(instance->flags & PNB_INSTANCE_NO_SHADOW))
            tracer->triangle_count += instance->mesh->index_count / 3;
    }
    tracer->shadow_scene = build_scene(tracer, PNB_INSTANCE_NO_SHADOW, quality);
    if (same)
        rtcRetainScene(tracer->shadow_scene);
    tracer->camera_scene = same ? tracer->shadow_scene : build_scene(tracer, PNB_INSTANCE_HIDDEN_FROM_CAMERA, quality);
    return rtcGetDeviceError(tracer->device) == RTC_ERROR_NONE;
}

void tracer_free(struct tracer *tracer) {
    if (tracer->camera_scene)
        rtcReleaseScene(tracer->camera_scene);
    if (tracer->shadow_scene)
        rtcReleaseScene(tracer->shadow_scene);
    if (tracer->device)
        rtcReleaseDevice(tracer->device);
    free(tracer->receivers);
}

/* ---- Tiles on threads ---- */

struct work {
    struct tracer *tracer;
    void (*trace_tile)(struct work *work, uint32_t x, uint32_t y);
    atomic_uint next_tile;
    const struct emitter_samples *lights;
    uint32_t light_count;
    float *visibility;
};

static void *run_tiles(void *argument) {
    struct work *work = argument;
    uint32_t columns = (work->tracer->width + TILE - 1) / TILE, rows = (work->tracer->height + TILE - 1) / TILE;
    uint32_t tile;
    while ((tile = atomic_fetch_add(&work->next_tile, 1)) < columns * rows)
        work->trace_tile(work, tile % columns * TILE, tile / columns * TILE);
    return NULL;
}

/* The calling thread works too, so a thread that cannot be started only costs time. */
static void run_work(struct work *work) {
    pthread_t threads[64];
    uint32_t started = 0;
    while (started + 1 < work->tracer->threads && started < 64 &&
           pthread_create(&threads[started], NULL, run_tiles, work) == 0)
        started++;
    run_tiles(work);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
}

/* ---- Camera rays ---- */

static void set_camera_ray(const struct tracer *tracer, uint32_t x, uint32_t y, ray_hit_packet *packet, int lane) {
    const struct scene_camera *camera = &tracer->scene->camera;
    const float *m = camera->matrix, *window = camera->window;
    float across = window[0] + ((float)x + 0.5f) / (float)tracer->width * (window[1] - window[0]);
    float up = window[2] + ((float)y + 0.5f) / (float)tracer->height * (window[3] - window[2]);
    float origin[3], direction[3];
    for (int i = 0; i < 3; i++) {
        float aside = across * m[i] + up * m[4 + i];
        bool perspective = camera->projection == PNB_PERSPECTIVE;
        origin[i] = m[12 + i] + (perspective ? 0 : aside);
        direction[i] = (perspective ? aside : 0) - m[8 + i]; /* ray length 1 is depth 1 */
    }
    packet->ray.org_x[lane] = origin[0];
    packet->ray.org_y[lane] = origin[1];
    packet->ray.org_z[lane] = origin[2];
    packet->ray.dir_x[lane] = direction[0];
    packet->ray.dir_y[lane] = direction[1];
    packet->ray.dir_z[lane] = direction[2];
    packet->ray.tnear[lane] = camera->clip_start;
    packet->ray.tfar[lane] = camera->clip_end;
    packet->ray.mask[lane] = ~0u;
    packet->ray.flags[lane] = 0;
    packet->ray.time[lane] = 0;
    packet->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

static void octahedral_decode(const int16_t packed[2], float normal[3]) {
    float x = (float)packed[0] / 32767, y = (float)packed[1] / 32767;
    float z = 1 - fabsf(x) - fabsf(y);
    if (z < 0) {
        float unfolded = x;
        x = copysignf(1 - fabsf(y), x);
        y = copysignf(1 - fabsf(unfolded), y);
    }
    float length = sqrtf(x * x + y * y + z * z);
    normal[0] = x / length;
    normal[1] = y / length;
    normal[2] = z / length;
}

/* Normals transform with the matrix of cofactors. */
static void transform_normal(const float m[16], const float normal[3], float result[3]) {
    for (int row = 0; row < 3; row++) {
        result[row] = 0;
        for (int column = 0; column < 3; column++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = 4 * ((column + 1) % 3), c2 = 4 * ((column + 2) % 3);
            result[row] += (m[c1 + r1] * m[c2 + r2] - m[c1 + r2] * m[c2 + r1]) * normal[column];
        }
    }
}

static float dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void shading_normal(const struct scene_instance *instance, uint32_t triangle, float u, float v,
                           float normal[3]) {
    const uint32_t *corners = instance->mesh->indices + 3 * (size_t)triangle;
    const float weights[3] = {1 - u - v, u, v};
    float sum[3] = {0, 0, 0};
    for (int corner = 0; corner < 3; corner++) {
        float corner_normal[3];
        octahedral_decode(instance->mesh->vertices[corners[corner]].normal, corner_normal);
        for (int i = 0; i < 3; i++)
            sum[i] += weights[corner] * corner_normal[i];
    }
    transform_normal(instance->matrix, sum, normal);
}

static void take_hit(const struct tracer *tracer, const ray_hit_packet *packet, int lane, struct receiver *receiver) {
    uint32_t geometry = packet->hit.geomID[lane];
    receiver->hit = geometry != RTC_INVALID_GEOMETRY_ID;
    if (!receiver->hit)
        return;
    const struct scene_instance *instance = &tracer->scene->instances[geometry];
    receiver->shadowed = !(instance->flags & PNB_INSTANCE_NO_RECEIVE);
    const float direction[3] = {packet->ray.dir_x[lane], packet->ray.dir_y[lane], packet->ray.dir_z[lane]};
    const float origin[3] = {packet->ray.org_x[lane], packet->ray.org_y[lane], packet->ray.org_z[lane]};
    float geometric[3] = {packet->hit.Ng_x[lane], packet->hit.Ng_y[lane], packet->hit.Ng_z[lane]};
    float facing = dot(geometric, direction) > 0 ? -1.0f : 1.0f;
    float scale = facing / sqrtf(dot(geometric, geometric));
    shading_normal(instance, packet->hit.primID[lane], packet->hit.u[lane], packet->hit.v[lane], receiver->normal);
    for (int i = 0; i < 3; i++)
        geometric[i] *= scale;
    float side = dot(receiver->normal, geometric) < 0 ? -1.0f : 1.0f;
    side /= sqrtf(dot(receiver->normal, receiver->normal));
    /* The offset covers the rounding of the hit point, which grows with the distances involved. */
    float offset = 1e-5f * fmaxf(1, packet->ray.tfar[lane]);
    for (int i = 0; i < 3; i++) {
        receiver->normal[i] *= side;
        receiver->position[i] = origin[i] + packet->ray.tfar[lane] * direction[i] + offset * geometric[i];
    }
}

static void trace_camera_tile(struct work *work, uint32_t left, uint32_t bottom) {
    struct tracer *tracer = work->tracer;
    /* Packets of 4 x 4 or 4 x 2 neighbouring pixels. */
    const uint32_t columns = 4, rows = PACKET / 4;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (uint32_t y = bottom; y < bottom + TILE; y += rows) {
        for (uint32_t x = left; x < left + TILE; x += columns) {
            ray_hit_packet packet;
            _Alignas(64) int valid[PACKET];
            for (int lane = 0; lane < PACKET; lane++) {
                uint32_t px = x + (uint32_t)lane % columns, py = y + (uint32_t)lane / columns;
                valid[lane] = px < tracer->width && py < tracer->height ? -1 : 0;
                set_camera_ray(tracer, px, py, &packet, lane);
            }
            intersect_packet(valid, tracer->camera_scene, &context, &packet);
            for (int lane = 0; lane < PACKET; lane++) {
                uint32_t px = x + (uint32_t)lane % columns, py = y + (uint32_t)lane / columns;
                if (valid[lane])
                    take_hit(tracer, &packet, lane, &tracer->receivers[(size_t)py * tracer->width + px]);
            }
        }
    }
}

void tracer_trace_camera(struct tracer *tracer) {
    struct work work = {.tracer = tracer, .trace_tile = trace_camera_tile};
    run_work(&work);
}

/* ---- Shadow rays ---- */

/* The lit pixels of a tile, in arrays so that packets may span pixels. */
struct tile_receivers {
    uint32_t count;
    uint32_t pixel[TILE * TILE];
    float position[3][TILE * TILE], normal[3][TILE * TILE];
    float axis_u[3][TILE * TILE], axis_v[3][TILE * TILE];
    float attenuation[TILE * TILE];
    uint32_t set[TILE * TILE];
    float lit[TILE * TILE], all[TILE * TILE]; /* sums of weights: unoccluded samples, all samples */
};

static uint32_t hash(uint32_t value) {
    value ^= value >> 16;
    value *= 0x7feb352du;
    value ^= value >> 15;
    value *= 0x846ca68bu;
    return value ^ value >> 16;
}

static void gather_receivers(const struct tracer *tracer, uint32_t left, uint32_t bottom,
                             const struct emitter_samples *light, struct tile_receivers *tile) {
    tile->count = 0;
    for (uint32_t y = bottom; y < bottom + TILE && y < tracer->height; y++) {
        for (uint32_t x = left; x < left + TILE && x < tracer->width; x++) {
            uint32_t pixel = y * tracer->width + x, slot = tile->count;
            const struct receiver *receiver = &tracer->receivers[pixel];
            if (!receiver->hit)
                continue;
            struct emitter_view view = emitter_view(light, receiver->position);
            if (view.attenuation <= 0)
                continue;
            for (int i = 0; i < 3; i++) {
                tile->position[i][slot] = receiver->position[i];
                tile->normal[i][slot] = receiver->normal[i];
                tile->axis_u[i][slot] = view.axis_u[i];
                tile->axis_v[i][slot] = view.axis_v[i];
            }
            tile->pixel[slot] = pixel;
            tile->attenuation[slot] = view.attenuation;
            tile->set[slot] = hash(pixel) % SAMPLE_SETS;
            tile->lit[slot] = tile->all[slot] = 0;
            tile->count++;
        }
    }
}

/* One ray from a receiver to a point of the light: direction of the whole way (length 1 is the light), and weight:
 * the point's share of the unshadowed irradiance. */
static inline float sample_ray(const struct tile_receivers *tile, const struct emitter_samples *light, uint32_t slot,
                               uint32_t sample, float direction[3]) {
    const float *point = light->points + 2 * ((size_t)tile->set[slot] * light->count + sample);
    float along_normal = 0, distance2 = 0, facing = 0;
    bool sun = light->type == PNB_LIGHT_SUN;
    for (int i = 0; i < 3; i++) {
        float base = sun ? -light->direction[i] : light->position[i] - tile->position[i][slot];
        direction[i] = base + point[0] * tile->axis_u[i][slot] + point[1] * tile->axis_v[i][slot];
        along_normal += direction[i] * tile->normal[i][slot];
        distance2 += direction[i] * direction[i];
        facing -= direction[i] * light->direction[i];
    }
    along_normal = fmaxf(along_normal, 0);
    if (sun)
        return along_normal / sqrtf(distance2);
    if (light->one_sided)
        return along_normal * fmaxf(facing, 0) / (distance2 * distance2);
    /* A disk that faces the receiver: its cosine is 1 but for the obliquity of its rim, which the distance holds. */
    return along_normal / (distance2 * sqrtf(distance2));
}

/* Traces the samples first .. first + PACKET - 1 of the tile, counted over all receivers. */
static void trace_packet(struct work *work, const struct emitter_samples *light, struct tile_receivers *tile,
                         struct RTCIntersectContext *context, uint32_t first) {
    ray_packet packet;
    _Alignas(64) int valid[PACKET];
    _Alignas(64) float weights[PACKET];
    _Alignas(64) uint32_t slots[PACKET];
    const float reach = light->type == PNB_LIGHT_SUN ? INFINITY : 1;
    const uint32_t total = tile->count * light->count;
    for (uint32_t lane = 0; lane < PACKET; lane++) {
        uint32_t ray = first + lane < total ? first + lane : total - 1;
        uint32_t slot = ray / light->count;
        float direction[3];
        float weight = sample_ray(tile, light, slot, ray % light->count, direction);
        slots[lane] = slot;
        weights[lane] = first + lane < total ? weight : 0;
        valid[lane] = weights[lane] > 0 ? -1 : 0;
        packet.org_x[lane] = tile->position[0][slot];
        packet.org_y[lane] = tile->position[1][slot];
        packet.org_z[lane] = tile->position[2][slot];
        packet.dir_x[lane] = direction[0];
        packet.dir_y[lane] = direction[1];
        packet.dir_z[lane] = direction[2];
        packet.tnear[lane] = 0;
        packet.tfar[lane] = reach;
        packet.mask[lane] = ~0u;
        packet.flags[lane] = 0;
        packet.time[lane] = 0;
    }
    if (light->shadows)
        occluded_packet(valid, work->tracer->shadow_scene, context, &packet);
    for (int lane = 0; lane < PACKET; lane++) {
        tile->all[slots[lane]] += weights[lane];
        /* Embree sets tfar of an occluded ray to minus infinity. */
        tile->lit[slots[lane]] += packet.tfar[lane] >= 0 ? weights[lane] : 0;
    }
}

/* Adds a light to the sums of the tile's pixels: RGB of shadowed and of unshadowed irradiance. */
static void add_light(struct work *work, const struct emitter_samples *light, struct tile_receivers *tile,
                      float (*sums)[TILE * TILE][3], uint32_t left, uint32_t bottom) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    gather_receivers(work->tracer, left, bottom, light, tile);
    for (uint32_t first = 0; first < tile->count * light->count; first += PACKET)
        trace_packet(work, light, tile, &context, first);
    for (uint32_t slot = 0; slot < tile->count; slot++) {
        uint32_t x = tile->pixel[slot] % work->tracer->width, y = tile->pixel[slot] / work->tracer->width;
        uint32_t place = (y - bottom) * TILE + (x - left);
        float scale = tile->attenuation[slot] / (float)light->count;
        bool shadowed = work->tracer->receivers[tile->pixel[slot]].shadowed;
        for (int i = 0; i < 3; i++) {
            sums[0][place][i] += light->emission[i] * scale * (shadowed ? tile->lit[slot] : tile->all[slot]);
            sums[1][place][i] += light->emission[i] * scale * tile->all[slot];
        }
    }
}

static void trace_shadow_tile(struct work *work, uint32_t left, uint32_t bottom) {
    struct tile_receivers tile;
    float sums[2][TILE * TILE][3];
    memset(sums, 0, sizeof sums);
    for (uint32_t i = 0; i < work->light_count; i++)
        add_light(work, &work->lights[i], &tile, sums, left, bottom);
    for (uint32_t y = 0; y < TILE && bottom + y < work->tracer->height; y++) {
        for (uint32_t x = 0; x < TILE && left + x < work->tracer->width; x++) {
            float *pixel = work->visibility + 3 * ((size_t)(bottom + y) * work->tracer->width + left + x);
            for (int i = 0; i < 3; i++) {
                float all = sums[1][y * TILE + x][i];
                pixel[i] = all > 0 ? sums[0][y * TILE + x][i] / all : 1;
            }
        }
    }
}

void tracer_trace_shadows(struct tracer *tracer, const struct emitter_samples *lights, uint32_t light_count,
                          float *visibility) {
    struct work work = {.tracer = tracer,
                        .trace_tile = trace_shadow_tile,
                        .lights = lights,
                        .light_count = light_count,
                        .visibility = visibility};
    run_work(&work);
}
