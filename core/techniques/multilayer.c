/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../passes/passes.h"
#include "technique.h"

#include <math.h>
#include <stdio.h>

enum {
    DEPTH_LAYERS,
    MERGE_DISTANCE,
    LEVELS,
    PYRAMID,
    STACK_SIZE,
    MERGE_ACCUMULATION,
    LOOKUP_ACCUMULATION,
    BASE_SUBSAMPLING,
    FACES,
    BASE_MERGE_DISTANCE,
    SUBSAMPLING,
    LOOKUPS,
    ANTIALIASING
};

static const char *const pyramids[] = {"MIP_MAP", "Y_MAP", NULL};
enum { MIP_MAP, Y_MAP };

static const char *const face_choices[] = {"ALL", "BACK", NULL};
enum { ALL_FACES, BACK_FACES };

static const char *const accumulations[] = {"ADD", "MULTIPLY", "MAXIMUM", NULL};
enum { ADD, MULTIPLY, MAXIMUM };

static const struct parameter parameters[] = {
    [DEPTH_LAYERS] = {.name = "depth_layers",
                      .label = "Depth Layers",
                      .description =
                          "Surfaces behind one another that are kept of each texel of the map, the nearest to the "
                          "light; 0: all. Two look plausible, and are faster than many",
                      .unit = "",
                      .type = PNB_INT,
                      .maximum = 256},
    [MERGE_DISTANCE] = {.name = "merge_distance",
                        .label = "Merge Distance",
                        .description =
                            "Surfaces that lie closer to one another in depth become one when texels are merged, "
                            "in widths of the merged texel. More is faster; from about 50 on shadows are lost",
                        .unit = "texels",
                        .type = PNB_FLOAT,
                        .minimum = 0.25,
                        .maximum = 1000,
                        .default_value = 2},
    [LEVELS] = {.name = "levels",
                .label = "Levels",
                .description =
                    "Levels of the map, each filtered twice as wide as the one before: fewer are faster, but limit "
                    "how wide a penumbra can be",
                .unit = "",
                .type = PNB_INT,
                .minimum = 1,
                .maximum = MAX_FRAGMENT_LEVELS,
                .default_value = 11},
    [PYRAMID] = {.name = "pyramid",
                 .label = "Pyramid",
                 .description =
                     "MIP_MAP: each level has half the texels per side of the one before, which shows in wide "
                     "penumbrae. Y_MAP: from the stack size on they keep their number",
                 .unit = "",
                 .type = PNB_ENUM,
                 .maximum = 1,
                 .default_value = Y_MAP,
                 .items = pyramids},
    [STACK_SIZE] = {.name = "stack_size",
                    .label = "Stack Size",
                    .description = "Texels per side of the wide levels of a Y_MAP",
                    .unit = "texels",
                    .type = PNB_INT,
                    .minimum = 8,
                    .maximum = 1024,
                    .default_value = 128},
    [MERGE_ACCUMULATION] = {.name = "merge_accumulation",
                            .label = "Merged Opacity",
                            .description =
                                "Of surfaces that are merged behind one another. ADD: as if side by side. MULTIPLY: "
                                "as if independent of one another. MAXIMUM: as if one hid the others",
                            .unit = "",
                            .type = PNB_ENUM,
                            .maximum = 2,
                            .default_value = MULTIPLY,
                            .items = accumulations},
    [LOOKUP_ACCUMULATION] = {.name = "lookup_accumulation",
                             .label = "Total Opacity",
                             .description =
                                 "Of all surfaces before a receiver. ADD: as if side by side, too dark where they "
                                 "overlap. MULTIPLY: as if independent. MAXIMUM: as if one hid the others",
                             .unit = "",
                             .type = PNB_ENUM,
                             .maximum = 2,
                             .default_value = MULTIPLY,
                             .items = accumulations},
    [BASE_SUBSAMPLING] = {.name = "base_subsampling",
                          .label = "Base Sub-Sampling",
                          .description =
                              "Levels made by leaving out texels instead of merging: faster with large maps, whose "
                              "finest texels then serve contacts only",
                          .unit = "levels",
                          .type = PNB_INT,
                          .maximum = 3},
    [FACES] = {.name = "faces",
               .label = "Faces",
               .description =
                   "ALL: every surface. BACK: of solid bodies only what is turned away from the light, as in "
                   "the paper; fewer surfaces, but bodies that stand on something lose most of their shadow",
               .unit = "",
               .type = PNB_ENUM,
               .maximum = 1,
               .default_value = ALL_FACES,
               .items = face_choices},
    [BASE_MERGE_DISTANCE] = {.name = "base_merge_distance",
                             .label = "Base Merge Distance",
                             .description =
                                 "Surfaces of one texel of the map itself that lie closer to one another in depth "
                                 "become one, before any are left out; in widths of the texel, 0: none",
                             .unit = "texels",
                             .type = PNB_FLOAT,
                             .maximum = 100},
    [SUBSAMPLING] = {.name = SUBSAMPLING_PARAMETER,
                     .label = "Image Sub-Sampling",
                     .description = "Shadows of every other pixel, and between them only where surfaces or shadows "
                                    "have edges: faster, the more so the larger the image",
                     .unit = "",
                     .type = PNB_BOOL,
                     .maximum = 1},
    [LOOKUPS] = {.name = "lookups",
                 .label = "Lookups",
                 .description = "Parts that the light is cut into along each side, a long one more along its length, "
                                "each looked up on its own in maps that are less blurred: more are truer where "
                                "shadows overlap, and slower",
                 .unit = "per side",
                 .type = PNB_INT,
                 .minimum = 1,
                 .maximum = 4,
                 .default_value = 2},
    [ANTIALIASING] = {.name = "antialiasing",
                      .label = "Shadow Anti-Aliasing",
                      .description = "Shadows are at least as soft as a pixel is wide, where pixels are wider than the "
                                     "map's texels: for pictures of one sample",
                      .unit = "",
                      .type = PNB_BOOL,
                      .maximum = 1},
    {0}};

/* Along one axis of the emitter. */
#define MOST_PARTS 16.0f

static const char *multilayer_defines(const double *values) {
    return accumulation_define((int)values[LOOKUP_ACCUMULATION]);
}

/* Side of the square with the emitter's area. */
static float light_size(const struct emitter *emitter) {
    if (emitter->type == PNB_LIGHT_SUN)
        return 1.772f * emitter->tan_half_angle;
    if (emitter->type != PNB_LIGHT_AREA)
        return 1.772f * emitter->radius;
    const float u = glm_vec3_norm((float *)emitter->half_u), v = glm_vec3_norm((float *)emitter->half_v);
    return (emitter->ellipse ? 1.772f : 2.0f) * sqrtf(u * v);
}

/* How long the emitter is for its width, as texels of the map see it. */
static float elongation(const struct frame_light *light) {
    const struct emitter *emitter = &light->emitter;
    float ratio = 1.0f;
    if (emitter->type == PNB_LIGHT_AREA)
        ratio = glm_vec3_norm((float *)emitter->half_u) / glm_vec3_norm((float *)emitter->half_v);
    if (light->views.single)
        ratio *= light->views.views[0].rect[2] / light->views.views[0].rect[3];
    return ratio;
}

/* Parts along each of the emitter's axes: as many as for a square one at least, and about as long as wide, for filters
 * are square. */
static void cut_emitter(const struct frame_light *light, int parts[2]) {
    const float ratio = elongation(light), longer = fmaxf(ratio, 1.0f / ratio);
    const float lookups = (float)light->parameters[LOOKUPS];
    const float across = fmaxf(roundf(lookups / sqrtf(longer) + 0.1f), 1.0f);
    const float along = fmaxf(ceilf(lookups * lookups / across), floorf(longer));
    const int longer_axis = ratio < 1.0f;
    parts[longer_axis] = (int)fminf(along, MOST_PARTS);
    parts[!longer_axis] = (int)across;
}

static pnb_result multilayer_prefilter(struct frame *frame, struct frame_light *light) {
    const double *values = light->parameters;
    int parts[2];
    cut_emitter(light, parts);
    const float part_size = light_size(&light->emitter) / sqrtf((float)(parts[0] * parts[1]));
    const struct fragment_filter filter = {.level_count = (int)values[LEVELS],
                                           .stack_side = (int)values[PYRAMID] == Y_MAP ? (int)values[STACK_SIZE] : 0,
                                           .subsampled_levels = (int)values[BASE_SUBSAMPLING],
                                           .accumulation = (int)values[MERGE_ACCUMULATION],
                                           .merge_distance = (float)values[MERGE_DISTANCE],
                                           .light_size = part_size};
    char what[128];
    snprintf(what, sizeof what, "MULTILAYER, surfaces before light '%.64s'", light->source->name);
    const struct fragment_choice choice = {.casters = CASTERS_ALL,
                                           .back_faces = (int)values[FACES] == BACK_FACES,
                                           .joined = (float)values[BASE_MERGE_DISTANCE],
                                           .accumulation = (int)values[MERGE_ACCUMULATION],
                                           .most = (uint32_t)values[DEPTH_LAYERS]};
    pnb_result result = pass_fragment_lists(frame, &light->views, &choice, &light->shadow_map, what, &light->lists);
    if (result == PNB_OK)
        result = pass_fragment_filter(frame, &light->views, &filter, light->shadow_map.width, what, &light->lists);
    return result;
}

static void multilayer_bind(struct frame *frame, const struct frame_light *light, GLuint program, int unit) {
    (void)unit;
    const struct gl *gl = frame->gl;
    const struct fragment_lists *lists = &light->lists;
    GLint levels[MAX_FRAGMENT_LEVELS][4] = {0};
    GLfloat widths[MAX_FRAGMENT_LEVELS] = {0};
    for (uint32_t i = 0; i < lists->level_count; i++) {
        const struct fragment_level *level = &lists->levels[i];
        levels[i][0] = (GLint)level->first_head;
        levels[i][1] = level->side;
        levels[i][2] = level->log2_texel;
        levels[i][3] = level->stack > 0 ? level->border : -1;
        widths[i] = level->filter_width;
    }
    gl->Uniform4iv(gl->GetUniformLocation(program, "levels"), MAX_FRAGMENT_LEVELS, levels[0]);
    gl->Uniform1fv(gl->GetUniformLocation(program, "filter_widths"), MAX_FRAGMENT_LEVELS, widths);
    GLint parts[2];
    cut_emitter(light, parts);
    gl->Uniform2iv(gl->GetUniformLocation(program, "parts"), 1, parts);
    program_set_int(gl, program, "level_count", (int)lists->level_count);
    fragment_lists_bind(frame, program, lists);
}

const struct technique technique_multilayer = {
    .id = "MULTILAYER",
    .label = "Filtered Multi-Layer Maps",
    .description =
        "All surfaces before each receiver, with their transparency and colour, each blurred by its own depth",
    .paper = "K. Selgrad, C. Dachsbacher, Q. Meyer, M. Stamminger, Filtering Multi-Layer Shadow Maps for Accurate Soft "
             "Shadows, 2015",
    .parameters = parameters,
    .needs = NEEDS_MIN_MAX | NEEDS_ALL_CASTERS,
    .shader = "tech_multilayer.glsl",
    .defines = multilayer_defines,
    .prefilter = multilayer_prefilter,
    .prefilter_bytes = 64,
    .bind = multilayer_bind,
};
