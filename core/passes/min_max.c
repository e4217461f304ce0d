/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

pnb_result pass_min_max(struct frame *frame, const struct gl_texture *map, struct gl_texture *pyramid) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    /* Texture levels halve by floor; a side rounded up to a power of two makes that exact. */
    int side = 1, levels = 1;
    for (; 2 * side < map->width; side *= 2)
        levels++;
    pnb_result result = gl_texture_ensure(gl, pyramid, GL_RG32F, side, side, map->layers, levels);
    if (result != PNB_OK)
        return result;
    static const struct program_desc desc = {.compute = "pass_min_max.comp"};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK)
        return result;
    if ((result = pass_begin(frame, "Min-max pyramid")) != PNB_OK)
        return result;
    program_set_int(gl, program, "source", 0);
    for (int level = 0; level < levels; level++) {
        const struct gl_texture *source = level == 0 ? map : pyramid;
        const GLuint groups = (GLuint)((side >> level) + 7) / 8;
        gl_texture_bind(gl, source, 0);
        program_set_int(gl, program, "source_level", level == 0 ? 0 : level - 1);
        program_set_int(gl, program, "source_is_map", level == 0);
        gl->BindImageTexture(0, pyramid->id, level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RG32F);
        gl->DispatchCompute(groups, groups, (GLuint)map->layers);
        gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    pass_end(frame, gl_texture_bytes(pyramid));
    return gl_check(gl, "min-max pyramid");
}
