/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times of summed-area tables as one tile and as tiles of 64 texels, by the
 * same pass, and bytes of prefiltered maps.
 */
#include "pass_bench.h"

#include <time.h>

#define RUNS_OF_4096 5

struct source {
  struct gl_texture map, min_max;
};

static void bind_depths(struct frame *frame, GLuint program, const void *user) {
  const struct source *source = user;
  gl_texture_bind(frame->gl, &source->map, 0);
  gl_texture_bind(frame->gl, &source->min_max, 1);
  program_set_int(frame->gl, program, "shadow_map", 0);
  program_set_int(frame->gl, program, "min_max", 1);
  program_set_int(frame->gl, program, "p_mode", 1);
  program_set_int(frame->gl, program, "p_depth_range", 1);
  program_set_float(frame->gl, program, "p_c", 80);
  program_set_int(frame->gl, program, "level", 0);
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Makes both of ESSM's tables; milliseconds. */
static double make_tables(struct bench *bench, const struct source *source,
                          struct gl_texture tables[2], int tile) {
  const struct gl *gl = &bench->backend.gl;
  gl->Finish();
  const double start = seconds();
  for (int i = 0; i < 2; i++) {
    const struct summed_area sums = {.channels = i + 1,
                                     .tile = tile,
                                     .scale = 1048575,
                                     .values = "essm_values.glsl",
                                     .bind = bind_depths,
                                     .user = source};
    CHECK_RESULT(pass_summed_area(&bench->frame, &sums, &tables[i], 0), PNB_OK);
  }
  gl->Finish();
  return 1e3 * (seconds() - start);
}

/* Least milliseconds of many runs, which take turns. */
static void compare_tables(struct bench *bench, int side) {
  const struct gl *gl = &bench->backend.gl;
  struct source source = {0};
  struct gl_texture tables[2] = {0};
  CHECK_RESULT(gl_texture_ensure(gl, &source.map, GL_DEPTH_COMPONENT32F, side,
                                 side, 1, 1),
               PNB_OK);
  CHECK_RESULT(gl_texture_ensure(gl, &source.min_max, GL_RG32F, 1, 1, 1, 1),
               PNB_OK);
  for (int i = 0; i < 2; i++)
    CHECK_RESULT(summed_area_ensure(gl, &tables[i], i + 1, side, 1, 1), PNB_OK);
  double whole = 1e9, tiles = 1e9;
  const int runs = RUNS_OF_4096 * 4096 / side;
  for (int run = 0; run <= runs; run++) {
    const double a = make_tables(bench, &source, tables, side),
                 b = make_tables(bench, &source, tables, 64);
    if (run > 0) /* the first compiles */
      whole = fmin(whole, a), tiles = fmin(tiles, b);
  }
  printf("%4d x %4d: one table %7.1f ms, tiles of 64 %7.1f ms, ratio %.2f\n",
         side, side, whole, tiles, whole / tiles);
  fflush(stdout);
  for (int i = 0; i < 2; i++)
    gl_texture_free(gl, &tables[i]);
  gl_texture_free(gl, &source.map);
  gl_texture_free(gl, &source.min_max);
}

/* Per map of 1024 x 1024 with levels: 32-bit floats, and for CSM one byte for
 * each sine and cosine. */
static void print_bytes(void) {
  const double texels = 1024.0 * 1024 * 4 / 3, mib = 1 << 20;
  printf("MiB per map of 1024^2 with levels: ESM %.1f, VSM %.1f, CSM of 16 "
         "terms %.1f; ratios to ESM %.0f, %.0f\n",
         4 * texels / mib, 8 * texels / mib, 32 * texels / mib, 2.0, 8.0);
  printf("ESSM: tables of 1 and 2 channels %.1f MiB, with the levels of ROBUST "
         "%.1f\n",
         12 * texels * 3 / 4 / mib, 12 * texels * 9 / 8 / mib);
}

int main(void) {
  static struct bench bench;
  if (!bench_open(&bench))
    return CHECK_SKIPPED;
  for (int side = 512; side <= 4096; side *= 2)
    compare_tables(&bench, side);
  print_bytes();
  bench_close(&bench);
  return check_report();
}
