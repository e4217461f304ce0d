/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a QUICK job leaves for the next: its G-buffer while scene and view stay, its shadow maps while they still show
 * what they must, though they are fitted to an earlier view. Of moved lamp and moved view only one is drawn anew. Lives
 * on the OpenGL thread. */
#ifndef PNB_KEPT_H
#define PNB_KEPT_H

#include "frame.h"

struct kept_light {
    struct content_key key;   /* of all that its maps show */
    struct content_key kind;  /* of what decides which maps there are */
    struct frame_light light; /* only its views and maps */
};

struct kept {
    struct gl_texture gbuffer[6];   /* and tiles: of QUICK jobs; exchanged with the renderer's while one runs */
    GLuint tile_buffer;
    struct content_key gbuffer_key; /* of what they show; 0: nothing */
    struct receivers receivers;
    struct kept_light lights[MAX_LIGHTS];
    uint64_t map_bytes;
};

void kept_init(struct kept *kept, const struct gl *gl);
void kept_free(struct kept *kept, const struct gl *gl);
/* Around a job. A QUICK one has a G-buffer of its own; one that nobody watches has the memory of all that is kept. */
void kept_begin(struct frame *frame);
void kept_end(struct frame *frame, bool complete);
/* Whether the G-buffer is the frame's already; its receivers are then set. */
bool kept_take_gbuffer(struct frame *frame);
/* Whether there are maps that show what the light's views must; light and views then have them. If not, the light may
 * have textures to draw them into. */
bool kept_take_maps(struct frame *frame, struct frame_light *light);
/* Whether the light's maps are kept for the next job. If not, they are left to the caller. */
bool kept_give_maps(struct frame *frame, struct frame_light *light);

#endif
