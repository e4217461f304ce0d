/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes that prefilter maps, against sums in double precision or whole numbers made here: Gaussian, mip levels,
 * summed-area tables of floats and of integers, in one tile and in many, and what rectangles look up in them. */
#include "pass_bench.h"

#include "gl/shader_source.h"

/* ---- Gaussian and mip levels ---- */

static float *random_pixels(size_t count, uint32_t seed) {
    float *pixels = malloc(count * sizeof *pixels);
    for (size_t i = 0; i < count; i++)
        pixels[i] = (float)next_random(&seed) / 16777216.0f;
    return pixels;
}

/* e^(c t) up to c = 87: positive terms, so that the relative error of a mean is that of its parts. */
static float *random_exponentials(size_t count, uint32_t seed) {
    float *pixels = random_pixels(count, seed);
    for (size_t i = 0; i < count; i++)
        pixels[i] = expf(87 * pixels[i]);
    return pixels;
}

static int clamp_index(int i, int side) {
    return i < 0 ? 0 : i >= side ? side - 1 : i;
}

static double gauss_at(const float *pixels, int side, int x, int y, int width) {
    static const double weights[3][7] = {{1, 2, 1}, {1, 4, 6, 4, 1}, {1, 6, 15, 20, 15, 6, 1}};
    const int radius = width / 2;
    double sum = 0, total = 0;
    for (int j = -radius; j <= radius; j++)
        for (int i = -radius; i <= radius; i++) {
            const double weight = weights[radius - 1][i + radius] * weights[radius - 1][j + radius];
            sum += weight * (double)pixels[clamp_index(y + j, side) * side + clamp_index(x + i, side)];
            total += weight;
        }
    return sum / total;
}

static void gauss(struct bench *bench, int side, int width) {
    const struct gl *gl = &bench->backend.gl;
    const size_t count = (size_t)side * (size_t)side;
    float *pixels = random_exponentials(2 * count, (uint32_t)width);
    struct gl_texture texture = {0};
    CHECK_RESULT(gl_texture_ensure(gl, &texture, GL_R32F, side, side, 2, 1), PNB_OK);
    upload_texture(bench, &texture, GL_RED, pixels);
    CHECK_RESULT(pass_gauss(&bench->frame, &texture, width), PNB_OK);
    float *result = read_texture(gl, &texture, 0, GL_RED, 1);
    double worst = 0;
    for (size_t i = 0; i < 2 * count; i++) {
        const int x = (int)(i % (size_t)side), y = (int)(i % count / (size_t)side);
        worst = fmax(worst, fabs((double)result[i] / gauss_at(pixels + i / count * count, side, x, y, width) - 1));
    }
    printf("Gaussian of %d texels, %d x %d x 2: worst relative error %.1e\n", width, side, side, worst);
    CHECK_AT_MOST(worst, 1e-6); /* two sums of 7 products of floats: 16 roundings of 6e-8 */
    free(result);
    free(pixels);
    gl_texture_free(gl, &texture);
}

static void mip_levels(struct bench *bench, int side) {
    const struct gl *gl = &bench->backend.gl;
    const size_t count = (size_t)side * (size_t)side;
    float *pixels = random_exponentials(count, 1);
    int levels = 1;
    while (side >> levels > 0)
        levels++;
    struct gl_texture texture = {0};
    CHECK_RESULT(gl_texture_ensure(gl, &texture, GL_R32F, side, side, 1, levels), PNB_OK);
    upload_texture(bench, &texture, GL_RED, pixels);
    gl_texture_make_levels(gl, &texture);
    double worst = 0;
    for (int level = 0; level < levels; level++) {
        float *result = read_texture(gl, &texture, level, GL_RED, 1);
        const int step = 1 << level, size = side >> level;
        for (int i = 0; i < size * size; i++) {
            double sum = 0;
            for (int k = 0; k < step * step; k++)
                sum += (double)pixels[(i / size * step + k / step) * side + i % size * step + k % step];
            worst = fmax(worst, fabs((double)result[i] * step * step / sum - 1));
        }
        free(result);
    }
    printf("mip levels of %d x %d: worst relative error %.1e\n", side, side, worst);
    CHECK_AT_MOST(worst, 2e-6); /* a rounding per level and sum */
    free(pixels);
    gl_texture_free(gl, &texture);
}

/* ---- Summed-area tables ---- */

/* The values: of two channels the second is the map's depth as it is, since essm_values.glsl takes it so AS_PUBLISHED.
 */
struct table_case {
    int side, tile;
    bool floats;
    struct gl_texture map, min_max, table;
    float *depths;
    bool with_nan;
};

static void bind_depths(struct frame *frame, GLuint program, const void *user) {
    const struct table_case *c = user;
    const struct gl *gl = frame->gl;
    gl_texture_bind(gl, &c->map, 0);
    gl_texture_bind(gl, &c->min_max, 1);
    program_set_int(gl, program, "shadow_map", 0);
    program_set_int(gl, program, "min_max", 1);
    program_set_int(gl, program, "p_mode", 1);
    program_set_int(gl, program, "p_depth_range", 1);
    program_set_float(gl, program, "p_c", 1);
    program_set_int(gl, program, "level", 0);
}

#define SCALE 1048576.0f /* 2^20: sums of a tile of 64 x 64 reach 2^32 */

static bool table_make(struct bench *bench, struct table_case *c) {
    const struct gl *gl = &bench->backend.gl;
    /* What is uploaded as depth is clamped to 0..1, a NaN to 0. */
    const GLenum format = c->with_nan ? GL_R32F : GL_DEPTH_COMPONENT32F;
    CHECK_RESULT(gl_texture_ensure(gl, &c->map, format, c->side, c->side, 1, 1), PNB_OK);
    upload_texture(bench, &c->map, c->with_nan ? GL_RED : GL_DEPTH_COMPONENT, c->depths);
    CHECK_RESULT(gl_texture_ensure(gl, &c->min_max, GL_RG32F, 1, 1, 1, 1), PNB_OK);
    if (!CHECK_RESULT(summed_area_ensure(gl, &c->table, 2, c->side, 1, 1), PNB_OK))
        return false;
    const struct summed_area sums = {.channels = 2,
                                     .tile = c->tile,
                                     .floats = c->floats,
                                     .scale = SCALE,
                                     .values = "essm_values.glsl",
                                     .bind = bind_depths,
                                     .user = c};
    return CHECK_RESULT(pass_summed_area(&bench->frame, &sums, &c->table, 0), PNB_OK);
}

static void table_free(struct bench *bench, struct table_case *c) {
    gl_texture_free(&bench->backend.gl, &c->map);
    gl_texture_free(&bench->backend.gl, &c->min_max);
    gl_texture_free(&bench->backend.gl, &c->table);
    free(c->depths);
}

/* Every entry of an integer table, exactly. */
static void entries_are_exact(struct bench *bench, int side, int tile) {
    struct table_case c = {.side = side, .tile = tile, .depths = random_pixels((size_t)side * (size_t)side, 7)};
    if (table_make(bench, &c)) {
        const struct gl *gl = &bench->backend.gl;
        const size_t count = (size_t)side * (size_t)side;
        uint32_t *entries = malloc(2 * count * sizeof *entries), *sums = calloc(count, sizeof *sums);
        gl_texture_bind(gl, &c.table, 0);
        gl->GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, entries);
        int wrong = 0;
        for (size_t i = 0; i < count; i++) {
            const size_t x = i % (size_t)side, y = i / (size_t)side;
            const bool left = x % (size_t)tile, below = y % (size_t)tile;
            sums[i] = (uint32_t)(c.depths[i] * SCALE + 0.5f) + (left ? sums[i - 1] : 0) +
                      (below ? sums[i - (size_t)side] : 0) - (left && below ? sums[i - (size_t)side - 1] : 0);
            wrong += entries[2 * i + 1] != sums[i];
        }
        printf("integer table of %d x %d in tiles of %d: %d wrong entries\n", side, side, tile, wrong);
        CHECK_INT(wrong, 0);
        free(entries);
        free(sums);
    }
    table_free(bench, &c);
}

/* ---- Rectangles ---- */

#define RECTANGLES 4096
static const char lookup_shader[] =
    "layout(local_size_x = 64) in;\n"
    "uniform usampler2DArray table;\n"
    "uniform int tile, floats;\n"
    "layout(std430, binding = 0) buffer rectangle_block { vec4 rectangles[]; };\n"
    "void main() {\n"
    "    vec2 low = rectangles[gl_GlobalInvocationID.x].xy, high = rectangles[gl_GlobalInvocationID.x].zw;\n"
    "    ivec2 first = ivec2(low) / tile, last = (ivec2(ceil(high)) - 1) / tile;\n"
    "    float sum = 0.0;\n"
    "    for (int y = first.y; y <= last.y; y++)\n"
    "        for (int x = first.x; x <= last.x; x++) {\n"
    "            vec2 corner = vec2(x, y) * float(tile);\n"
    "            sum += table_sum(table, 0, ivec2(0), ivec2(x, y) * tile, tile, max(low, corner), min(high, corner + "
    "float(tile)),\n"
    "                             floats == 1);\n"
    "        }\n"
    "    rectangles[gl_GlobalInvocationID.x].x = sum;\n"
    "}\n";

static GLuint lookup_program(const struct gl *gl) {
    const struct shader_source *library = shader_sources;
    while (library->name && strcmp(library->name, "common_summed_area.glsl") != 0)
        library++;
    const char *texts[] = {"#version 430 core\n#define TABLE_CHANNEL 1\n", library->text, lookup_shader};
    const GLuint shader = gl->CreateShader(GL_COMPUTE_SHADER), program = gl->CreateProgram();
    gl->ShaderSource(shader, 3, texts, NULL);
    gl->CompileShader(shader);
    gl->AttachShader(program, shader);
    gl->LinkProgram(program);
    GLint linked = 0;
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    CHECK_INT(linked, 1);
    gl->DeleteShader(shader);
    return program;
}

/* Sums of the rectangles, into the first element of each. */
static void look_up(const struct gl *gl, const struct table_case *c, float rectangles[RECTANGLES][4]) {
    const GLuint program = lookup_program(gl);
    GLuint buffer;
    gl->UseProgram(program);
    gl->GenBuffers(1, &buffer);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, RECTANGLES * 16, rectangles, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    gl_texture_bind(gl, &c->table, 0);
    program_set_int(gl, program, "table", 0);
    program_set_int(gl, program, "tile", c->tile);
    program_set_int(gl, program, "floats", c->floats);
    gl->DispatchCompute(RECTANGLES / 64, 1, 1);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, RECTANGLES * 16, rectangles);
    gl->DeleteBuffers(1, &buffer);
    gl->DeleteProgram(program);
}

/* Share of texel i within low .. high. */
static double share(int i, double low, double high) {
    return fmax(fmin(i + 1, high) - fmax(i, low), 0);
}

static double mean_over(const struct table_case *c, const float rectangle[4]) {
    double sum = 0;
    for (int y = (int)rectangle[1]; y < rectangle[3]; y++)
        for (int x = (int)rectangle[0]; x < rectangle[2]; x++)
            sum += share(x, (double)rectangle[0], (double)rectangle[2]) *
                   share(y, (double)rectangle[1], (double)rectangle[3]) *
                   (double)c->depths[(size_t)y * (size_t)c->side + (size_t)x];
    return sum / (((double)rectangle[2] - (double)rectangle[0]) * ((double)rectangle[3] - (double)rectangle[1]));
}

/* Rectangles of up to 60 texels anywhere; every fourth starts at a tile's border, another one ends there. */
static void random_rectangles(int side, int tile, float rectangles[RECTANGLES][4]) {
    uint32_t random = 3;
    for (int i = 0; i < RECTANGLES; i++)
        for (int axis = 0; axis < 2; axis++) {
            const float size = 0.01f + 60 * (float)next_random(&random) / 16777216.0f;
            float low = ((float)side - size) * (float)next_random(&random) / 16777216.0f, high = low + size;
            const float border = (float)(tile * (int)((low + high) / 2 / (float)tile));
            if (i % 4 == 1 && border + size < (float)side)
                low = border, high = border + size;
            if (i % 4 == 2 && border - size > 0)
                low = border - size, high = border;
            rectangles[i][axis] = fmaxf(low, 0);
            rectangles[i][2 + axis] = fminf(high, (float)side);
        }
}

/* Standard deviation and worst error of means. */
static void rectangles_are_exact(struct bench *bench, int side, int tile, bool floats, double allowed) {
    struct table_case c = {.side = side, .tile = tile, .floats = floats};
    c.depths = random_pixels((size_t)side * (size_t)side, 11);
    static float rectangles[RECTANGLES][4], results[RECTANGLES][4];
    random_rectangles(side, tile, rectangles);
    memcpy(results, rectangles, sizeof results);
    if (table_make(bench, &c)) {
        look_up(&bench->backend.gl, &c, results);
        double worst = 0, squares = 0;
        for (int i = 0; i < RECTANGLES; i++) {
            const float *r = rectangles[i];
            const double area = ((double)r[2] - (double)r[0]) * ((double)r[3] - (double)r[1]);
            const double mean = (double)results[i][0] / area / (floats ? 1 : (double)SCALE);
            const double error = mean - mean_over(&c, r);
            worst = fmax(worst, area > 1 ? fabs(error) : 0);
            squares += area > 1 ? error * error : 0;
        }
        printf("%s table of %4d x %4d in tiles of %4d: means of rectangles off by at most %.1e, in the mean by %.1e\n",
               floats ? "float  " : "integer", side, side, tile, worst, sqrt(squares / RECTANGLES));
        if (allowed > 0)
            CHECK_AT_MOST(worst, allowed);
    }
    table_free(bench, &c);
}

/* ---- A fully lit plane ---- */

/* Kernels of 4 texels on a map whose depth is the same everywhere; every other one lies across the border of a tile. */
static void plane_is_even(struct bench *bench, int tile, bool floats, double allowed) {
    struct table_case c = {.side = 4096, .tile = tile, .floats = floats};
    const size_t count = (size_t)c.side * (size_t)c.side;
    static float rectangles[RECTANGLES][4], results[RECTANGLES][4];
    uint32_t random = 5;
    c.depths = malloc(count * sizeof *c.depths);
    for (size_t i = 0; i < count; i++)
        c.depths[i] = 0.7f;
    for (int i = 0; i < RECTANGLES; i++)
        for (int axis = 0; axis < 2; axis++) {
            const float at = 4090 * (float)next_random(&random) / 16777216.0f;
            rectangles[i][axis] = i % 2 && at > 64 ? floorf(at / 64) * 64 - 1.3f : at;
            rectangles[i][2 + axis] = rectangles[i][axis] + 4;
        }
    memcpy(results, rectangles, sizeof results);
    if (table_make(bench, &c)) {
        look_up(&bench->backend.gl, &c, results);
        double squares = 0, seam = 0;
        for (int i = 0; i < RECTANGLES; i++) {
            const float *r = rectangles[i];
            const double area = ((double)r[2] - (double)r[0]) * ((double)r[3] - (double)r[1]);
            const double error = (double)results[i][0] / area / (floats ? 1 : (double)SCALE) / (double)0.7f - 1;
            squares += error * error;
            seam = fmax(seam, i % 2 ? fabs(error) : 0);
        }
        printf("lit plane, 4096 x 4096, %s in tiles of %4d: standard deviation %.1e, across borders %.1e at most\n",
               floats ? "floats" : "integers", tile, sqrt(squares / RECTANGLES), seam);
        if (allowed > 0)
            CHECK(sqrt(squares / RECTANGLES) <= allowed && seam <= allowed);
    }
    table_free(bench, &c);
}

/* NaN counts as nothing there, as if the depth were 1. In sums of floats it would spread. */
static void nan_does_not_spread(struct bench *bench, bool floats) {
    struct table_case c = {
        .side = 64, .tile = 64, .floats = floats, .depths = random_pixels(64 * 64, 3), .with_nan = true};
    c.depths[1000] = NAN;
    if (table_make(bench, &c)) {
        static float results[RECTANGLES][4];
        for (int i = 0; i < RECTANGLES; i++)
            memcpy(results[i], (float[4]){0, 0, 64, 64}, 16);
        look_up(&bench->backend.gl, &c, results);
        c.depths[1000] = 1;
        const double mean = (double)results[0][0] / 4096 / (floats ? 1.0 : (double)SCALE);
        const double error = mean - mean_over(&c, (float[4]){0, 0, 64, 64});
        printf("a map with a NaN: mean off by %.1e\n", error);
        CHECK_AT_MOST(fabs(error), 1.0 / 1048576);
    }
    table_free(bench, &c);
}

int main(void) {
    quality_open();
    static struct bench bench;
    if (bench_open(&bench)) {
        for (int width = 3; width <= 7; width += 2)
            gauss(&bench, 100, width);
        mip_levels(&bench, 256);
        entries_are_exact(&bench, 512, 64);
        entries_are_exact(&bench, 512, 8);
        entries_are_exact(&bench, 1000, 256);
        entries_are_exact(&bench, 700, 1024);
        /* 2^-20: half a step of an integer, and single precision. */
        static const int sides[] = {512, 777, 1024, 2048, 4096, 8192};
        for (int i = 0; i < 6; i++)
            for (int tile = 32; tile <= 256; tile *= 2)
                if (tile == 64 || i < 3)
                    rectangles_are_exact(&bench, sides[i], tile, false, 1.0 / 1048576);
        for (int i = 0; i < 5; i++)
            rectangles_are_exact(&bench, sides[i], 8192, true, 0);
        plane_is_even(&bench, 64, false, 1e-3);
        plane_is_even(&bench, 4096, true, 0); /* for comparison */
        nan_does_not_spread(&bench, false);
        nan_does_not_spread(&bench, true);
        CHECK_RESULT(gl_check(&bench.backend.gl, "the passes alone"), PNB_OK);
        bench_close(&bench);
    }
    return quality_close();
}
