/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

#define PLANE_BLOCK 4 /* texels per side, as in common_planes.glsl */

pnb_result pass_planes(struct frame *frame, struct frame_light *light) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct gl_texture *map = &light->shadow_map;
    struct gl_texture *planes = &light->planes;
    int side = 1, levels = 1;
    for (; side * PLANE_BLOCK < map->width; side *= 2)
        levels++;
    pnb_result result = gl_texture_ensure(gl, planes, GL_RGBA32F, side, side, map->layers, levels);
    if (result != PNB_OK)
        return result;
    const struct program_desc desc = {.compute = "pass_planes.comp",
                                      .defines = {light_defines(&light->emitter, &light->views)}};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK ||
        (result = pass_begin(frame, "Bounding planes")) != PNB_OK)
        return result;
    gl_texture_bind(gl, map, 0);
    gl_texture_bind(gl, planes, 1);
    program_set_int(gl, program, "shadow_map", 0);
    program_set_int(gl, program, "planes", 1);
    for (int level = 0; level < levels; level++) {
        const GLuint groups = (GLuint)((side >> level) + 7) / 8;
        program_set_int(gl, program, "level", level);
        gl->BindImageTexture(0, planes->id, level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        gl->DispatchCompute(groups, groups, (GLuint)map->layers);
        gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    pass_end(frame, gl_texture_bytes(planes));
    return gl_check(gl, "bounding planes");
}
