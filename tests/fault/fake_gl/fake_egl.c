/* SPDX-License-Identifier: GPL-3.0-or-later
 * A libEGL.so.1 that passes everything on to the real one, except for the faults of the environment variable FAKE_EGL:
 * a list, separated by spaces, of fail=FUNCTION:ERROR      the EGL function fails, and eglGetError then gives ERROR
 * (hexadecimal) hide=EXTENSION           the extension is listed neither for the client nor for the display no-devices,
 * no-configs   the lists are empty, without an error hardware                 the first device does not say that it is
 * software, and cannot be opened surface                  no context can be current without a surface
 *   no-function=glFUNCTION   eglGetProcAddress gives NULL for it
 *   gl-version=TEXT          glGetString(GL_VERSION) gives it, with spaces for underscores
 *   no-pixels                glReadPixels writes nothing
 *   gl-error=N:CODE          the N-th glGetError from the start gives CODE (hexadecimal)
 * fake_egl_set changes the list at run time. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EGL_NO_PLATFORM_SPECIFIC_TYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#define EXPORT __attribute__((visibility("default")))

static char faults[1024];
static atomic_int calls_of_get_error;
static _Thread_local EGLint pending_error;
static char hardware_device; /* its address is the handle of the device that fails */

EXPORT void fake_egl_set(const char *list);

void fake_egl_set(const char *list) {
    snprintf(faults, sizeof faults, " %s ", list ? list : "");
    atomic_store(&calls_of_get_error, 0);
}

__attribute__((constructor)) static void read_environment(void) {
    fake_egl_set(getenv("FAKE_EGL"));
}

static void *real(const char *name) {
    static void *library;
    if (!library) {
        library = dlopen(REAL_EGL, RTLD_NOW | RTLD_LOCAL);
    }
    return dlsym(library, name);
}

#define REAL(type, name) ((type)real("egl" name))

/* What follows `key` in the list, or NULL. */
static const char *fault(const char *key) {
    size_t length = strlen(key);
    for (const char *at = strstr(faults, key); at; at = strstr(at + length, key)) {
        if (at[-1] == ' ') { /* the list starts and ends with a space */
            return at + length;
        }
    }
    return NULL;
}

static bool has_fault(const char *key) {
    const char *rest = fault(key);
    return rest && *rest == ' ';
}

/* Whether the function is to fail; eglGetError then gives what was asked for. */
static bool fails(const char *function) {
    char key[128];
    snprintf(key, sizeof key, "fail=%s:", function);
    const char *code = fault(key);
    if (code) {
        pending_error = (EGLint)strtol(code, NULL, 16);
    }
    return code != NULL;
}

/* The list without the extensions to hide; the copy is kept, as its receiver expects. */
static const char *without_hidden(const char *extensions) {
    static char copies[8][8192];
    static atomic_uint next;
    if (!extensions) {
        return NULL;
    }
    char *copy = copies[atomic_fetch_add(&next, 1) % 8];
    copy[0] = '\0';
    for (const char *at = extensions; *at;) {
        size_t length = strcspn(at, " ");
        char key[128];
        snprintf(key, sizeof key, "hide=%.*s", (int)length, at);
        if (!has_fault(key)) {
            size_t end = strlen(copy);
            snprintf(copy + end, 8192 - end, "%.*s ", (int)length, at);
        }
        at += length + strspn(at + length, " ");
    }
    return copy;
}

/* ---- EGL --------------------------------------------------------------------------------------------------- */

EXPORT EGLint eglGetError(void) {
    if (pending_error) {
        EGLint error = pending_error;
        pending_error = 0;
        return error;
    }
    return REAL(PFNEGLGETERRORPROC, "GetError")();
}

EXPORT EGLBoolean eglBindAPI(EGLenum api) {
    return fails("eglBindAPI") ? EGL_FALSE : REAL(PFNEGLBINDAPIPROC, "BindAPI")(api);
}

EXPORT EGLBoolean eglInitialize(EGLDisplay display, EGLint *major, EGLint *minor) {
    return fails("eglInitialize") ? EGL_FALSE : REAL(PFNEGLINITIALIZEPROC, "Initialize")(display, major, minor);
}

EXPORT const char *eglQueryString(EGLDisplay display, EGLint name) {
    if (fails("eglQueryString")) {
        return NULL;
    }
    const char *text = REAL(PFNEGLQUERYSTRINGPROC, "QueryString")(display, name);
    return name == EGL_EXTENSIONS ? without_hidden(text) : text;
}

EXPORT EGLBoolean eglChooseConfig(EGLDisplay display, const EGLint *attributes, EGLConfig *configs, EGLint size,
                                  EGLint *count) {
    if (has_fault("no-configs")) {
        *count = 0;
        return EGL_TRUE;
    }
    return fails("eglChooseConfig")
               ? EGL_FALSE
               : REAL(PFNEGLCHOOSECONFIGPROC, "ChooseConfig")(display, attributes, configs, size, count);
}

EXPORT EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext share, const EGLint *attributes) {
    return fails("eglCreateContext")
               ? EGL_NO_CONTEXT
               : REAL(PFNEGLCREATECONTEXTPROC, "CreateContext")(display, config, share, attributes);
}

EXPORT EGLSurface eglCreatePbufferSurface(EGLDisplay display, EGLConfig config, const EGLint *attributes) {
    return fails("eglCreatePbufferSurface")
               ? EGL_NO_SURFACE
               : REAL(PFNEGLCREATEPBUFFERSURFACEPROC, "CreatePbufferSurface")(display, config, attributes);
}

EXPORT EGLBoolean eglMakeCurrent(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context) {
    if (context != EGL_NO_CONTEXT && fails("eglMakeCurrent")) {
        return EGL_FALSE;
    }
    if (context != EGL_NO_CONTEXT && draw == EGL_NO_SURFACE && has_fault("surface")) {
        pending_error = EGL_BAD_MATCH;
        return EGL_FALSE;
    }
    return REAL(PFNEGLMAKECURRENTPROC, "MakeCurrent")(display, draw, read, context);
}

EXPORT EGLBoolean eglDestroyContext(EGLDisplay display, EGLContext context) {
    return REAL(PFNEGLDESTROYCONTEXTPROC, "DestroyContext")(display, context);
}

EXPORT EGLBoolean eglDestroySurface(EGLDisplay display, EGLSurface surface) {
    return REAL(PFNEGLDESTROYSURFACEPROC, "DestroySurface")(display, surface);
}

EXPORT EGLBoolean eglReleaseThread(void) {
    return REAL(PFNEGLRELEASETHREADPROC, "ReleaseThread")();
}

/* ---- Extensions and OpenGL, handed out by eglGetProcAddress ------------------------------------------------ */

static __eglMustCastToProperFunctionPointerType real_address(const char *name) {
    return REAL(PFNEGLGETPROCADDRESSPROC, "GetProcAddress")(name);
}

static EGLBoolean EGLAPIENTRY query_devices(EGLint capacity, EGLDeviceEXT *devices, EGLint *count) {
    if (fails("eglQueryDevicesEXT")) {
        return EGL_FALSE;
    }
    *count = 0;
    if (has_fault("no-devices")) {
        return EGL_TRUE;
    }
    EGLint added = 0;
    if (has_fault("hardware")) {
        devices[added++] = &hardware_device;
    }
    EGLBoolean result =
        ((PFNEGLQUERYDEVICESEXTPROC)real_address("eglQueryDevicesEXT"))(capacity - added, devices + added, count);
    *count += added;
    return result;
}

static const char *EGLAPIENTRY query_device_string(EGLDeviceEXT device, EGLint name) {
    if (device == &hardware_device) {
        return "EGL_EXT_device_drm";
    }
    return ((PFNEGLQUERYDEVICESTRINGEXTPROC)real_address("eglQueryDeviceStringEXT"))(device, name);
}

static EGLDisplay EGLAPIENTRY get_platform_display(EGLenum platform, void *native, const EGLint *attributes) {
    if (native == &hardware_device) {
        pending_error = EGL_BAD_ACCESS;
        return EGL_NO_DISPLAY;
    }
    if (fails("eglGetPlatformDisplayEXT")) {
        return EGL_NO_DISPLAY;
    }
    return ((PFNEGLGETPLATFORMDISPLAYEXTPROC)real_address("eglGetPlatformDisplayEXT"))(platform, native, attributes);
}

static const GLubyte *APIENTRY get_string(GLenum name) {
    const char *version = fault("gl-version=");
    if (!version || name != GL_VERSION) {
        return ((PFNGLGETSTRINGPROC)real_address("glGetString"))(name);
    }
    static char text[128];
    snprintf(text, sizeof text, "%.*s", (int)strcspn(version, " "), version);
    for (char *at = strchr(text, '_'); at; at = strchr(at, '_')) {
        *at = ' ';
    }
    return (const GLubyte *)text;
}

static GLenum APIENTRY get_gl_error(void) {
    const char *at = fault("gl-error=");
    GLenum error = ((PFNGLGETERRORPROC)real_address("glGetError"))();
    if (at && atomic_fetch_add(&calls_of_get_error, 1) + 1 == atoi(at)) {
        return (GLenum)strtol(strchr(at, ':') + 1, NULL, 16);
    }
    return error;
}

static void APIENTRY read_pixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                                 void *pixels) {
    if (!has_fault("no-pixels")) {
        ((PFNGLREADPIXELSPROC)real_address("glReadPixels"))(x, y, width, height, format, type, pixels);
    }
}

EXPORT __eglMustCastToProperFunctionPointerType eglGetProcAddress(const char *name) {
    static const struct {
        const char *name;
        __eglMustCastToProperFunctionPointerType function;
    } wrapped[] = {
        {"eglQueryDevicesEXT", (__eglMustCastToProperFunctionPointerType)query_devices},
        {"eglQueryDeviceStringEXT", (__eglMustCastToProperFunctionPointerType)query_device_string},
        {"eglGetPlatformDisplayEXT", (__eglMustCastToProperFunctionPointerType)get_platform_display},
        {"glGetString", (__eglMustCastToProperFunctionPointerType)get_string},
        {"glGetError", (__eglMustCastToProperFunctionPointerType)get_gl_error},
        {"glReadPixels", (__eglMustCastToProperFunctionPointerType)read_pixels},
    };
    char key[128];
    snprintf(key, sizeof key, "no-function=%s", name);
    if (has_fault(key)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof wrapped / sizeof wrapped[0]; ++i) {
        if (strcmp(wrapped[i].name, name) == 0) {
            return wrapped[i].function;
        }
    }
    return real_address(name);
}
