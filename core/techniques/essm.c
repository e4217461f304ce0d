/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../passes/passes.h"
#include "technique.h"

#include <math.h>
#include <string.h>

enum { MODE, C, DEPTH_RANGE, BITS, KERNEL, SLAB_HEIGHT, SUBDIVISION, EPSILON, SEARCH_REDUCTION, SKIP };
enum { MODE_ROBUST, MODE_AS_PUBLISHED };

/* ROBUST: small enough for a plane of its own. */
#define LARGEST_LOCAL_TILE 64
#define SMALLEST_TILE      8
#define MAX_LEVELS         16

static const char *const modes[] = {"ROBUST", "AS_PUBLISHED", NULL};
static const char *const ranges[] = {"MAP", "BOUNDS", NULL};
static const char *const kernels[] = {"RECTANGLE", "LEVEL_0", "LEVEL_1", "LEVEL_2", NULL};

static const struct parameter parameters[] = {
    [MODE] =
        {.name = "mode",
         .label = "Mode",
         .description =
             "ROBUST: each tile of the tables refers to a plane of its own, and what a table cannot "
             "resolve is sampled. AS_PUBLISHED: as the paper says; lit surfaces turn black in most of the depth range",
         .unit = "",
         .type = PNB_ENUM,
         .maximum = 1,
         .items = modes},
    [C] = {.name = "c",
           .label = "Exponent",
           .description =
               "Steepness of the shadow test. Light leaks under casters closer to their receiver than 3 / c of "
               "the depth range; the larger, the more kernels must be split or sampled. 0: the largest that the number "
               "format holds over the depth range",
           .unit = "",
           .type = PNB_FLOAT,
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
    [BITS] = {.name = "bits",
              .label = "Bits",
              .description =
                  "Precision of a value in a tile grid; each bit more takes a quarter off the area a tile may have",
              .unit = "bits",
              .type = PNB_INT,
              .minimum = 12,
              .maximum = 24,
              .default_value = 20},
    [KERNEL] = {.name = "kernel",
                .label = "Kernel",
                .description = "RECTANGLE: one rectangle. LEVEL_0, 1, 2: an ellipse that includes the pixel's own "
                               "footprint, of ever more rectangles: smooth far away and at grazing angles, and slower",
                .unit = "",
                .type = PNB_ENUM,
                .maximum = 3,
                .items = kernels},
    [SLAB_HEIGHT] = {.name = "slab_height",
                     .label = "Slab Height",
                     .description =
                         "Height of the rectangles an ellipse is made of; the lower, the smoother and slower",
                     .unit = "texels",
                     .type = PNB_FLOAT,
                     .minimum = 1,
                     .maximum = 64,
                     .default_value = 5},
    [SUBDIVISION] =
        {.name = "subdivision",
         .label = "Subdivision",
         .description =
             "Parts on each side into which kernels are split, in the search and where one reaches behind its "
             "surface; the more, the fewer wrongly lit pixels, and slower (paper: 3)",
         .unit = "",
         .type = PNB_INT,
         .minimum = 1,
         .maximum = 5,
         .default_value = 2},
    [EPSILON] = {.name = "epsilon",
                 .label = "Threshold",
                 .description = "How far beyond 1 a mean may be before its part of the kernel is sampled instead",
                 .unit = "",
                 .type = PNB_FLOAT,
                 .maximum = 10,
                 .default_value = 0.05},
    [SEARCH_REDUCTION] = {.name = "search_reduction",
                          .label = "Search Reduction",
                          .description =
                              "ROBUST: times the search area is shrunk to what the nearest blocker in it needs",
                          .unit = "",
                          .type = PNB_INT,
                          .maximum = 4,
                          .default_value = 2},
    [SKIP] = {.name = SKIP_PARAMETER,
              .label = "Min-Max Skip",
              .description =
                  "ROBUST: skips what the min-max pyramid shows to be fully lit or fully shadowed; faster, and "
                  "takes away what the exponential leaks there",
              .unit = "",
              .type = PNB_BOOL,
              .maximum = 1,
              .default_value = 1},
    {0}};

/* What fills the tables of one light. */
struct essm {
    struct frame_light *light;
    struct gl_texture pyramid; /* AS_PUBLISHED, RGBA32F: pass_exponential_pyramid.comp */
    int level;                 /* being made */
};

static int log2_of(int power) {
    int log = 0;
    while (1 << log < power)
        log++;
    return log;
}

/* c, or the optimal one for the range of t, which is 0..1 however deep the scene, and the number format. ROBUST:
 * factors between planes, up to e^c, are single floats. AS_PUBLISHED: e^-c must be 50 units of its integers to be told
 * from less; more would turn what is near to the light black. */
static float essm_exponent(const double *values) {
    const double most_of_floats = 80, resolved = 50;
    if (values[C] > 0)
        return (float)values[C];
    return (float)(values[MODE] == MODE_ROBUST ? most_of_floats : log(exp2(values[BITS]) / resolved));
}

/* What the shaders of the prefilter and of the technique must agree on. */
static void set_basis_uniforms(const struct gl *gl, GLuint program, const struct frame_light *light) {
    float near_ratio[8] = {0};
    program_set_float(gl, program, "p_c", essm_exponent(light->parameters));
    program_set_int(gl, program, "tile_log", log2_of(light->prefiltered_tile));
    for (int i = 0; i < light->views.count; i++) {
        const struct light_view *view = &light->views.views[i];
        near_ratio[i] = view->perspective != 0.0f ? view->near_depth / (view->far_depth - view->near_depth) : 0.0f;
    }
    gl->Uniform4fv(gl->GetUniformLocation(program, "near_ratio"), 2, near_ratio);
}

/* What essm_basis.glsl reads. */
static void bind_basis(struct frame *frame, GLuint program, const struct essm *essm) {
    static const char *const names[] = {"shadow_map", "min_max", "pyramid", "tile_planes"};
    const struct gl *gl = frame->gl;
    const struct frame_light *light = essm->light;
    const struct gl_texture *const textures[] = {&light->shadow_map, &light->min_max, &essm->pyramid,
                                                 &light->prefiltered[2]};
    set_parameters(gl, program, light);
    for (int i = 0; i < 4; i++) {
        if (textures[i]->id)
            gl_texture_bind(gl, textures[i], i);
        program_set_int(gl, program, names[i], i);
    }
    set_basis_uniforms(gl, program, light);
    program_set_int(gl, program, "level", essm->level);
}

/* Makes the pyramid; greatest[k]: the greatest value of a table whose tiles were the blocks of its level k. */
static pnb_result make_pyramid(struct frame *frame, struct essm *essm, float greatest[MAX_LEVELS]) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = frame->gl;
    const struct gl_texture *min_max = &essm->light->min_max;
    pnb_result result = gl_texture_ensure(gl, &essm->pyramid, GL_RGBA32F, min_max->width, min_max->height,
                                          min_max->layers, min_max->levels);
    if (result != PNB_OK)
        return result;
    static const struct program_desc desc = {.compute = "pass_exponential_pyramid.comp"};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK ||
        (result = pass_begin(frame, "Exponential pyramid")) != PNB_OK)
        return result;
    memset(greatest, 0, MAX_LEVELS * sizeof *greatest);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, renderer->range_buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, MAX_LEVELS * sizeof *greatest, greatest, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, renderer->range_buffer);
    for (essm->level = 1; essm->level <= essm->pyramid.levels; essm->level++) {
        const GLuint groups = (GLuint)((essm->pyramid.width >> (essm->level - 1)) + 7) / 8;
        bind_basis(frame, program, essm);
        gl->BindImageTexture(0, essm->pyramid.id, essm->level - 1, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        gl->DispatchCompute(groups, groups, (GLuint)essm->pyramid.layers);
        gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, MAX_LEVELS * sizeof *greatest, greatest);
    pass_end(frame, gl_texture_bytes(&essm->pyramid));
    return gl_check(gl, "exponential pyramid");
}

/* AS_PUBLISHED: the largest tile whose sums stay below 2^32 (section 6.1), which they do when the mean of each block of
 * a level of the pyramid is below 2^(32 - bits) / area. */
static pnb_result choose_tile(struct frame *frame, struct essm *essm) {
    const int bits = (int)essm->light->parameters[BITS];
    float greatest[MAX_LEVELS];
    pnb_result result = make_pyramid(frame, essm, greatest);
    for (int level = log2_of(SMALLEST_TILE); level <= essm->pyramid.levels && level < MAX_LEVELS; level++)
        if (greatest[level] <= ldexpf(1.0f, 32 - bits - 2 * level))
            essm->light->prefiltered_tile = 1 << level;
    return result;
}

/* ROBUST: the plane that each tile of each level refers to. */
static pnb_result make_planes(struct frame *frame, struct essm *essm, int levels) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = frame->gl;
    struct gl_texture *planes = &essm->light->prefiltered[2];
    const int side = 1 << (levels - 1);
    pnb_result result = gl_texture_ensure(gl, planes, GL_RGBA32F, side, side, essm->light->shadow_map.layers, levels);
    if (result != PNB_OK)
        return result;
    static const struct program_desc desc = {.compute = "pass_tile_planes.comp"};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK ||
        (result = pass_begin(frame, "Tile planes")) != PNB_OK)
        return result;
    for (essm->level = 0; essm->level < levels; essm->level++) {
        const GLuint tiles = (GLuint)(side >> essm->level);
        bind_basis(frame, program, essm);
        gl->BindImageTexture(0, planes->id, essm->level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        gl->DispatchCompute(tiles, tiles, (GLuint)planes->layers);
    }
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    pass_end(frame, gl_texture_bytes(planes));
    return gl_check(gl, "tile planes");
}

static void bind_values(struct frame *frame, GLuint program, const void *user) {
    bind_basis(frame, program, user);
}

/* Tables of one or two channels, of every level a kernel may need. */
static pnb_result make_tables(struct frame *frame, struct essm *essm, int channels, int levels,
                              struct gl_texture *table) {
    const int side = essm->light->shadow_map.width;
    /* Rounded up, so that no level loses a row. */
    const int padded = (side + (1 << (levels - 1)) - 1) >> (levels - 1) << (levels - 1);
    pnb_result result = summed_area_ensure(frame->gl, table, channels, padded, essm->light->shadow_map.layers, levels);
    const struct summed_area sums = {.channels = channels,
                                     .tile = essm->light->prefiltered_tile,
                                     .scale = ldexpf(1.0f, (int)essm->light->parameters[BITS]) - 1.0f,
                                     .values = "essm_values.glsl",
                                     .bind = bind_values,
                                     .user = essm};
    for (essm->level = 0; essm->level < levels && result == PNB_OK; essm->level++)
        result = pass_summed_area(frame, &sums, table, essm->level);
    return result;
}

static pnb_result essm_prefilter(struct frame *frame, struct frame_light *light) {
    struct essm essm = {.light = light};
    const bool robust = light->parameters[MODE] == MODE_ROBUST;
    pnb_result result;
    int levels = 1;
    /* Values of 1 all over a tile must not overflow. */
    light->prefiltered_tile = robust ? 1 << ((32 - (int)light->parameters[BITS]) / 2) : SMALLEST_TILE;
    if (light->prefiltered_tile > LARGEST_LOCAL_TILE)
        light->prefiltered_tile = LARGEST_LOCAL_TILE;
    while (robust && light->prefiltered_tile << (levels - 1) < light->shadow_map.width)
        levels++;
    result = robust ? make_planes(frame, &essm, levels) : choose_tile(frame, &essm);
    if (result == PNB_OK)
        result = make_tables(frame, &essm, 1, levels, &light->prefiltered[0]);
    if (result == PNB_OK)
        result = make_tables(frame, &essm, 2, levels, &light->prefiltered[1]);
    gl_texture_free(frame->gl, &essm.pyramid);
    return result;
}

static const char *essm_defines(const double *values) {
    static const char *const defines[2][4] = {
        {"#define MODE 0\n#define KERNEL 0\n", "#define MODE 0\n#define KERNEL 1\n",
         "#define MODE 0\n#define KERNEL 2\n", "#define MODE 0\n#define KERNEL 3\n"},
        {"#define MODE 1\n#define KERNEL 0\n", "#define MODE 1\n#define KERNEL 1\n",
         "#define MODE 1\n#define KERNEL 2\n", "#define MODE 1\n#define KERNEL 3\n"}};
    return defines[(int)values[MODE]][(int)values[KERNEL]];
}

static void essm_bind(struct frame *frame, const struct frame_light *light, GLuint program, int unit) {
    static const char *const names[] = {"prefiltered_0", "prefiltered_1", "tile_planes"};
    for (int i = 0; i < 3; i++) {
        if (light->prefiltered[i].id)
            gl_texture_bind(frame->gl, &light->prefiltered[i], unit + i);
        program_set_int(frame->gl, program, names[i], unit + i);
    }
    set_basis_uniforms(frame->gl, program, light);
}

const struct technique technique_essm = {
    .id = "ESSM",
    .label = "Exponential Soft Shadow Maps",
    .description =
        "Penumbrae as wide as the light's size and the average blocker make them, at a cost that does not grow",
    .paper = "L. Shen, J. Feng, B. Yang, Exponential Soft Shadow Mapping, 2013",
    .parameters = parameters,
    .needs = NEEDS_MIN_MAX,
    .shader = "tech_essm.glsl",
    .prefilter = essm_prefilter,
    .defines = essm_defines,
    .bind = essm_bind,
    .prefilter_bytes = 19, /* 4 + 8 with levels and planes; AS_PUBLISHED without, and the pyramid while they are made */
};
