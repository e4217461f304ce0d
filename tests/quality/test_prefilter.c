/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes that prefilter maps, against sums in double precision made here: Gaussian and mip levels. */
#include "pass_bench.h"

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

int main(void) {
    quality_open();
    static struct bench bench;
    if (bench_open(&bench)) {
        for (int width = 3; width <= 7; width += 2)
            gauss(&bench, 100, width);
        mip_levels(&bench, 256);
        CHECK_RESULT(gl_check(&bench.backend.gl, "the passes alone"), PNB_OK);
        bench_close(&bench);
    }
    return quality_close();
}
