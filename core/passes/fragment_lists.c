/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fragment lists in arrays (Selgrad et al. 2015, section 7): count, scan, collect, sort. The number of fragments is
 * read back after the scan, so that storage always suffices and no fragment is ever left out. */
#include "passes.h"

const char *fragment_defines(const struct frame *frame, const struct fragment_lists *lists) {
    static const char *const defines[2][2] = {{NULL, "#define SPLIT_FRAGMENTS\n"},
                                              {"#define COLORED\n", "#define COLORED\n#define SPLIT_FRAGMENTS\n"}};
    return defines[frame->scene->colored][gl_buffer_is_split(frame->gl, &lists->fragments)];
}

uint64_t fragment_size(const struct scene *scene) {
    return scene->colored ? 12 : 8;
}

void fragment_lists_bind(struct frame *frame, GLuint program, const struct fragment_lists *lists) {
    static const GLuint blocks[GL_BUFFER_BLOCKS] = {3, 6, 7, 0};
    const struct gl *gl = frame->gl;
    frame->binds_lists = true;
    gl_buffer_bind(gl, &lists->heads, 2);
    program_set_int(gl, program, "fragment_block_shift", gl_buffer_bind_split(gl, &lists->fragments, blocks));
}

void fragment_lists_free(const struct gl *gl, struct fragment_lists *lists) {
    gl_buffer_free(gl, &lists->heads);
    gl_buffer_free(gl, &lists->fragments);
    lists->count = 0;
}

static pnb_result use_programs(struct frame *frame, const struct light_views *views, bool collect, enum casters casters,
                               int layer, int side, const mat4 clip, const struct fragment_lists *lists,
                               GLuint programs[2]) {
    const struct light_view *view = &views->views[layer];
    static const char *const defines[2][2] = {{NULL, "#define SPECIAL\n"},
                                              {"#define COLLECT\n", "#define COLLECT\n#define SPECIAL\n"}};
    const struct gl *gl = frame->gl;
    for (int special = 0; special < 2; special++) {
        const struct program_desc desc = {.vertex = "pass_shadow_map.vert",
                                          .fragment = "pass_fragments.frag",
                                          .defines = {fragment_defines(frame, lists), defines[collect][special],
                                                      view->perspective != 0.0f ? "#define PERSPECTIVE\n" : NULL,
                                                      views->clip_behind ? "#define CLIP_BEHIND\n" : NULL}};
        pnb_result result = program_use(&frame->renderer->programs, &desc, &programs[special]);
        if (result != PNB_OK)
            return result;
        fragment_lists_bind(frame, programs[special], lists);
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
static pnb_result draw_view(struct frame *frame, const struct light_views *views, bool collect,
                            const struct fragment_choice *choice, const struct gl_texture *map, int layer,
                            const struct fragment_lists *lists) {
    struct renderer *renderer = frame->renderer;
    const struct gl_target target = {.depth = map, .layer = layer};
    pnb_result result = gl_target_bind(frame->gl, renderer->framebuffer, &target);
    if (result != PNB_OK)
        return result;
    mat4 projection, clip;
    light_view_projection(&views->views[layer], projection);
    glm_mat4_mul(projection, (vec4 *)views->views[layer].from_world, clip);
    GLuint programs[2];
    result = use_programs(frame, views, collect, choice->casters, layer, map->width, clip, lists, programs);
    if (result != PNB_OK)
        return result;
    const struct draw_programs draw = {programs[0], programs[1], choice->casters, PNB_MATERIAL_CULL_SHADOW,
                                       choice->back_faces};
    return gpu_scene_draw(renderer->scene, clip, PNB_INSTANCE_NO_SHADOW, (uint64_t)1 << frame->light, &draw);
}

static pnb_result draw_views(struct frame *frame, const struct light_views *views, bool collect,
                             const struct fragment_choice *choice, const struct gl_texture *map,
                             const struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    pnb_result result = pass_begin(frame, collect ? "Fragment collect" : "Fragment count");
    if (result != PNB_OK)
        return result;
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    if (views->clip_behind)
        gl->Enable(GL_CLIP_DISTANCE0);
    for (int i = 0; i < views->count && result == PNB_OK; i++)
        result = draw_view(frame, views, collect, choice, map, i, lists);
    gl->Disable(GL_CLIP_DISTANCE0);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    pass_end(frame, collect ? lists->fragments.bytes : lists->heads.bytes);
    return result;
}

/* Groups in one row of a dispatch: OpenGL guarantees 65535. */
#define MOST_GROUPS 16384u

/* A pass over every list, whose program is current. */
static pnb_result dispatch(struct frame *frame, const char *name, GLuint program, uint32_t heads, uint32_t per_group,
                           const struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    pnb_result result = pass_begin(frame, name);
    if (result != PNB_OK)
        return result;
    fragment_lists_bind(frame, program, lists);
    gl->Uniform1ui(gl->GetUniformLocation(program, "head_count"), heads);
    const uint32_t groups = (heads + per_group - 1) / per_group;
    gl->DispatchCompute(groups < MOST_GROUPS ? groups : MOST_GROUPS, (groups + MOST_GROUPS - 1) / MOST_GROUPS, 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    pass_end(frame, 0);
    return gl_check(gl, name);
}

static pnb_result scan(struct frame *frame, uint32_t heads, struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const uint32_t zero = 0;
    const GLuint cursor = frame->renderer->cursor_buffer;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, cursor);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, &zero, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, cursor);
    const struct program_desc desc = {.compute = "pass_fragments_scan.comp",
                                      .defines = {fragment_defines(frame, lists)}};
    GLuint program;
    pnb_result result = program_use(&frame->renderer->programs, &desc, &program);
    if (result == PNB_OK)
        result = dispatch(frame, "Fragment scan", program, heads, 256 * 16, lists);
    if (result != PNB_OK)
        return result;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, cursor);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof lists->count, &lists->count);
    return PNB_OK;
}

const char *accumulation_define(int accumulation) {
    static const char *const defines[] = {"#define ACCUMULATION 0\n", "#define ACCUMULATION 1\n",
                                          "#define ACCUMULATION 2\n"};
    return defines[accumulation];
}

static pnb_result sort(struct frame *frame, const struct light_views *views, const struct fragment_choice *choice,
                       uint32_t heads, const struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const bool joins = choice->joined > 0.0f;
    const struct program_desc desc = {.compute = "pass_fragments_sort.comp",
                                      .defines = {fragment_defines(frame, lists), joins ? "#define JOIN\n" : NULL,
                                                  joins ? accumulation_define(choice->accumulation) : NULL}};
    GLuint program;
    pnb_result result = program_use(&frame->renderer->programs, &desc, &program);
    if (result != PNB_OK)
        return result;
    float distances[MAX_LIGHT_VIEWS] = {0};
    for (int i = 0; i < views->count; i++)
        distances[i] = choice->joined * views->views[i].texel;
    gl->Uniform1fv(gl->GetUniformLocation(program, "distances"), MAX_LIGHT_VIEWS, distances);
    gl->Uniform1ui(gl->GetUniformLocation(program, "texels"), heads / (uint32_t)views->count);
    gl->Uniform1ui(gl->GetUniformLocation(program, "most"), choice->most);
    program_set_int(gl, program, "perspective", views->views[0].perspective != 0.0f);
    return dispatch(frame, "Fragment sort", program, heads, 64, lists);
}

pnb_result pass_fragment_lists(struct frame *frame, const struct light_views *views,
                               const struct fragment_choice *choice, const struct gl_texture *map, const char *what,
                               struct fragment_lists *lists) {
    const struct gl *gl = frame->gl;
    const uint64_t heads = (uint64_t)map->width * (uint64_t)map->width * (uint64_t)views->count;
    pnb_result result = gl_buffer_ensure(gl, &lists->heads, heads * 8, 0, what);
    if (result == PNB_OK && !lists->fragments.id) /* a block must not be without a buffer while counting */
        result = gl_buffer_ensure(gl, &lists->fragments, 4096, 0, what);
    if (result != PNB_OK)
        return result;
    gl_buffer_clear(gl, &lists->heads, heads * 8);
    if (choice->back_faces)
        gpu_scene_find_solids(frame->renderer->scene, frame->scene);
    if ((result = draw_views(frame, views, false, choice, map, lists)) != PNB_OK ||
        (result = scan(frame, (uint32_t)heads, lists)) != PNB_OK ||
        (result = gl_buffer_ensure_split(gl, &lists->fragments, lists->count * fragment_size(frame->scene), 0, what)) !=
            PNB_OK ||
        (result = draw_views(frame, views, true, choice, map, lists)) != PNB_OK)
        return result;
    return sort(frame, views, choice, (uint32_t)heads, lists);
}

/* ---- Lists that are freed ---- */

#define PLACES        8 /* of storage blocks in a shader stage: OpenGL has so many at least */
#define PLACES_DEFINE "#define PLACES 8\n"

/* The cursor, one number, at every place. */
static void bind_in_place_of_lists(struct frame *frame) {
    const struct gl *gl = frame->gl;
    const GLuint cursor = frame->renderer->cursor_buffer;
    const uint32_t zero = 0;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, cursor);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, &zero, GL_STREAM_READ);
    for (GLuint i = 0; i < PLACES; i++)
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, i, cursor);
}

/* Fragment shaders and compute shaders have places of their own. */
static pnb_result take_places(struct frame *frame, const struct gl_texture *pixel) {
    static const struct program_desc draw = {.vertex = "pass_screen.vert",
                                             .fragment = "pass_fragments_forget.frag",
                                             .defines = {PLACES_DEFINE}};
    static const struct program_desc compute = {.compute = "pass_fragments_forget.comp", .defines = {PLACES_DEFINE}};
    const struct gl *gl = frame->gl;
    const struct gl_target target = {.colors = {pixel}, .color_count = 1};
    GLuint program;
    pnb_result result = gl_target_bind(gl, frame->renderer->framebuffer, &target);
    if (result != PNB_OK || (result = program_use(&frame->renderer->programs, &draw, &program)) != PNB_OK)
        return result;
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    draw_screen(frame->renderer);
    if ((result = program_use(&frame->renderer->programs, &compute, &program)) != PNB_OK)
        return result;
    gl->DispatchCompute(1, 1, 1);
    return gl_check(gl, "fragment lists");
}

/* A driver holds the memory of deleted buffers until the same stage has others in their places: with Mesa, lists of
 * 319 MiB stayed for ever, since no other shader has so many. */
pnb_result fragment_lists_forget(struct frame *frame) {
    struct gl_texture pixel = {0};
    pnb_result result = gl_texture_ensure(frame->gl, &pixel, GL_R32F, 1, 1, 0, 1);
    if (result == PNB_OK) {
        bind_in_place_of_lists(frame);
        result = take_places(frame, &pixel);
    }
    gl_texture_free(frame->gl, &pixel);
    return result;
}
