/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "passes.h"

#define TILE 16
/* Tiles of the coarse boxes, per side of a group. */
#define GROUP 8

static bool is_empty(const struct box *box) {
    return !(box->minimum[0] <= box->maximum[0]);
}

static void box_add(struct box *sum, const struct box *box) {
    if (is_empty(sum)) {
        *sum = *box;
        return;
    }
    glm_vec3_minv(sum->minimum, (float *)box->minimum, sum->minimum);
    glm_vec3_maxv(sum->maximum, (float *)box->maximum, sum->maximum);
}

/* Splits the tiles into groups of GROUP x GROUP and keeps those with something in them. */
static pnb_result gather(struct frame *frame, const struct box *tiles, int columns, int rows) {
    const int group_columns = (columns + GROUP - 1) / GROUP, group_rows = (rows + GROUP - 1) / GROUP;
    const size_t group_count = (size_t)group_columns * (size_t)group_rows;
    frame->receivers = memory_array((size_t)columns * (size_t)rows, sizeof *frame->receivers);
    frame->coarse_receivers = memory_array(group_count, sizeof *frame->coarse_receivers);
    if (!frame->receivers || !frame->coarse_receivers)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (size_t i = 0; i < group_count; i++) {
        struct box group = {{1, 0, 0}, {-1, 0, 0}};
        const int x0 = (int)(i % (size_t)group_columns) * GROUP, y0 = (int)(i / (size_t)group_columns) * GROUP;
        for (int y = y0; y < y0 + GROUP && y < rows; y++)
            for (int x = x0; x < x0 + GROUP && x < columns; x++) {
                const struct box *tile = &tiles[y * columns + x];
                if (is_empty(tile))
                    continue;
                frame->receivers[frame->receiver_count++] = *tile;
                box_add(&group, tile);
            }
        if (!is_empty(&group))
            frame->coarse_receivers[frame->coarse_receiver_count++] = group;
    }
    return PNB_OK;
}

pnb_result pass_bounds(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const int columns = (renderer->gbuffer_depth.width + TILE - 1) / TILE;
    const int rows = (renderer->gbuffer_depth.height + TILE - 1) / TILE;
    const size_t count = (size_t)columns * (size_t)rows;
    struct box *tiles = memory_array(count, sizeof *tiles);
    if (!tiles)
        return PNB_ERROR_OUT_OF_MEMORY;
    static const struct program_desc desc = {.compute = "pass_bounds.comp"};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result == PNB_OK)
        result = timer_begin(&renderer->timer, "Receiver bounds");
    if (result == PNB_OK) {
        gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, renderer->box_buffer);
        gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)(count * sizeof *tiles), NULL, GL_STREAM_READ);
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, renderer->box_buffer);
        gl_texture_bind(gl, &renderer->gbuffer_depth, 0);
        program_set_int(gl, program, "gbuffer_depth", 0);
        gl->Uniform2iv(gl->GetUniformLocation(program, "tile_count"), 1, (const int[2]){columns, rows});
        gl->DispatchCompute((GLuint)(columns + 7) / 8, (GLuint)(rows + 7) / 8, 1);
        gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(count * sizeof *tiles), tiles);
        timer_end(&renderer->timer, count * sizeof *tiles);
        result = gl_check(gl, "receiver bounds");
    }
    if (result == PNB_OK)
        result = gather(frame, tiles, columns, rows);
    memory_free(tiles);
    return result;
}
