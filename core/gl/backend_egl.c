/* SPDX-License-Identifier: GPL-3.0-or-later
 * EGL without a window: its devices, and Mesa's surfaceless platform. The platform is always named, so that no display
 * server is ever asked for. Displays are shared by the whole process: none is ever terminated. */
#include "backend.h"

#include "../memory.h"

#include <dlfcn.h>
#include <string.h>

#define EGL_EGL_PROTOTYPES             0
#define EGL_NO_PLATFORM_SPECIFIC_TYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

/* X(type, name): EGL 1.4, looked up in the library itself. */
#define EGL_FUNCTIONS(X)                                                                                               \
    X(PFNEGLBINDAPIPROC, BindAPI)                                                                                      \
    X(PFNEGLCHOOSECONFIGPROC, ChooseConfig)                                                                            \
    X(PFNEGLCREATECONTEXTPROC, CreateContext)                                                                          \
    X(PFNEGLCREATEPBUFFERSURFACEPROC, CreatePbufferSurface)                                                            \
    X(PFNEGLDESTROYCONTEXTPROC, DestroyContext)                                                                        \
    X(PFNEGLDESTROYSURFACEPROC, DestroySurface)                                                                        \
    X(PFNEGLGETERRORPROC, GetError)                                                                                    \
    X(PFNEGLGETPROCADDRESSPROC, GetProcAddress)                                                                        \
    X(PFNEGLINITIALIZEPROC, Initialize)                                                                                \
    X(PFNEGLMAKECURRENTPROC, MakeCurrent)                                                                              \
    X(PFNEGLQUERYSTRINGPROC, QueryString)                                                                              \
    X(PFNEGLRELEASETHREADPROC, ReleaseThread)

struct egl {
#define EGL_MEMBER(type, name) type name;
    EGL_FUNCTIONS(EGL_MEMBER)
#undef EGL_MEMBER
    const char *client_extensions; /* "" if there are none */
};

struct egl_context {
    struct egl egl;
    EGLDisplay display;
    EGLint major, minor;
    const char *extensions; /* of the display */
    EGLConfig config;
    EGLContext context;
    EGLSurface surface;
};

static const char *egl_error_name(EGLint error) {
    static const char *const names[] = {"EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
                                        "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
                                        "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
                                        "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
                                        "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
    EGLint index = error - EGL_SUCCESS;
    return index >= 0 && index < (EGLint)(sizeof names / sizeof names[0]) ? names[index] : "unknown error";
}

/* A function that fails may still report EGL_SUCCESS; what it returned counts. */
static pnb_result egl_fail(const struct egl *egl, const char *function) {
    EGLint error = egl->GetError();
    return error_set(PNB_ERROR_NO_BACKEND, "%s failed: %s (0x%04x)", function, egl_error_name(error), (unsigned)error);
}

static bool has_extension(const char *extensions, const char *name) {
    size_t length = strlen(name);
    for (const char *at = strstr(extensions, name); at; at = strstr(at + length, name)) {
        bool starts = at == extensions || at[-1] == ' ';
        if (starts && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

static pnb_result load_library(struct egl *egl) {
    void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL); /* never closed: drivers have atexit handlers */
    if (!library) {
        return error_set(PNB_ERROR_NO_BACKEND, "%s", dlerror());
    }
#define EGL_LOAD(type, name)                                                                                           \
    *(void **)&egl->name = dlsym(library, "egl" #name);                                                                \
    if (!egl->name) {                                                                                                  \
        return error_set(PNB_ERROR_NO_BACKEND, "libEGL.so.1 lacks egl" #name);                                         \
    }
    EGL_FUNCTIONS(EGL_LOAD)
#undef EGL_LOAD
    const char *extensions = egl->QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    egl->client_extensions = extensions ? extensions : "";
    return PNB_OK;
}

/* An extension's function; only to be called when the extension is there, for the address proves nothing. */
static void *extension_function(const struct egl *egl, const char *extension, const char *name) {
    return has_extension(egl->client_extensions, extension) ? (void *)egl->GetProcAddress(name) : NULL;
}

static pnb_result open_display(struct egl_context *state, EGLenum platform, void *native) {
    const struct egl *egl = &state->egl;
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display;
    *(void **)&get_display = extension_function(egl, "EGL_EXT_platform_base", "eglGetPlatformDisplayEXT");
    if (!get_display) {
        return error_set(PNB_ERROR_NO_BACKEND, "EGL lacks EGL_EXT_platform_base");
    }
    state->display = get_display(platform, native, NULL);
    if (state->display == EGL_NO_DISPLAY) {
        return egl_fail(egl, "eglGetPlatformDisplayEXT");
    }
    if (!egl->Initialize(state->display, &state->major, &state->minor)) {
        return egl_fail(egl, "eglInitialize");
    }
    const char *extensions = egl->QueryString(state->display, EGL_EXTENSIONS);
    state->extensions = extensions ? extensions : "";
    if (!egl->BindAPI(EGL_OPENGL_API)) {
        return egl_fail(egl, "eglBindAPI(EGL_OPENGL_API)");
    }
    return PNB_OK;
}

/* A config that allows the pbuffer we may need; else any; else none, where that is allowed. */
static pnb_result choose_config(struct egl_context *state) {
    static const EGLint surface_types[] = {EGL_PBUFFER_BIT, 0};
    for (size_t i = 0; i < sizeof surface_types / sizeof surface_types[0]; ++i) {
        const EGLint attributes[] = {EGL_SURFACE_TYPE, surface_types[i], EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLint count = 0;
        if (state->egl.ChooseConfig(state->display, attributes, &state->config, 1, &count) && count > 0) {
            return PNB_OK;
        }
    }
    state->config = EGL_NO_CONFIG_KHR;
    if (has_extension(state->extensions, "EGL_KHR_no_config_context")) {
        return PNB_OK;
    }
    return egl_fail(&state->egl, "eglChooseConfig for desktop OpenGL");
}

/* Adds what is nice to have: news of a GPU reset, and debug messages. */
static size_t add_extras(const struct egl_context *state, const struct context_options *options, EGLint *attributes) {
    size_t count = 0;
    if (has_extension(state->extensions, "EGL_EXT_create_context_robustness")) {
        attributes[count++] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR;
        attributes[count++] = EGL_LOSE_CONTEXT_ON_RESET_KHR;
    }
    if (options->debug && has_extension(state->extensions, "EGL_KHR_create_context")) {
        attributes[count++] = EGL_CONTEXT_FLAGS_KHR;
        attributes[count++] = EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR;
    }
    return count;
}

static bool create_version(struct egl_context *state, const struct context_options *options, EGLint major,
                           EGLint minor) {
    for (int plain = 0; plain < 2 && state->context == EGL_NO_CONTEXT; ++plain) {
        EGLint attributes[16] = {EGL_CONTEXT_MAJOR_VERSION,       major,
                                 EGL_CONTEXT_MINOR_VERSION,       minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
        size_t count = 6;
        if (!plain) {
            count += add_extras(state, options, attributes + count);
        }
        attributes[count] = EGL_NONE;
        state->context = state->egl.CreateContext(state->display, state->config, EGL_NO_CONTEXT, attributes);
    }
    return state->context != EGL_NO_CONTEXT;
}

/* The newest core profile; failing that any context, so that gl_load can say which version there is. */
static pnb_result create_context(struct egl_context *state, const struct context_options *options) {
    static const EGLint versions[][2] = {{4, 6}, {4, 5}, {4, 3}, {3, 2}};
    bool has_versions =
        state->major > 1 || state->minor >= 5 || has_extension(state->extensions, "EGL_KHR_create_context");
    for (size_t i = 0; has_versions && i < sizeof versions / sizeof versions[0]; ++i) {
        if (create_version(state, options, versions[i][0], versions[i][1])) {
            return PNB_OK;
        }
    }
    static const EGLint no_attributes[] = {EGL_NONE};
    state->context = state->egl.CreateContext(state->display, state->config, EGL_NO_CONTEXT, no_attributes);
    return state->context != EGL_NO_CONTEXT ? PNB_OK : egl_fail(&state->egl, "eglCreateContext");
}

/* Whether a context can do without a surface is found out by doing: some drivers claim it wrongly. */
static pnb_result make_current(struct egl_context *state) {
    const struct egl *egl = &state->egl;
    if (egl->MakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state->context)) {
        return PNB_OK;
    }
    pnb_result result = egl_fail(egl, "eglMakeCurrent without a surface");
    if (state->config == EGL_NO_CONFIG_KHR) {
        return result;
    }
    static const EGLint attributes[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    state->surface = egl->CreatePbufferSurface(state->display, state->config, attributes);
    if (state->surface == EGL_NO_SURFACE) {
        return egl_fail(egl, "eglCreatePbufferSurface");
    }
    if (!egl->MakeCurrent(state->display, state->surface, state->surface, state->context)) {
        return egl_fail(egl, "eglMakeCurrent with a pbuffer");
    }
    return PNB_OK;
}

static void (*egl_lookup(void *user, const char *name))(void) {
    const struct egl_context *state = user;
    return state->egl.GetProcAddress(name);
}

static void egl_close(void *user) {
    struct egl_context *state = user;
    const struct egl *egl = &state->egl;
    if (state->context != EGL_NO_CONTEXT) {
        egl->MakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        egl->DestroyContext(state->display, state->context);
    }
    if (state->surface != EGL_NO_SURFACE) {
        egl->DestroySurface(state->display, state->surface);
    }
    if (egl->ReleaseThread) {
        egl->ReleaseThread();
    }
    memory_free(state);
}

static pnb_result egl_open(EGLenum platform, void *native, const struct context_options *options,
                           struct backend *backend) {
    struct egl_context *state = memory_array(1, sizeof *state);
    if (!state) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    pnb_result result = load_library(&state->egl);
    if (result == PNB_OK) {
        result = open_display(state, platform, native);
    }
    if (result == PNB_OK) {
        result = choose_config(state);
    }
    if (result == PNB_OK) {
        result = create_context(state, options);
    }
    if (result == PNB_OK) {
        result = make_current(state);
    }
    if (result != PNB_OK) {
        egl_close(state);
        return result;
    }
    backend->lookup = egl_lookup;
    backend->close = egl_close;
    backend->state = state;
    return PNB_OK;
}

static pnb_result open_device(const struct candidate *candidate, const struct context_options *options,
                              struct backend *backend) {
    return egl_open(EGL_PLATFORM_DEVICE_EXT, candidate->device, options, backend);
}

static pnb_result open_surfaceless(const struct candidate *candidate, const struct context_options *options,
                                   struct backend *backend) {
    (void)candidate;
    return egl_open(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, options, backend);
}

static pnb_result query_devices(const struct egl *egl, EGLDeviceEXT *devices, EGLint *count) {
    PFNEGLQUERYDEVICESEXTPROC query;
    *(void **)&query = extension_function(egl, "EGL_EXT_device_enumeration", "eglQueryDevicesEXT");
    if (!query) { /* EGL_EXT_device_base is the older name of enumeration and query together */
        *(void **)&query = extension_function(egl, "EGL_EXT_device_base", "eglQueryDevicesEXT");
    }
    if (!query || !has_extension(egl->client_extensions, "EGL_EXT_platform_device")) {
        return error_set(
            PNB_ERROR_NO_BACKEND,
            "EGL lacks EGL_EXT_device_enumeration or EGL_EXT_platform_device (is a driver in egl_vendor.d?)");
    }
    if (!query(MAX_DEVICES, devices, count)) {
        return egl_fail(egl, "eglQueryDevicesEXT");
    }
    if (*count <= 0) {
        return error_set(PNB_ERROR_NO_BACKEND, "EGL has no devices (is a driver in egl_vendor.d?)");
    }
    return PNB_OK;
}

static bool is_software_device(const struct egl *egl, EGLDeviceEXT device) {
    PFNEGLQUERYDEVICESTRINGEXTPROC query;
    *(void **)&query = extension_function(egl, "EGL_EXT_device_query", "eglQueryDeviceStringEXT");
    if (!query) {
        *(void **)&query = extension_function(egl, "EGL_EXT_device_base", "eglQueryDeviceStringEXT");
    }
    const char *extensions = query ? query(device, EGL_EXTENSIONS) : NULL;
    return extensions && has_extension(extensions, "EGL_MESA_device_software");
}

void egl_list_devices(struct ladder *ladder) {
    struct egl egl;
    EGLDeviceEXT devices[MAX_DEVICES];
    EGLint count = 0;
    pnb_result result = load_library(&egl);
    if (result == PNB_OK) {
        result = query_devices(&egl, devices, &count);
    }
    if (result != PNB_OK) {
        struct candidate *none = ladder_add(ladder, "egl");
        text_format(none->error, sizeof none->error, "%s", pnb_last_error());
        return;
    }
    for (int software = 0; software < 2; ++software) {
        for (EGLint i = 0; i < count; ++i) {
            if (is_software_device(&egl, devices[i]) == (software == 1)) {
                struct candidate *candidate = ladder_add(ladder, "egl:%d", i);
                candidate->open = open_device;
                candidate->device = devices[i];
                candidate->is_hardware = !software;
            }
        }
    }
}

void egl_list_surfaceless(struct ladder *ladder) {
    struct candidate *candidate = ladder_add(ladder, "surfaceless");
    candidate->open = open_surfaceless;
    struct egl egl;
    if (load_library(&egl) != PNB_OK) {
        text_format(candidate->error, sizeof candidate->error, "%s", pnb_last_error());
    } else if (!has_extension(egl.client_extensions, "EGL_MESA_platform_surfaceless")) {
        text_format(candidate->error, sizeof candidate->error, "EGL lacks EGL_MESA_platform_surfaceless");
    }
}
