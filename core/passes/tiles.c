/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "passes.h"

#include <float.h>

#define TILE       16   /* pixels per side, as in common_tile.glsl */
#define UNDECIDED  0.5f /* visibility, as in pass_classify.comp */
#define TILE_BYTES 48   /* of its struct tile */
#define RANGE_BYTES (2 * sizeof(float))
/* Tiles of the coarse boxes, per side of a group. */
#define GROUP 8

/* What a tile cuts out of the view between its nearest and farthest depth. */
static void tile_hull(const struct camera_block *camera, int column, int row, const float depths[2],
                      struct hull *hull) {
    for (int corner = 0; corner < 8; corner++) {
        const float coordinate[2] = {fminf((float)(TILE * (column + (corner & 1))), camera->image[0]),
                                     fminf((float)(TILE * (row + (corner >> 1 & 1))), camera->image[1])};
        camera_position(camera, coordinate, depths[corner >> 2], hull->corners[corner]);
    }
}

static void box_add(struct box *sum, const struct hull *hull) {
    for (int corner = 0; corner < 8; corner++) {
        glm_vec3_minv(sum->minimum, (float *)hull->corners[corner], sum->minimum);
        glm_vec3_maxv(sum->maximum, (float *)hull->corners[corner], sum->maximum);
    }
}

/* Hulls of the tiles with something in them, and boxes of groups of GROUP x GROUP tiles. */
static pnb_result gather(struct frame *frame, const float (*depths)[2], int columns, int rows) {
    const int group_columns = (columns + GROUP - 1) / GROUP, group_rows = (rows + GROUP - 1) / GROUP;
    const size_t group_count = (size_t)group_columns * (size_t)group_rows;
    struct receivers *receivers = &frame->receivers;
    receivers->tiles = memory_array((size_t)columns * (size_t)rows, sizeof *receivers->tiles);
    receivers->groups = memory_array(group_count, sizeof *receivers->groups);
    if (!receivers->tiles || !receivers->groups)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (size_t i = 0; i < group_count; i++) {
        struct box group = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
        const size_t before = receivers->tile_count;
        const int x0 = (int)(i % (size_t)group_columns) * GROUP, y0 = (int)(i / (size_t)group_columns) * GROUP;
        for (int y = y0; y < y0 + GROUP && y < rows; y++)
            for (int x = x0; x < x0 + GROUP && x < columns; x++) {
                struct hull *tile = &receivers->tiles[receivers->tile_count];
                if (!(depths[y * columns + x][1] > 0.0f))
                    continue;
                tile_hull(&frame->camera, x, y, depths[y * columns + x], tile);
                box_add(&group, tile);
                receivers->tile_count++;
            }
        if (receivers->tile_count > before)
            hull_of_box(&group, &receivers->groups[receivers->group_count++]);
    }
    return PNB_OK;
}

static void tile_counts(const struct renderer *renderer, int counts[2]) {
    counts[0] = (renderer->gbuffer_depth.width + TILE - 1) / TILE;
    counts[1] = (renderer->gbuffer_depth.height + TILE - 1) / TILE;
}

static void new_storage(const struct gl *gl, GLuint buffer, GLuint binding, size_t bytes) {
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)bytes, NULL, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

pnb_result pass_tiles(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    static const struct program_desc desc = {.compute = "pass_tiles.comp"};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Tiles")) != PNB_OK)
        return result;
    int counts[2];
    tile_counts(renderer, counts);
    const size_t count = (size_t)counts[0] * (size_t)counts[1];
    new_storage(gl, renderer->range_buffer, 1, count * RANGE_BYTES);
    new_storage(gl, renderer->tile_buffer, 5, count * TILE_BYTES);
    bind_gbuffer(renderer, program);
    gl->Uniform2iv(gl->GetUniformLocation(program, "tile_count"), 1, counts);
    gl->DispatchCompute((GLuint)(counts[0] + 7) / 8, (GLuint)(counts[1] + 7) / 8, 1);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    pass_end(frame, count * (RANGE_BYTES + TILE_BYTES));
    return gl_check(gl, "tiles");
}

pnb_result read_receivers(struct frame *frame) {
    const struct gl *gl = frame->gl;
    int counts[2];
    tile_counts(frame->renderer, counts);
    const size_t count = (size_t)counts[0] * (size_t)counts[1];
    float(*depths)[2] = memory_array(count, sizeof *depths);
    if (!depths)
        return PNB_ERROR_OUT_OF_MEMORY;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, frame->renderer->range_buffer);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(count * sizeof *depths), depths);
    pnb_result result = gl_check(gl, "receiver bounds");
    if (result == PNB_OK)
        result = gather(frame, (const float(*)[2])depths, counts[0], counts[1]);
    memory_free(depths);
    return result;
}

pnb_result pass_classify(struct frame *frame, const struct frame_light *light) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {
        .compute = "pass_classify.comp",
        .technique = light->technique->shader,
        .defines = {light_defines(&light->emitter, &light->views), technique_defines(light)}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Tiles")) != PNB_OK)
        return result;
    int counts[2];
    tile_counts(renderer, counts);
    const int count = counts[0] * counts[1];
    new_storage(gl, renderer->tile_visibility_buffer, 1, (size_t)count * sizeof(float));
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, renderer->tile_buffer);
    bind_technique(frame, light, program);
    gl_texture_bind(gl, &light->planes, 0);
    program_set_int(gl, program, "planes", 0);
    program_set_int(gl, program, "tile_count", count);
    gl->DispatchCompute((GLuint)(count + 63) / 64, 1, 1);
    gl->MemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    pass_end(frame, (size_t)count * sizeof(float));
    return gl_check(gl, "classification");
}

/* Tiles as points of an attribute, their visibility; without classification it is the same for all. */
static void draw_tiles(struct frame *frame, GLuint program, enum tiles tiles, bool undecided_only) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    int counts[2];
    tile_counts(renderer, counts);
    gl->Uniform2iv(gl->GetUniformLocation(program, "tile_count"), 1, counts);
    program_set_int(gl, program, "undecided_only", undecided_only);
    gl->BindVertexArray(renderer->tile_vertex_array);
    if (tiles == TILES_CLASSIFIED) {
        gl->BindBuffer(GL_ARRAY_BUFFER, renderer->tile_visibility_buffer);
        gl->EnableVertexAttribArray(0);
        gl->VertexAttribPointer(0, 1, GL_FLOAT, GL_FALSE, 0, NULL);
    } else {
        gl->DisableVertexAttribArray(0);
        gl->VertexAttrib1f(0, UNDECIDED);
    }
    gl->PointSize((float)TILE);
    gl->Viewport(-(GLint)frame->settings->crop[0], -(GLint)frame->settings->crop[1], counts[0] * TILE,
                 counts[1] * TILE);
    gl->DrawArrays(GL_POINTS, 0, counts[0] * counts[1]);
}

void draw_over(struct frame *frame, GLuint program, enum tiles tiles, bool undecided_only) {
    if (tiles == TILES_NONE)
        draw_screen(frame->renderer);
    else
        draw_tiles(frame, program, tiles, undecided_only);
}
