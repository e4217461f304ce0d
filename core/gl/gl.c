/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gl.h"

#include <stdbool.h>
#include <stdio.h>

#define REQUIRED_MAJOR 4
#define REQUIRED_MINOR 3

/* GL_VERSION starts with "major.minor"; OpenGL ES starts with words, which is too old as well. */
static pnb_result check_version(const struct gl *gl) {
    const char *version = (const char *)gl->GetString(GL_VERSION);
    if (!version) {
        return error_set(PNB_ERROR_NO_BACKEND, "glGetString(GL_VERSION) gives nothing");
    }
    int major = 0, minor = 0;
    if (sscanf(version, "%d.%d", &major, &minor) != 2 || major < REQUIRED_MAJOR ||
        (major == REQUIRED_MAJOR && minor < REQUIRED_MINOR)) {
        return error_set(PNB_ERROR_UNSUPPORTED, "needs OpenGL %d.%d, found %s", REQUIRED_MAJOR, REQUIRED_MINOR,
                         version);
    }
    return PNB_OK;
}

static int32_t smallest(const int32_t *values, size_t count) {
    int32_t result = values[0];
    for (size_t i = 1; i < count; ++i) {
        result = values[i] < result ? values[i] : result;
    }
    return result;
}

static void read_limits(struct gl *gl) {
    GLint sides[5] = {0};
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &sides[0]);
    gl->GetIntegerv(GL_MAX_VIEWPORT_DIMS, &sides[1]); /* two values */
    gl->GetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &sides[3]);
    gl->GetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &sides[4]);
    gl->max_texture_size = smallest(sides, 5);
    GLint layers = 0, block_size = 0;
    gl->GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    gl->GetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_size);
    gl->max_array_layers = layers;
    gl->max_buffer_size = block_size;
}

pnb_result gl_load(struct gl *gl, gl_lookup lookup, void *user) {
    *gl = (struct gl){0};
    /* The version decides first: implementations return addresses for functions they do not have. */
    gl->GetString = (PFNGLGETSTRINGPROC)lookup(user, "glGetString");
    if (!gl->GetString) {
        return error_set(PNB_ERROR_UNSUPPORTED, "OpenGL lacks glGetString");
    }
    pnb_result result = check_version(gl);
    if (result != PNB_OK) {
        return result;
    }
#define LOAD(type, name)                                                                                               \
    gl->name = (type)lookup(user, "gl" #name);                                                                         \
    if (!gl->name) {                                                                                                   \
        return error_set(PNB_ERROR_UNSUPPORTED, "OpenGL lacks gl" #name);                                              \
    }
    GL_FUNCTIONS(LOAD)
#undef LOAD
    read_limits(gl);
    return gl_check(gl, "reading the limits of OpenGL");
}

static const char *gl_error_name(GLenum error) {
    switch (error) {
    case GL_INVALID_ENUM:
        return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_STACK_OVERFLOW:
        return "GL_STACK_OVERFLOW";
    case GL_STACK_UNDERFLOW:
        return "GL_STACK_UNDERFLOW";
    default:
        return "unknown error";
    }
}

/* More than an implementation keeps flags for; a lost context may report for ever. */
#define MAX_PENDING_ERRORS 32

pnb_result gl_check(const struct gl *gl, const char *where) {
    GLenum first = GL_NO_ERROR;
    bool out_of_memory = false;
    for (int i = 0; i < MAX_PENDING_ERRORS; ++i) {
        GLenum error = gl->GetError();
        if (error == GL_NO_ERROR) {
            break;
        }
        if (error == GL_CONTEXT_LOST) {
            return error_set(PNB_ERROR_CONTEXT_LOST, "%s: the OpenGL context was lost", where);
        }
        out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
        first = first == GL_NO_ERROR ? error : first;
    }
    if (out_of_memory) {
        return error_set(PNB_ERROR_OUT_OF_MEMORY, "%s: OpenGL is out of memory", where);
    }
    if (first != GL_NO_ERROR) {
        return error_set(PNB_ERROR_INTERNAL, "%s: OpenGL error 0x%04x (%s)", where, first, gl_error_name(first));
    }
    return PNB_OK;
}
