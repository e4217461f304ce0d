/* SPDX-License-Identifier: GPL-3.0-or-later
 * The ways to open OpenGL without a window, from a GPU down to software. What a driver claims is not believed: a
 * backend works when a context of it clears and reads back a pixel.
 * Everything here that opens or closes runs on the thread that owns the context, under gl_thread_lock. */
#ifndef PNB_BACKEND_H
#define PNB_BACKEND_H

#include "gl.h"

#include <stdbool.h>

#define BACKEND_NAME_SIZE  32
#define BACKEND_ERROR_SIZE 256
/* A machine with more devices is served by the first ones. */
#define MAX_DEVICES 32

/* An open backend; its context is current. */
struct backend {
    char name[BACKEND_NAME_SIZE];
    struct gl gl;
    gl_lookup lookup;           /* for functions beyond the table; its user is `state` */
    void (*close)(void *state); /* releases the context and frees state */
    void *state;
};

struct candidate;

struct context_options {
    bool debug; /* ask for a context that reports OpenGL debug messages */
};

/* Makes a context current, of the newest version there is, and fills lookup, close and state. */
typedef pnb_result (*backend_opener)(const struct candidate *candidate, const struct context_options *options,
                                     struct backend *backend);

/* One rung of the ladder. */
struct candidate {
    char name[BACKEND_NAME_SIZE];
    backend_opener open;
    void *device;                   /* EGLDeviceEXT, for devices */
    bool is_hardware;               /* a device that does not say it is software */
    char error[BACKEND_ERROR_SIZE]; /* not "": known to fail before it is opened */
};

struct ladder {
    struct candidate candidates[MAX_DEVICES + 2];
    uint32_t count;
};

/* Which rungs the user wants. */
struct backend_choice {
    bool devices, surfaceless, osmesa;
    int device; /* index of the only device wanted, or -1 */
};

/* name: as pnb_context_desc.backend. */
pnb_result backend_choose(const char *name, struct backend_choice *choice);
void ladder_list(const struct backend_choice *choice, struct ladder *ladder);

/* What failed before the backend that was taken. */
struct backend_report {
    char failures[ERROR_TEXT_SIZE]; /* "name: reason; name: reason" */
    bool hardware_failed;
};

/* What a driver needs to start, and to compile a shader: with less of the process's address space left, drivers are
 * known to hang or to abort the process. */
#define ADDRESS_SPACE_TO_START   ((uint64_t)768 << 20)
#define ADDRESS_SPACE_TO_COMPILE ((uint64_t)128 << 20)
/* OUT_OF_MEMORY if the limit on address space leaves less. */
pnb_result backend_check_address_space(uint64_t least);
/* Opens the first backend that works. On failure the message lists every attempt. */
pnb_result backend_open(const struct backend_choice *choice, const struct context_options *options,
                        struct backend *backend, struct backend_report *report);
/* Opens one rung, and checks version and functions and a pixel. */
pnb_result backend_try(const struct candidate *candidate, const struct context_options *options,
                       struct backend *backend);
void backend_close(struct backend *backend);

/* Adds the devices of EGL_EXT_platform_device, hardware first; without any, one candidate that says why. */
void egl_list_devices(struct ladder *ladder);
void egl_list_surfaceless(struct ladder *ladder);
void osmesa_list(struct ladder *ladder);

/* Next free rung, named. */
struct candidate *ladder_add(struct ladder *ladder, const char *format, ...) PNB_PRINTF(2, 3);

#endif
