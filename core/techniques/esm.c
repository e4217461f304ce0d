/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../passes/passes.h"
#include "technique.h"

enum {
    C,
    DEPTH_RANGE,
    PREFILTER,
    LOOKUP,
    ANISOTROPY,
    CLASSIFICATION,
    ZMAX_OFFSET,
    EPSILON,
    FALLBACK,
    CONTACT,
    SHOW_FAILURES
};

enum { LOOKUP_BILINEAR };

static const char *const ranges[] = {"MAP", "BOUNDS", NULL};
static const char *const prefilters[] = {"NONE", "GAUSS_3", "GAUSS_5", "GAUSS_7", NULL};
static const char *const lookups[] = {"BILINEAR", "MIP", "ANISOTROPIC", NULL};
static const char *const classifications[] = {"NONE", "Z_MAX", "THRESHOLD", NULL};

static const struct parameter parameters[] = {
    [C] = {.name = "c",
           .label = "Exponent",
           .description =
               "Steepness of the shadow test. Light leaks under casters closer to their receiver than 3 / c of "
               "the depth range; beyond 80 single precision has no room for the sums of the filter",
           .unit = "",
           .type = PNB_FLOAT,
           .minimum = 1,
           .maximum = 87,
           .default_value = 80},
    [DEPTH_RANGE] = {.name = "depth_range",
                     .label = "Depth Range",
                     .description = "What the exponent refers to. MAP: from the nearest depth in the shadow map; leaks "
                                    "least. BOUNDS: from the bounding boxes of the casters",
                     .unit = "",
                     .type = PNB_ENUM,
                     .maximum = 1,
                     .items = ranges},
    [PREFILTER] = {.name = "prefilter",
                   .label = "Prefilter",
                   .description = "Gaussian the map is convolved with: how soft every edge is, in texels",
                   .unit = "",
                   .type = PNB_ENUM,
                   .maximum = 3,
                   .default_value = 1,
                   .items = prefilters},
    [LOOKUP] = {.name = "lookup",
                .label = "Lookup",
                .description =
                    "BILINEAR: the map as it is. MIP: averaged over the circle around the pixel. ANISOTROPIC: "
                    "averaged over the pixel's own ellipse; no aliasing far away, and no blur",
                .unit = "",
                .type = PNB_ENUM,
                .maximum = 2,
                .default_value = 2,
                .items = lookups},
    [ANISOTROPY] = {.name = "anisotropy",
                    .label = "Anisotropy",
                    .description = "Most lookups along the pixel's ellipse, with ANISOTROPIC",
                    .unit = "",
                    .type = PNB_INT,
                    .minimum = 1,
                    .maximum = 16,
                    .default_value = 8},
    [CLASSIFICATION] = {.name = "classification",
                        .label = "Failure Classification",
                        .description = "Finds pixels whose filter reaches behind their surface, where the exponential "
                                       "grows without bound. Z_MAX: by the greatest depth in the filter, never missing "
                                       "one. THRESHOLD: by a result beyond 1; faster",
                        .unit = "",
                        .type = PNB_ENUM,
                        .maximum = 2,
                        .default_value = 2,
                        .items = classifications},
    [ZMAX_OFFSET] = {.name = "zmax_offset",
                     .label = "Z-Max Offset",
                     .description =
                         "Depth behind a surface that Z_MAX still takes for the surface itself, as a share of "
                         "the depth range",
                     .unit = "",
                     .type = PNB_FLOAT,
                     .maximum = 1,
                     .default_value = 0.0006},
    [EPSILON] = {.name = "epsilon",
                 .label = "Threshold",
                 .description = "How far beyond 1 a result may be before THRESHOLD calls it a failure",
                 .unit = "",
                 .type = PNB_FLOAT,
                 .maximum = 10,
                 .default_value = 0.05},
    [FALLBACK] = {.name = "fallback",
                  .label = "PCF Fallback",
                  .description =
                      "Takes the mean of 2 x 2 shadow tests where the classification finds a failure, instead of "
                      "full light",
                  .unit = "",
                  .type = PNB_BOOL,
                  .maximum = 1,
                  .default_value = 1},
    [CONTACT] = {.name = "contact",
                 .label = "Contact Tests",
                 .description =
                     "Subtracts the light that leaks through the nearest 2 x 2 texels, where casters stand on a "
                     "surface; off, as in the paper",
                 .unit = "",
                 .type = PNB_BOOL,
                 .maximum = 1,
                 .default_value = 1},
    [SHOW_FAILURES] = {.name = "show_failures",
                       .label = "Show Failures",
                       .description = "Paints red where the classification finds a failure",
                       .unit = "",
                       .type = PNB_BOOL,
                       .maximum = 1},
    {0}};

/* Shadow map -> e^(c t), R32F, with as many levels as the texture has; only level 0 is filled. */
static pnb_result draw_exponential(struct frame *frame, const struct frame_light *light,
                                   const struct gl_texture *exponential) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    static const struct program_desc desc = {.vertex = "pass_screen.vert", .fragment = "pass_exponential.frag"};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Exponential map")) != PNB_OK)
        return result;
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    set_parameters(gl, program, light);
    gl_texture_bind(gl, &light->shadow_map, 0);
    gl_texture_bind(gl, &light->min_max, 1);
    program_set_int(gl, program, "shadow_map", 0);
    program_set_int(gl, program, "min_max", 1);
    for (int layer = 0; layer < exponential->layers && result == PNB_OK; layer++) {
        const struct gl_target target = {.colors = {exponential}, .color_count = 1, .layer = layer};
        result = gl_target_bind(gl, renderer->framebuffer, &target);
        program_set_int(gl, program, "layer", layer);
        if (result == PNB_OK)
            draw_screen(renderer);
    }
    pass_end(frame, gl_texture_bytes(exponential));
    return result == PNB_OK ? gl_check(gl, "exponential map") : result;
}

static pnb_result esm_prefilter(struct frame *frame, struct frame_light *light) {
    const double *values = light->parameters;
    const int side = light->shadow_map.width;
    int levels = 1;
    while (values[LOOKUP] != LOOKUP_BILINEAR && side >> levels > 0)
        levels++;
    struct gl_texture *exponential = &light->prefiltered[0];
    pnb_result result =
        gl_texture_ensure(frame->gl, exponential, GL_R32F, side, side, light->shadow_map.layers, levels);
    if (result == PNB_OK)
        result = draw_exponential(frame, light, exponential);
    if (result == PNB_OK && values[PREFILTER] > 0)
        result = pass_gauss(frame, exponential, 2 * (int)values[PREFILTER] + 1);
    if (result != PNB_OK || (result = pass_begin(frame, "Mip levels")) != PNB_OK)
        return result;
    gl_texture_set_linear(frame->gl, exponential);
    if (levels > 1)
        gl_texture_make_levels(frame->gl, exponential);
    pass_end(frame, gl_texture_bytes(exponential));
    return gl_check(frame->gl, "exponential map levels");
}

static void esm_bind(struct frame *frame, const struct frame_light *light, GLuint program, int unit) {
    if (light->prefiltered[0].id)
        gl_texture_bind(frame->gl, &light->prefiltered[0], unit);
    program_set_int(frame->gl, program, "prefiltered_0", unit);
}

const struct technique technique_esm = {
    .id = "ESM",
    .label = "Exponential Shadow Maps",
    .description = "Shadow edges softened by one width everywhere and free of aliasing, at a cost that does not grow",
    .paper = "T. Annen, T. Mertens, H.-P. Seidel, E. Flerackers, J. Kautz, Exponential Shadow Maps, 2008",
    .parameters = parameters,
    .needs = NEEDS_MIN_MAX,
    .shader = "tech_esm.glsl",
    .prefilter = esm_prefilter,
    .bind = esm_bind,
    .prefilter_bytes = 10, /* R32F with levels, and a copy while it is convolved */
};
