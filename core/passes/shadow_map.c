/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

static pnb_result draw_view(struct frame *frame, const struct light_views *views, enum translucency translucency,
                            const struct gl_texture *map, int layer) {
    const struct light_view *view = &views->views[layer];
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct gl_target target = {.depth = map, .layer = layer};
    pnb_result result = gl_target_bind(gl, renderer->framebuffer, &target);
    if (result != PNB_OK)
        return result;
    const float farthest = 1.0f;
    gl->ClearBufferfv(GL_DEPTH, 0, &farthest);
    mat4 projection, clip;
    light_view_projection(view, projection);
    glm_mat4_mul(projection, (vec4 *)view->from_world, clip);
    const char *const perspective = view->perspective != 0.0f ? "#define PERSPECTIVE\n" : NULL;
    const char *const behind = views->clip_behind ? "#define CLIP_BEHIND\n" : NULL;
    const struct program_desc descs[] = {
        {.vertex = "pass_shadow_map.vert", .fragment = "pass_shadow_map.frag", .defines = {perspective, behind}},
        {.vertex = "pass_shadow_map.vert",
         .fragment = "pass_shadow_map.frag",
         .defines = {perspective, behind, "#define SPECIAL\n"}}};
    GLuint programs[2];
    for (int i = 0; i < 2; i++) {
        if ((result = program_use(&renderer->programs, &descs[i], &programs[i])) != PNB_OK)
            return result;
        program_set_mat4(gl, programs[i], "projection", (const float *)clip);
        program_set_vec2(gl, programs[i], "depth_planes", (const float[2]){view->near_depth, view->far_depth});
        program_set_vec4(gl, programs[i], "front", views->front);
        program_set_int(gl, programs[i], "translucency", (int)translucency);
        program_set_int(gl, programs[i], "sample_index", (int)frame->sample);
    }
    return gpu_scene_draw(
        renderer->scene, clip, PNB_INSTANCE_NO_SHADOW, (uint64_t)1 << frame->light,
        &(struct draw_programs){programs[0], programs[1], CASTERS_ALL, PNB_MATERIAL_CULL_SHADOW, false});
}

pnb_result pass_shadow_map(struct frame *frame, const struct light_views *views, int side,
                           enum translucency translucency, struct gl_texture *map) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    pnb_result result = gl_texture_ensure(gl, map, GL_DEPTH_COMPONENT32F, side, side, views->count, 1);
    if (result != PNB_OK || (result = pass_begin(frame, "Shadow map")) != PNB_OK)
        return result;
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthMask(GL_TRUE);
    if (views->clip_behind)
        gl->Enable(GL_CLIP_DISTANCE0);
    for (int i = 0; i < views->count && result == PNB_OK; i++)
        result = draw_view(frame, views, translucency, map, i);
    gl->Disable(GL_CLIP_DISTANCE0);
    pass_end(frame, gl_texture_bytes(map));
    return result;
}
