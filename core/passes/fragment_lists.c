/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fragment lists in arrays (Selgrad et al. 2015, section 7): count, scan, collect, sort. The number of fragments is
 * read back after the scan, so that storage always suffices and no fragment is ever left out. */
#include "passes.h"

const char *fragment_defines(const struct scene *scene) {
    return scene->colored ? "#define COLORED\n" : NULL;
}

uint64_t fragment_size(const struct scene *scene) {
    return scene->colored ? 12 : 8;
}

void fragment_lists_bind(const struct gl *gl, const struct fragment_lists *lists) {
    gl_buffer_bind(gl, &lists->heads, 2);
    gl_buffer_bind(gl, &lists->fragments, 3);
}

void fragment_lists_free(const struct gl *gl, struct fragment_lists *lists) {
    gl_buffer_free(gl, &lists->heads);
    gl_buffer_free(gl, &lists->fragments);
    lists->count = 0;
}

static pnb_result use_programs(struct frame *frame, const struct light_views *views, bool collect,
                               enum casters casters, int layer, int side, const mat4 clip, GLuint programs[2]) {
    const struct light_view *view = &views->views[layer];
    static const char *const defines[2][2] = {{NULL, "#define SPECIAL\n"},
                                              {"#define COLLECT\n", "#define COLLECT\n#define SPECIAL\n"}};
    const struct gl *gl = frame->gl;
    for (int special = 0; special < 2; special++) {
        const struct program_desc desc = {.vertex = "pass_shadow_map.vert",
                                          .fragment = "pass_fragments.frag",
                                          .defines = {fragment_defines(frame->scene), defines[collect][special],
                                                      view->perspective != 0.0f ? "#define PERSPECTIVE\n" : NULL,
                                                      views->clip_behind ? "#define CLIP_BEHIND\n" : NULL}};
        pnb_result result = program_use(&frame->renderer->programs, &desc, &programs[special]);
        if (result != PNB_OK)
            return result;
        program_set_mat4(gl, programs[special], "projection", (const float *)clip);
        program_set_vec2(gl, programs[special], "depth_planes", (const float[2]){view->near_depth, view->far_depth});
        program_set_vec4(gl, programs[special], "front", views->front);
        program_set_int(gl, programs[special], "layer", layer);
        program_set_int(gl, programs[special], "side", side);
        program_set_int(gl, programs[special], "translucent_only", casters == CASTERS_TRANSLUCENT);
    }
    return PNB_OK;
}

/* Counts or collects the fragments of one view. */
static pnb_result draw_view(struct frame *frame, const struct light_views *views, bool collect, enum casters casters,
                            bool back_faces, const struct gl_texture *map, int layer) {
    struct renderer *renderer = frame->renderer;
    const struct gl_target target = {.depth = map, .layer = layer};
    pnb_result result = gl_target_bind(frame->gl, renderer->framebuffer, &target);
    if (result != PNB_OK)
        return result;
    mat4 projection, clip;
    light_view_projection(&views->views[layer], projection);
    glm_mat4_mul(projection, (vec4 *)views->views[layer].from_world, clip);
    GLuint programs[2];
    if ((result = use_programs(frame, views, collect, casters, layer, map->width, clip, programs)) != PNB_OK)
        return result;
    const struct draw_programs draw = {programs[0], programs[1], casters, PNB_MATERIAL_CULL_SHADOW, back_faces};
    return gpu_scene_draw(renderer->scene, clip, PNB_INSTANCE_NO_SHADOW, (uint64_t)1 << frame->light, &draw);
}

static pnb_result draw_views(struct frame *frame, const struct light_views *views, bool collect, enum casters casters,
                             bool back_faces, const struct gl_texture *map, const struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    pnb_result result = timer_begin(&frame->renderer->timer, collect ? "Fragment collect" : "Fragment count");
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    fragment_lists_bind(gl, lists);
    if (views->clip_behind)
        gl->Enable(GL_CLIP_DISTANCE0);
    for (int i = 0; i < views->count && result == PNB_OK; i++)
        result = draw_view(frame, views, collect, casters, back_faces, map, i);
    gl->Disable(GL_CLIP_DISTANCE0);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    timer_end(&frame->renderer->timer, collect ? lists->fragments.bytes : lists->heads.bytes);
    return result;
}

/* Groups in one row of a dispatch: OpenGL guarantees 65535. */
#define MOST_GROUPS 16384u

/* A pass over every list. */
static pnb_result dispatch(struct frame *frame, const char *name, const char *shader, uint32_t heads,
                           uint32_t per_group, uint32_t most, const struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const struct program_desc desc = {.compute = shader, .defines = {fragment_defines(frame->scene)}};
    GLuint program;
    pnb_result result = program_use(&frame->renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = timer_begin(&frame->renderer->timer, name)) != PNB_OK)
        return result;
    fragment_lists_bind(gl, lists);
    gl->Uniform1ui(gl->GetUniformLocation(program, "head_count"), heads);
    gl->Uniform1ui(gl->GetUniformLocation(program, "most"), most);
    const uint32_t groups = (heads + per_group - 1) / per_group;
    gl->DispatchCompute(groups < MOST_GROUPS ? groups : MOST_GROUPS, (groups + MOST_GROUPS - 1) / MOST_GROUPS, 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    timer_end(&frame->renderer->timer, 0);
    return gl_check(gl, name);
}

static pnb_result scan(struct frame *frame, uint32_t heads, struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const uint32_t zero = 0;
    const GLuint cursor = frame->renderer->cursor_buffer;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, cursor);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, &zero, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, cursor);
    pnb_result result = dispatch(frame, "Fragment scan", "pass_fragments_scan.comp", heads, 256 * 16, 0, lists);
    if (result != PNB_OK)
        return result;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, cursor);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof lists->count, &lists->count);
    return PNB_OK;
}

pnb_result pass_fragment_lists(struct frame *frame, const struct light_views *views, enum casters casters,
                               bool back_faces, uint32_t most, const struct gl_texture *map, const char *what,
                               struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const uint64_t heads = (uint64_t)map->width * (uint64_t)map->width * (uint64_t)views->count;
    pnb_result result = gl_buffer_ensure(gl, &lists->heads, heads * 8, 0, what);
    if (result == PNB_OK && !lists->fragments.id) /* a block must not be without a buffer while counting */
        result = gl_buffer_ensure(gl, &lists->fragments, 4096, 0, what);
    if (result != PNB_OK)
        return result;
    gl_buffer_clear(gl, &lists->heads, heads * 8);
    if (back_faces)
        gpu_scene_find_solids(frame->renderer->scene, frame->scene);
    if ((result = draw_views(frame, views, false, casters, back_faces, map, lists)) != PNB_OK ||
        (result = scan(frame, (uint32_t)heads, lists)) != PNB_OK ||
        (result = gl_buffer_ensure(gl, &lists->fragments, lists->count * fragment_size(frame->scene), 0, what)) !=
            PNB_OK ||
        (result = draw_views(frame, views, true, casters, back_faces, map, lists)) != PNB_OK)
        return result;
    return dispatch(frame, "Fragment sort", "pass_fragments_sort.comp", (uint32_t)heads, 64, most, lists);
}
