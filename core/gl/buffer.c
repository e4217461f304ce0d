/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "buffer.h"

#define MIB(bytes) ((double)(bytes) / 1048576.0)

/* Binary logarithm of the words in one block of a split buffer. */
static int split_shift(const struct gl *gl) {
    int shift = 2;
    while (shift < 25 && (8ll << shift) <= gl->max_buffer_size)
        shift++;
    return shift;
}

static uint64_t split_limit(const struct gl *gl) {
    const uint64_t split = (uint64_t)GL_BUFFER_BLOCKS * 4 << split_shift(gl);
    return split > (uint64_t)gl->max_buffer_size ? split : (uint64_t)gl->max_buffer_size;
}

static pnb_result allocate(const struct gl *gl, uint64_t bytes, uint64_t limit, const char *what, GLuint *id) {
    if (bytes > limit)
        return error_set(PNB_ERROR_OUT_OF_MEMORY, "%s: %.0f MiB of memory are needed, this OpenGL allows %.0f MiB",
                         what, MIB(bytes), MIB(limit));
    gl->GenBuffers(1, id);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *id);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)bytes, NULL, GL_DYNAMIC_COPY);
    pnb_result result = gl_check(gl, what);
    if (result == PNB_OK)
        return PNB_OK;
    gl->DeleteBuffers(1, id);
    if (result == PNB_ERROR_OUT_OF_MEMORY)
        return error_set(result, "%s: OpenGL has no memory for %.0f MiB", what, MIB(bytes));
    return result;
}

static pnb_result ensure(const struct gl *gl, struct gl_buffer *buffer, uint64_t bytes, uint64_t limit, uint64_t kept,
                         const char *what) {
    if (buffer->id && buffer->bytes >= bytes)
        return PNB_OK;
    if (kept == 0)
        gl_buffer_free(gl, buffer);
    GLuint id = 0;
    pnb_result result = allocate(gl, bytes, limit, what, &id);
    if (result != PNB_OK)
        return result;
    if (kept > 0) {
        gl->BindBuffer(GL_COPY_READ_BUFFER, buffer->id);
        gl->CopyBufferSubData(GL_COPY_READ_BUFFER, GL_SHADER_STORAGE_BUFFER, 0, 0, (GLsizeiptr)kept);
    }
    gl_buffer_free(gl, buffer);
    *buffer = (struct gl_buffer){id, bytes};
    return gl_check(gl, what);
}

pnb_result gl_buffer_ensure(const struct gl *gl, struct gl_buffer *buffer, uint64_t bytes, uint64_t kept,
                            const char *what) {
    return ensure(gl, buffer, bytes, (uint64_t)gl->max_buffer_size, kept, what);
}

pnb_result gl_buffer_ensure_split(const struct gl *gl, struct gl_buffer *buffer, uint64_t bytes, uint64_t kept,
                                  const char *what) {
    return ensure(gl, buffer, bytes, split_limit(gl), kept, what);
}

void gl_buffer_free(const struct gl *gl, struct gl_buffer *buffer) {
    if (buffer->id)
        gl->DeleteBuffers(1, &buffer->id);
    *buffer = (struct gl_buffer){0};
}

void gl_buffer_bind(const struct gl *gl, const struct gl_buffer *buffer, GLuint block) {
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, block, buffer->id);
}

bool gl_buffer_is_split(const struct gl *gl, const struct gl_buffer *buffer) {
    return buffer->bytes > (uint64_t)gl->max_buffer_size;
}

int gl_buffer_bind_split(const struct gl *gl, const struct gl_buffer *buffer, const GLuint blocks[GL_BUFFER_BLOCKS]) {
    const int shift = split_shift(gl);
    if (!gl_buffer_is_split(gl, buffer)) {
        gl_buffer_bind(gl, buffer, blocks[0]);
        return shift;
    }
    const uint64_t size = 4ull << shift;
    for (uint64_t i = 0; i < GL_BUFFER_BLOCKS; i++) {
        const uint64_t first = i * size < buffer->bytes ? i * size : 0; /* a block is never without a buffer */
        const uint64_t rest = buffer->bytes - first;
        gl->BindBufferRange(GL_SHADER_STORAGE_BUFFER, blocks[i], buffer->id, (GLintptr)first,
                            (GLsizeiptr)(rest < size ? rest : size));
    }
    return shift;
}

void gl_buffer_clear(const struct gl *gl, const struct gl_buffer *buffer, uint64_t bytes) {
    const GLuint zero = 0;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->id);
    gl->ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)bytes, GL_RED_INTEGER, GL_UNSIGNED_INT,
                           &zero);
}
