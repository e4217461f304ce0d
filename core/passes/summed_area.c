/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

#define BLOCK 64

static pnb_result use_step(struct frame *frame, const struct summed_area *sums, int step, GLuint *program) {
    static const char *const defines[3][2] = {
        {"#define STEP 0\n#define CHANNELS 1\n", "#define STEP 0\n#define CHANNELS 2\n"},
        {"#define STEP 1\n#define CHANNELS 1\n", "#define STEP 1\n#define CHANNELS 2\n"},
        {"#define STEP 2\n#define CHANNELS 1\n", "#define STEP 2\n#define CHANNELS 2\n"}};
    const struct program_desc desc = {
        .compute = "pass_summed_area.comp",
        .technique = sums->values,
        .defines = {defines[step][sums->channels - 1], sums->floats ? "#define FLOATS\n" : NULL}};
    return program_use(&frame->renderer->programs, &desc, program);
}

/* 32-bit integers, or the bits of floats. */
pnb_result summed_area_ensure(const struct gl *gl, struct gl_texture *table, int channels, int side, int layers,
                              int levels) {
    return gl_texture_ensure(gl, table, channels == 2 ? GL_RG32UI : GL_R32UI, side, levels > 1 ? side + side / 2 : side,
                             layers, 1);
}

static void set_level(const struct gl *gl, GLuint program, int side, int level) {
    const GLint origin[2] = {level > 0 ? side - (side >> (level - 1)) : 0, level > 0 ? side : 0};
    program_set_int(gl, program, "side", side >> level);
    gl->Uniform2iv(gl->GetUniformLocation(program, "origin"), 1, origin);
}

pnb_result pass_summed_area(struct frame *frame, const struct summed_area *sums, const struct gl_texture *table,
                            int level) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const GLuint blocks = (GLuint)((table->width >> level) + BLOCK - 1) / BLOCK;
    pnb_result result = pass_begin(frame, "Summed-area table");
    if (result != PNB_OK)
        return result;
    /* A tile that lies in one block needs no sums of blocks. */
    const int steps = sums->tile > BLOCK ? 3 : 1;
    for (int step = 0; step < steps && result == PNB_OK; step++) {
        GLuint program;
        result = use_step(frame, sums, step, &program);
        if (result != PNB_OK)
            break;
        set_level(gl, program, table->width, level);
        program_set_int(gl, program, "tile", sums->tile);
        program_set_float(gl, program, "scale", sums->scale);
        if (step == 0)
            sums->bind(frame, program, sums->user);
        gl->BindImageTexture(0, table->id, 0, GL_TRUE, 0, GL_READ_WRITE, table->format);
        gl->DispatchCompute(blocks, step == 0 ? blocks : 1, (GLuint)table->layers);
        gl->MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    pass_end(frame, gl_texture_bytes(table));
    return result == PNB_OK ? gl_check(gl, "summed-area table") : result;
}
