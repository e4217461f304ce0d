/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "../passes/passes.h"

void light_maps_free(const struct gl *gl, struct frame_light *light) {
    gl_texture_free(gl, &light->shadow_map);
    gl_texture_free(gl, &light->min_max);
    gl_texture_free(gl, &light->planes);
    for (int i = 0; i < MAX_PREFILTERED; i++)
        gl_texture_free(gl, &light->prefiltered[i]);
    fragment_lists_free(gl, &light->lists);
}

static void move_texture(struct gl_texture *to, struct gl_texture *from) {
    *to = *from;
    *from = (struct gl_texture){0};
}

void light_maps_move(struct frame_light *to, struct frame_light *from) {
    move_texture(&to->shadow_map, &from->shadow_map);
    move_texture(&to->min_max, &from->min_max);
    move_texture(&to->planes, &from->planes);
    for (int i = 0; i < MAX_PREFILTERED; i++)
        move_texture(&to->prefiltered[i], &from->prefiltered[i]);
    to->prefiltered_tile = from->prefiltered_tile;
    to->lists = from->lists;
    from->lists = (struct fragment_lists){0};
}

uint64_t light_maps_bytes(const struct frame_light *light) {
    uint64_t bytes = gl_texture_bytes(&light->shadow_map) + gl_texture_bytes(&light->min_max) +
                     gl_texture_bytes(&light->planes) + light->lists.heads.bytes + light->lists.fragments.bytes;
    for (int i = 0; i < MAX_PREFILTERED; i++)
        bytes += gl_texture_bytes(&light->prefiltered[i]);
    return bytes;
}

void receivers_free(struct receivers *receivers) {
    memory_free(receivers->tiles);
    memory_free(receivers->groups);
    *receivers = (struct receivers){0};
}
