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

GLenum summed_area_format(int channels) {
    return channels == 2 ? GL_RG32UI : GL_R32UI;
}

pnb_result pass_summed_area(struct frame *frame, const struct summed_area *sums, const struct gl_texture *table,
                            int level) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const int side = table->width >> level;
    const GLuint blocks = (GLuint)(side + BLOCK - 1) / BLOCK;
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
        program_set_int(gl, program, "side", side);
        program_set_int(gl, program, "tile", sums->tile);
        program_set_float(gl, program, "scale", sums->scale);
        if (step == 0)
            sums->bind(frame, program, sums->user);
        gl->BindImageTexture(0, table->id, level, GL_TRUE, 0, GL_READ_WRITE, table->format);
        gl->DispatchCompute(blocks, step == 0 ? blocks : 1, (GLuint)table->layers);
        gl->MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    pass_end(frame, gl_texture_bytes(table));
    return result == PNB_OK ? gl_check(gl, "summed-area table") : result;
}
