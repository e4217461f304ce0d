/* SPDX-License-Identifier: GPL-3.0-or-later
 * Levels of filtered fragment lists (Selgrad et al. 2015, section 4.2). A MIP map halves the side from level to level;
 * a Y-map stops at some side and goes on with a stack of levels of that side, whose filters grow alike. */
#include "passes.h"

#include <math.h>
#include <string.h>

/* The level after `below`; false if there is none that differs from it. */
static bool next_level(const struct fragment_level *below, const struct fragment_filter *filter, int layers,
                       struct fragment_level *level) {
    const bool stack = below->stack > 0 || below->side <= filter->stack_side;
    *level = *below;
    level->first_head = below->first_head + (uint32_t)(below->side * below->side * layers);
    if (stack) {
        /* Texels of the first one lie on the corners of those below; from then on they stay where they are. The border
         * is as wide as filters reach, since receivers beside the map are shadowed, too. */
        level->stack = below->stack + 1;
        level->border = (1 << below->stack) - 1;
        level->side = below->side + (below->stack == 0 ? 1 : 2 * (level->border - below->border));
        const float width = (float)(1 << level->log2_texel);
        level->filter_width = width * sqrtf(powf(4.0f, (float)level->stack) + 2.0f);
        return 1 << below->stack < filter->stack_side;
    }
    level->side = (below->side + 1) / 2;
    level->log2_texel = below->log2_texel + 1;
    level->filter_width = sqrtf(3.0f) * (float)(1 << level->log2_texel);
    return below->side > 1;
}

uint32_t fragment_levels(struct fragment_level levels[MAX_FRAGMENT_LEVELS], const struct fragment_filter *filter,
                         int side, int layers) {
    uint32_t count = 1;
    levels[0] = (struct fragment_level){.side = side, .filter_width = sqrtf(3.0f)};
    while ((int)count < filter->level_count && next_level(&levels[count - 1], filter, layers, &levels[count]))
        count++;
    return count;
}

/* A level serves receivers that lie about width / light_size x depth behind a blocker. Merging must not reach that far:
 * a receiver's own surface would hide it. This share of it keeps the width of penumbrae, too. */
#define MOST_MERGED 0.4f
/* But lists would have no end where an emitter is much larger than its distance: this share of a texel always merges.
 */
#define LEAST_MERGED 0.25f

static void set_uniforms(const struct gl *gl, GLuint program, const struct fragment_level *below,
                         const struct fragment_level *level, const struct fragment_filter *filter,
                         const struct light_views *views) {
    const int distance = level->stack > 1 ? 1 << (level->stack - 2) : 0, moved = below->border - level->border;
    const int pair[2] = {level->stack == 1 ? -1 : moved - distance, level->stack == 0 ? 1 : moved + distance};
    float texels[MAX_LIGHT_VIEWS]; /* at depth 1 */
    for (int i = 0; i < views->count; i++)
        texels[i] = views->views[i].texel * (float)(1 << (level->log2_texel + level->stack));
    const float distance_share = MOST_MERGED / fmaxf(filter->light_size, 1e-6f);
    gl->Uniform1ui(gl->GetUniformLocation(program, "source_first"), below->first_head);
    gl->Uniform1ui(gl->GetUniformLocation(program, "target_first"), level->first_head);
    program_set_int(gl, program, "source_side", below->side);
    program_set_int(gl, program, "target_side", level->side);
    gl->Uniform2iv(gl->GetUniformLocation(program, "pair"), 1, pair);
    program_set_int(gl, program, "scale", level->stack > 0 ? 1 : 2);
    gl->Uniform1fv(gl->GetUniformLocation(program, "texels"), views->count, texels);
    program_set_float(gl, program, "tolerance", filter->merge_distance);
    program_set_float(gl, program, "most_tolerance", distance_share);
    program_set_float(gl, program, "least_tolerance", LEAST_MERGED);
    program_set_int(gl, program, "perspective", views->views[0].perspective != 0.0f);
    program_set_int(gl, program, "by_reference", level->log2_texel <= filter->subsampled_levels && level->stack == 0);
}

enum phase { STORE, COUNT, FILL };

/* cursor[0]: end of the room taken, [1]: fragments of the level. */
static pnb_result merge_level(struct frame *frame, const struct fragment_level *level, const struct light_views *views,
                              const struct fragment_filter *filter, enum phase phase, struct fragment_lists *lists,
                              uint32_t cursor[2]) {
    const struct gl *gl = frame->gl;
    const struct program_desc desc = {
        .compute = "pass_fragments_merge.comp",
        .defines = {fragment_defines(frame, lists), accumulation_define(filter->accumulation)}};
    GLuint program;
    pnb_result result = program_use(&frame->renderer->programs, &desc, &program);
    if (result != PNB_OK)
        return result;
    fragment_lists_bind(frame, program, lists);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, frame->renderer->cursor_buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, 2 * sizeof *cursor, cursor, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, frame->renderer->cursor_buffer);
    set_uniforms(gl, program, level - 1, level, filter, views);
    program_set_int(gl, program, "phase", (int)phase);
    const GLuint groups = (GLuint)(level->side + 7) / 8;
    gl->DispatchCompute(groups, groups, (GLuint)views->count);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, frame->renderer->cursor_buffer);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, 2 * sizeof *cursor, cursor);
    return gl_check(gl, "fragment filter");
}

static pnb_result add_level(struct frame *frame, const struct fragment_level *level, const struct light_views *views,
                            const struct fragment_filter *filter, const char *what, struct fragment_lists *lists,
                            uint32_t cursor[2]) {
    const struct gl *gl = frame->gl;
    const uint64_t size = fragment_size(frame->scene), used = size * cursor[0];
    /* Each fragment below goes to one list of a MIP map, to four of a stack. */
    const uint64_t most = used + size * (level->stack > 0 ? 4 : 1) * (uint64_t)cursor[1];
    const uint32_t below = cursor[1];
    cursor[1] = 0;
    pnb_result result;
    if (most <= (uint64_t)gl->max_buffer_size) {
        result = gl_buffer_ensure(gl, &lists->fragments, most, used, what);
        if (result == PNB_OK)
            result = merge_level(frame, level, views, filter, STORE, lists, cursor);
    } else {
        result = merge_level(frame, level, views, filter, COUNT, lists, cursor);
        if (result == PNB_OK)
            result = gl_buffer_ensure_split(gl, &lists->fragments, used + size * cursor[1], used, what);
        if (result == PNB_OK)
            result = merge_level(frame, level, views, filter, FILL, lists, cursor);
    }
    if (cursor[1] == 0) /* by reference */
        cursor[1] = below;
    return result;
}

pnb_result pass_fragment_filter(struct frame *frame, const struct light_views *views,
                                const struct fragment_filter *filter, int side, const char *what,
                                struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    lists->level_count = fragment_levels(lists->levels, filter, side, views->count);
    const struct fragment_level *top = &lists->levels[lists->level_count - 1];
    const uint64_t base_heads = (uint64_t)side * (uint64_t)side * (uint64_t)views->count;
    const uint64_t heads = top->first_head + (uint64_t)(top->side * top->side * views->count);
    pnb_result result = gl_buffer_ensure(gl, &lists->heads, 8 * heads, 8 * base_heads, what);
    if (result == PNB_OK)
        result = pass_begin(frame, "Fragment filter");
    if (result != PNB_OK)
        return result;
    uint32_t cursor[2] = {lists->count, lists->count};
    for (uint32_t i = 1; i < lists->level_count && result == PNB_OK; i++)
        result = add_level(frame, &lists->levels[i], views, filter, what, lists, cursor);
    pass_end(frame, lists->heads.bytes + lists->fragments.bytes);
    lists->count = cursor[0];
    return result;
}
