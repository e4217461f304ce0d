/* SPDX-License-Identifier: GPL-3.0-or-later
 * Programs from the files of shaders/. A line `#include "name"` is replaced by that file, once per shader;
 * `#include "technique"` by the file the caller names. */
#ifndef PNB_PROGRAM_H
#define PNB_PROGRAM_H

#include "gl.h"

#define MAX_DEFINES 4

struct program_desc {
    const char *vertex, *fragment, *compute; /* file names; either compute or the other two */
    const char *technique;                   /* file for `#include "technique"`, or NULL */
    const char *defines[MAX_DEFINES];        /* lines put after #version, or NULL */
};

/* Programs made so far. All strings of a program_desc must be static: they are the key. */
struct program_cache {
    const struct gl *gl;
    struct program_entry *entries;
    uint32_t count, capacity;
};

void program_cache_init(struct program_cache *cache, const struct gl *gl);
void program_cache_free(struct program_cache *cache);

/* The program of this description, compiled at its first use and made current. Owned by the cache.
 * INTERNAL with the compiler's log when a shader does not compile. */
pnb_result program_use(struct program_cache *cache, const struct program_desc *desc, GLuint *program);

/* Uniforms of the current program; names the program does not use are ignored. */
void program_set_int(const struct gl *gl, GLuint program, const char *name, int value);
void program_set_float(const struct gl *gl, GLuint program, const char *name, float value);
void program_set_vec2(const struct gl *gl, GLuint program, const char *name, const float value[2]);
void program_set_vec3(const struct gl *gl, GLuint program, const char *name, const float value[3]);
void program_set_vec4(const struct gl *gl, GLuint program, const char *name, const float value[4]);
void program_set_mat4(const struct gl *gl, GLuint program, const char *name, const float value[16]);

#endif
