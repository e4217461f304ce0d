/* SPDX-License-Identifier: GPL-3.0-or-later
 * Programs from the files of shaders/. A line `#include "name"` is replaced by that file, once per shader;
 * `#include "technique"` by the file the caller names. */
#ifndef PNB_PROGRAM_H
#define PNB_PROGRAM_H

#include "gl.h"

struct program_desc {
    const char *vertex, *fragment, *compute; /* file names; either compute or the other two */
    const char *technique;                   /* file for `#include "technique"`, or NULL */
    const char *defines;                     /* lines put after #version, or NULL */
};

/* INTERNAL with the compiler's log when a shader does not compile. The caller deletes the program. */
pnb_result program_create(const struct gl *gl, const struct program_desc *desc, GLuint *program);

/* Uniforms of the current program; names the program does not use are ignored. */
void program_set_int(const struct gl *gl, GLuint program, const char *name, int value);
void program_set_float(const struct gl *gl, GLuint program, const char *name, float value);
void program_set_vec2(const struct gl *gl, GLuint program, const char *name, const float value[2]);
void program_set_vec3(const struct gl *gl, GLuint program, const char *name, const float value[3]);
void program_set_vec4(const struct gl *gl, GLuint program, const char *name, const float value[4]);
void program_set_mat4(const struct gl *gl, GLuint program, const char *name, const float value[16]);

#endif
