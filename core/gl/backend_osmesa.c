/* SPDX-License-Identifier: GPL-3.0-or-later
 * OSMesa: Mesa's software rasteriser without EGL. Its library holds a second copy of OpenGL, so every function must
 * come from OSMesaGetProcAddress. Mesa dropped it in 25.1. */
#include "backend.h"

#include "../memory.h"

#include <dlfcn.h>
#include <string.h>

/* From GL/osmesa.h, which is not installed everywhere. */
typedef struct osmesa_context *OSMesaContext;
#define OSMESA_FORMAT                0x22
#define OSMESA_PROFILE               0x33
#define OSMESA_CORE_PROFILE          0x34
#define OSMESA_COMPAT_PROFILE        0x35
#define OSMESA_CONTEXT_MAJOR_VERSION 0x36
#define OSMESA_CONTEXT_MINOR_VERSION 0x37

/* The default framebuffer OSMesa insists on; nothing is drawn into it. */
#define FRAMEBUFFER_SIDE 16

struct osmesa {
    OSMesaContext (*CreateContextAttribs)(const int *attributes, OSMesaContext share);
    GLboolean (*MakeCurrent)(OSMesaContext context, void *buffer, GLenum type, GLsizei width, GLsizei height);
    void (*DestroyContext)(OSMesaContext context);
    void (*(*GetProcAddress)(const char *name))(void);
    OSMesaContext context;
    GLubyte framebuffer[FRAMEBUFFER_SIDE * FRAMEBUFFER_SIDE * 4];
};

static pnb_result load_library(struct osmesa *osmesa) {
    static const char *const names[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    char errors[BACKEND_ERROR_SIZE] = "";
    void *library = NULL;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !library; ++i) {
        library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL); /* never closed: drivers have thread-local destructors */
        if (!library && i == 0) {
            text_format(errors, sizeof errors, "%s", dlerror());
        }
    }
    if (!library) {
        const char *hint =
            strstr(errors, "static TLS") ? "; start with GLIBC_TUNABLES=glibc.rtld.optional_static_tls=4096" : "";
        return error_set(PNB_ERROR_NO_BACKEND, "%s%s", errors, hint);
    }
    *(void **)&osmesa->CreateContextAttribs = dlsym(library, "OSMesaCreateContextAttribs");
    *(void **)&osmesa->MakeCurrent = dlsym(library, "OSMesaMakeCurrent");
    *(void **)&osmesa->DestroyContext = dlsym(library, "OSMesaDestroyContext");
    *(void **)&osmesa->GetProcAddress = dlsym(library, "OSMesaGetProcAddress");
    if (!osmesa->CreateContextAttribs || !osmesa->MakeCurrent || !osmesa->DestroyContext || !osmesa->GetProcAddress) {
        return error_set(PNB_ERROR_NO_BACKEND, "libOSMesa is too old: it lacks OSMesaCreateContextAttribs");
    }
    return PNB_OK;
}

/* The newest core profile; failing that any context, so that gl_load can say which version there is. */
static pnb_result create_context(struct osmesa *osmesa) {
    static const int versions[][3] = {{OSMESA_CORE_PROFILE, 4, 6},
                                      {OSMESA_CORE_PROFILE, 4, 5},
                                      {OSMESA_CORE_PROFILE, 4, 3},
                                      {OSMESA_CORE_PROFILE, 3, 2},
                                      {OSMESA_COMPAT_PROFILE, 1, 0}};
    for (size_t i = 0; i < sizeof versions / sizeof versions[0] && !osmesa->context; ++i) {
        const int attributes[] = {OSMESA_FORMAT,
                                  GL_RGBA,
                                  OSMESA_PROFILE,
                                  versions[i][0],
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  versions[i][1],
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  versions[i][2],
                                  0};
        osmesa->context = osmesa->CreateContextAttribs(attributes, NULL);
    }
    if (!osmesa->context) {
        return error_set(PNB_ERROR_NO_BACKEND, "OSMesaCreateContextAttribs failed");
    }
    if (!osmesa->MakeCurrent(osmesa->context, osmesa->framebuffer, GL_UNSIGNED_BYTE, FRAMEBUFFER_SIDE,
                             FRAMEBUFFER_SIDE)) {
        return error_set(PNB_ERROR_NO_BACKEND, "OSMesaMakeCurrent failed");
    }
    return PNB_OK;
}

static void (*osmesa_lookup(void *user, const char *name))(void) {
    const struct osmesa *osmesa = user;
    return osmesa->GetProcAddress(name);
}

static void osmesa_close(void *state) {
    struct osmesa *osmesa = state;
    if (osmesa->context) {
        osmesa->MakeCurrent(NULL, NULL, 0, 0, 0);
        osmesa->DestroyContext(osmesa->context);
    }
    memory_free(osmesa);
}

static pnb_result osmesa_open(const struct candidate *candidate, const struct context_options *options,
                              struct backend *backend) {
    (void)candidate;
    (void)options;
    struct osmesa *osmesa = memory_array(1, sizeof *osmesa);
    if (!osmesa) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    pnb_result result = load_library(osmesa);
    if (result == PNB_OK) {
        result = create_context(osmesa);
    }
    if (result != PNB_OK) {
        osmesa_close(osmesa);
        return result;
    }
    backend->lookup = osmesa_lookup;
    backend->close = osmesa_close;
    backend->state = osmesa;
    return PNB_OK;
}

void osmesa_list(struct ladder *ladder) {
    ladder_add(ladder, "osmesa")->open = osmesa_open;
}
