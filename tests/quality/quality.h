/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the quality tests share: one context, renders of it, and their images. */
#ifndef QUALITY_H
#define QUALITY_H

#include "check.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

static pnb_context *quality_context;

/* Opens the context of the functions below. Ends the program as skipped where there is no OpenGL. */
static inline void quality_open(void) {
    if (pnb_context_create(NULL, &quality_context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        exit(CHECK_SKIPPED);
    }
}

/* Closes it, and gives the program's exit code. */
static inline int quality_close(void) {
    pnb_context_destroy(&quality_context);
    return check_report();
}

/* Settings for a quick render: no anti-aliasing, passes Depth, Shadow and Shadow.<light>. */
static inline pnb_settings quality_settings(const char *technique, uint32_t width, uint32_t height) {
    pnb_settings settings = PNB_INIT(pnb_settings);
    settings.technique = technique;
    settings.width = width;
    settings.height = height;
    settings.passes = PNB_PASS_DEPTH | PNB_PASS_SHADOW | PNB_PASS_LIGHT_SHADOWS;
    settings.light_samples = 4;
    return settings;
}

/* The same, with the aspect of a procedural scene's image: `height` pixels high. */
static inline pnb_settings quality_scene_settings(const char *technique, const struct test_scene *scene,
                                                  uint32_t height) {
    const pnb_settings *own = test_scene_settings(scene);
    return quality_settings(technique, own->width * height / own->height, height);
}

/* Images of one render. After a failure, which counts as a failed check, job is NULL. */
struct render {
    pnb_job *job;
    uint32_t width, height;
    const float *depth, *shadow, *combined; /* 1, 3 and 4 channels; NULL if not among settings.passes */
};

static inline struct render quality_render(const pnb_scene *scene, const pnb_settings *settings) {
    struct render render = {0};
    if (!CHECK_RESULT(pnb_render(quality_context, scene, settings, &render.job), PNB_OK))
        return render;
    for (uint32_t i = 0; i < pnb_job_image_count(render.job); i++) {
        pnb_image image = PNB_INIT(pnb_image);
        CHECK_RESULT(pnb_job_get_image(render.job, i, &image), PNB_OK);
        render.width = image.width;
        render.height = image.height;
        if (strcmp(image.name, "Depth") == 0)
            render.depth = image.pixels;
        else if (strcmp(image.name, "Shadow") == 0)
            render.shadow = image.pixels;
        else if (strcmp(image.name, "Combined") == 0)
            render.combined = image.pixels;
    }
    return render;
}

static inline void render_free(struct render *render) {
    pnb_job_destroy(&render->job);
    *render = (struct render){0};
}

/* Pixels of the pass "Shadow.<light>", 3 channels; NULL if there is none. */
static inline const float *render_light_shadow(const struct render *render, const char *light) {
    char name[256];
    snprintf(name, sizeof name, "Shadow.%s", light);
    for (uint32_t i = 0; render->job && i < pnb_job_image_count(render->job); i++) {
        pnb_image image = PNB_INIT(pnb_image);
        if (pnb_job_get_image(render->job, i, &image) == PNB_OK && strcmp(image.name, name) == 0)
            return image.pixels;
    }
    return NULL;
}

/* Whether the Shadow pass of every pixel equals the other's, bit by bit. */
static inline bool render_shadows_equal(const struct render *a, const struct render *b) {
    return a->job && b->job && a->width == b->width && a->height == b->height &&
           memcmp(a->shadow, b->shadow, 3 * sizeof(float) * a->width * a->height) == 0;
}

/* Whether the camera sees anything at a pixel. */
static inline bool render_covers(const struct render *render, size_t pixel) {
    return render->depth[pixel] < 1e9f;
}

/* Root of the mean squared difference of the Shadow passes over the pixels covered in both. */
static inline double render_rmse(const struct render *a, const struct render *b) {
    if (!a->job || !b->job)
        return NAN;
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        if (!render_covers(a, i) || !render_covers(b, i))
            continue;
        for (size_t c = 0; c < 3; c++) {
            const double difference = (double)a->shadow[3 * i + c] - (double)b->shadow[3 * i + c];
            sum += difference * difference;
            count++;
        }
    }
    return sqrt(sum / count);
}

/* A test scene; its failure to build ends the program. parameter: NAN for the scene's default. */
static inline struct test_scene *quality_scene(const char *name, enum test_light light, float light_size,
                                               float parameter) {
    const struct test_scene_options options = {.light = light,
                                               .light_size = light_size,
                                               .parameter = isnan(parameter) ? 0 : parameter,
                                               .has_parameter = !isnan(parameter)};
    struct test_scene *scene = test_scene_create(name, &options);
    if (!scene) {
        printf("scene %s cannot be built: %s\n", name, pnb_last_error());
        exit(1);
    }
    return scene;
}

/* Whether a scene's lights are of every kind whatever is asked for, so that it needs to be tested once. */
static inline bool scene_has_own_lights(const char *name) {
    return strcmp(name, "all-lights") == 0;
}

/* Kinds of light to try a scene under. Those with translucent casters, which not every technique shows, have a test of
 * their own. */
static inline int scene_light_kinds(const struct test_scene_info *info) {
    return info->translucent ? 0 : scene_has_own_lights(info->name) ? 1 : TEST_LIGHT_COUNT;
}

/* World position of a pixel's surface, by the depth pass. */
static inline void render_position(const struct render *render, const pnb_camera *camera, const pnb_settings *settings,
                                   uint32_t x, uint32_t y, double position[3]) {
    const double depth = render->depth[(size_t)y * render->width + x];
    const double scale = camera->projection == PNB_PERSPECTIVE ? depth : 1;
    const double u = (x + settings->crop[0] + 0.5) / settings->width,
                 v = (y + settings->crop[1] + 0.5) / settings->height;
    const float *w = camera->window, *m = camera->matrix;
    const double right = scale * (w[0] + u * ((double)w[1] - (double)w[0]));
    const double up = scale * (w[2] + v * ((double)w[3] - (double)w[2]));
    for (int i = 0; i < 3; i++)
        position[i] = m[12 + i] + right * m[i] + up * m[4 + i] - depth * m[8 + i];
}

/* Writes a grey image to the folder PENUMBRA_TEST_IMAGES, if that is set: to be looked at. pixels: every
 * `stride`-th float is a value, 0..1. */
static inline void quality_show(const char *name, const float *pixels, uint32_t stride, uint32_t width,
                                uint32_t height) {
    const char *folder = getenv("PENUMBRA_TEST_IMAGES");
    if (!folder)
        return;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.pgm", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file)
        return;
    fprintf(file, "P5\n%u %u\n255\n", width, height);
    for (uint32_t y = height; y-- > 0;)
        for (uint32_t x = 0; x < width; x++)
            fputc((int)lrintf(255 * fminf(fmaxf(pixels[((size_t)y * width + x) * stride], 0), 1)), file);
    fclose(file);
}

#endif
