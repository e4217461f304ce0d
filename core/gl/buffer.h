/* SPDX-License-Identifier: GPL-3.0-or-later
 * Storage buffers with their sizes, kept while they are large enough. */
#ifndef PNB_BUFFER_H
#define PNB_BUFFER_H

#include "gl.h"

#include <stdbool.h>

struct gl_buffer {
    GLuint id;
    uint64_t bytes; /* capacity */
};

/* Makes room for so many bytes; the first `kept` stay if it has to grow. OUT_OF_MEMORY, also above what storage
 * blocks may have, names the buffer `what`. */
pnb_result gl_buffer_ensure(const struct gl *gl, struct gl_buffer *buffer, uint64_t bytes, uint64_t kept,
                            const char *what);
/* The same for a buffer that shaders may see in several storage blocks. */
pnb_result gl_buffer_ensure_split(const struct gl *gl, struct gl_buffer *buffer, uint64_t bytes, uint64_t kept,
                                  const char *what);
void gl_buffer_free(const struct gl *gl, struct gl_buffer *buffer);
/* Binds to a storage block. */
void gl_buffer_bind(const struct gl *gl, const struct gl_buffer *buffer, GLuint block);
/* Whether it is larger than a storage block may be. */
bool gl_buffer_is_split(const struct gl *gl, const struct gl_buffer *buffer);
/* Binds it to that many blocks, 2^n words to each; gives n. One that is not split is in the first alone. */
#define GL_BUFFER_BLOCKS 4
int gl_buffer_bind_split(const struct gl *gl, const struct gl_buffer *buffer, const GLuint blocks[GL_BUFFER_BLOCKS]);
/* Sets the first bytes to zero. */
void gl_buffer_clear(const struct gl *gl, const struct gl_buffer *buffer, uint64_t bytes);

#endif
