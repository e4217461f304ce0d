/* SPDX-License-Identifier: GPL-3.0-or-later
 * Textures and framebuffers with their sizes, kept from frame to frame while the size stays. */
#ifndef PNB_TEXTURE_H
#define PNB_TEXTURE_H

#include "gl.h"

#include <stdbool.h>

struct gl_texture {
    GLuint id;
    GLenum format;                   /* sized internal format */
    int width, height, layers, levels; /* layers 0: a GL_TEXTURE_2D, else a GL_TEXTURE_2D_ARRAY */
};

/* Makes the texture have this format and size; nothing happens if it already does, else its content is lost.
 * Nearest filtering, clamped to the edge. OUT_OF_MEMORY leaves it empty. */
pnb_result gl_texture_ensure(const struct gl *gl, struct gl_texture *texture, GLenum format, int width, int height,
                             int layers, int levels);
void gl_texture_free(const struct gl *gl, struct gl_texture *texture);
/* Exchanges two. */
void gl_texture_swap(struct gl_texture *a, struct gl_texture *b);
/* Linear filtering within and, if it has levels, between them. */
void gl_texture_set_linear(const struct gl *gl, const struct gl_texture *texture);
/* Fills the levels above 0 with means of 2 x 2 texels. */
void gl_texture_make_levels(const struct gl *gl, const struct gl_texture *texture);
/* Memory of all levels and layers. */
uint64_t gl_texture_bytes(const struct gl_texture *texture);
/* Binds to a texture unit for the current program's sampler. */
void gl_texture_bind(const struct gl *gl, const struct gl_texture *texture, int unit);

/* Bytes per texel of the formats the library uses. */
int gl_format_bytes(GLenum format);

#define MAX_ATTACHMENTS 6

/* Draws into these textures (layer of an array, or -1 for a plain texture) with a viewport of their size.
 * depth and any color but the first may be NULL. The framebuffer object `fbo` is reused for every pass. INTERNAL if it
 * is incomplete. */
struct gl_target {
    const struct gl_texture *colors[MAX_ATTACHMENTS];
    int color_count;
    const struct gl_texture *depth;
    int layer; /* of every array attachment */
};
pnb_result gl_target_bind(const struct gl *gl, GLuint fbo, const struct gl_target *target);

#endif
