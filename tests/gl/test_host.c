/* SPDX-License-Identifier: GPL-3.0-or-later
 * A host with an OpenGL context of its own on the main thread: rendering must leave it current, unchanged and working,
 * and its ending EGL must not take the library down. */
#include "support.h"

#include <dlfcn.h>

#define EGL_EGL_PROTOTYPES             0
#define EGL_NO_PLATFORM_SPECIFIC_TYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

/* X(type, name) */
#define HOST_EGL(X)                                                                                                    \
    X(PFNEGLBINDAPIPROC, BindAPI)                                                                                      \
    X(PFNEGLCHOOSECONFIGPROC, ChooseConfig)                                                                            \
    X(PFNEGLCREATECONTEXTPROC, CreateContext)                                                                          \
    X(PFNEGLCREATEPBUFFERSURFACEPROC, CreatePbufferSurface)                                                            \
    X(PFNEGLDESTROYCONTEXTPROC, DestroyContext)                                                                        \
    X(PFNEGLDESTROYSURFACEPROC, DestroySurface)                                                                        \
    X(PFNEGLGETCURRENTCONTEXTPROC, GetCurrentContext)                                                                  \
    X(PFNEGLGETCURRENTDISPLAYPROC, GetCurrentDisplay)                                                                  \
    X(PFNEGLGETCURRENTSURFACEPROC, GetCurrentSurface)                                                                  \
    X(PFNEGLGETERRORPROC, GetError)                                                                                    \
    X(PFNEGLGETPROCADDRESSPROC, GetProcAddress)                                                                        \
    X(PFNEGLINITIALIZEPROC, Initialize)                                                                                \
    X(PFNEGLMAKECURRENTPROC, MakeCurrent)                                                                              \
    X(PFNEGLQUERYAPIPROC, QueryAPI)                                                                                    \
    X(PFNEGLTERMINATEPROC, Terminate)

#define HOST_GL(X)                                                                                                     \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                                                                                 \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                                                                       \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                                                                               \
    X(PFNGLBLENDFUNCPROC, BlendFunc)                                                                                   \
    X(PFNGLCLEARCOLORPROC, ClearColor)                                                                                 \
    X(PFNGLCLEARPROC, Clear)                                                                                           \
    X(PFNGLENABLEPROC, Enable)                                                                                         \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                                                                 \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                                                               \
    X(PFNGLGETERRORPROC, GetError)                                                                                     \
    X(PFNGLGETFLOATVPROC, GetFloatv)                                                                                   \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                                                               \
    X(PFNGLGETSTRINGPROC, GetString)                                                                                   \
    X(PFNGLISTEXTUREPROC, IsTexture)                                                                                   \
    X(PFNGLREADPIXELSPROC, ReadPixels)                                                                                 \
    X(PFNGLVIEWPORTPROC, Viewport)

#define DECLARE(type, name) static type host_##name;
HOST_EGL(DECLARE)
#undef DECLARE
#define DECLARE(type, name) static type gl_##name;
HOST_GL(DECLARE)
#undef DECLARE

struct host {
    EGLDisplay display;
    EGLContext context;
    EGLSurface surface;
};

/* Everything the library could have disturbed, as the host sees it. */
struct host_state {
    EGLContext context;
    EGLDisplay display;
    EGLSurface surface;
    EGLenum api;
    GLint integers[12];
    GLfloat clear_color[4];
};

static bool host_open(struct host *host) {
    void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        return false;
    }
#define LOAD(type, name) *(void **)&host_##name = dlsym(library, "egl" #name);
    HOST_EGL(LOAD)
#undef LOAD
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)host_GetProcAddress("eglGetPlatformDisplayEXT");
    host->display =
        get_display ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    if (!host->display || !host_Initialize(host->display, NULL, NULL)) {
        return false;
    }
    static const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RED_SIZE, 8, EGL_BLUE_SIZE, 8,
                                               EGL_NONE};
    static const EGLint surface_attributes[] = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    host_BindAPI(EGL_OPENGL_API);
    host_ChooseConfig(host->display, config_attributes, &config, 1, &count);
    host->context = host_CreateContext(host->display, config, EGL_NO_CONTEXT, NULL);
    host->surface = host_CreatePbufferSurface(host->display, config, surface_attributes);
    if (!host_MakeCurrent(host->display, host->surface, host->surface, host->context)) {
        return false;
    }
#define LOAD(type, name) gl_##name = (type)host_GetProcAddress("gl" #name);
    HOST_GL(LOAD)
#undef LOAD
    return true;
}

static void host_change_state(void) {
    GLuint texture, buffer;
    gl_GenTextures(1, &texture);
    gl_BindTexture(GL_TEXTURE_2D, texture);
    gl_GenBuffers(1, &buffer);
    gl_BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_ClearColor(0.25f, 0.5f, 0.75f, 1.0f);
    gl_Viewport(1, 2, 3, 4);
    gl_Enable(GL_BLEND);
    gl_BlendFunc(GL_DST_COLOR, GL_ONE_MINUS_SRC_ALPHA);
}

static struct host_state host_read_state(void) {
    static const GLenum names[] = {GL_TEXTURE_BINDING_2D, GL_ARRAY_BUFFER_BINDING, GL_BLEND,
                                   GL_BLEND_SRC_RGB,      GL_BLEND_DST_RGB,        GL_DRAW_FRAMEBUFFER_BINDING,
                                   GL_CURRENT_PROGRAM,    GL_PACK_ALIGNMENT,       GL_DEPTH_TEST};
    struct host_state state;
    memset(&state, 0, sizeof state);
    state.context = host_GetCurrentContext();
    state.display = host_GetCurrentDisplay();
    state.surface = host_GetCurrentSurface(EGL_DRAW);
    state.api = host_QueryAPI();
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        gl_GetIntegerv(names[i], &state.integers[i]);
    }
    gl_GetFloatv(GL_COLOR_CLEAR_VALUE, state.clear_color);
    return state;
}

static void host_still_draws(void) {
    GLubyte pixel[4] = {0};
    gl_Clear(GL_COLOR_BUFFER_BIT);
    gl_ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    /* 0.25, 0.5 and 0.75 of 255, rounded either way. */
    CHECK_NEAR(pixel[0], 63.75, 1);
    CHECK_NEAR(pixel[1], 127.5, 1);
    CHECK_NEAR(pixel[2], 191.25, 1);
    CHECK_INT(gl_GetError(), GL_NO_ERROR);
}

static void host_is_untouched(const char *backend) {
    struct small_scene small;
    pnb_context *context = NULL;
    pnb_job *job = NULL;
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    struct host_state before = host_read_state();
    CHECK_INT(gl_GetError(), GL_NO_ERROR);
    CHECK_RESULT(create_context(backend, &context), PNB_OK);
    for (int i = 0; i < 3; ++i) {
        CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_OK);
        pnb_job_destroy(&job);
    }
    struct host_state during = host_read_state();
    CHECK(memcmp(&before, &during, sizeof before) == 0);
    host_still_draws();
    pnb_context_destroy(&context);
    struct host_state after = host_read_state();
    CHECK(memcmp(&before, &after, sizeof before) == 0);
    CHECK_INT(host_GetError(), EGL_SUCCESS);
    CHECK_INT(gl_GetError(), GL_NO_ERROR);
    host_still_draws();
    small_scene_destroy(&small);
    printf("%s: the host's context is untouched\n", backend);
}

/* All of a process share one EGLDisplay: a host that terminates it must not crash the library. */
static void survives_foreign_terminate(struct host *host) {
    struct small_scene small;
    pnb_context *context = NULL, *fresh = NULL;
    pnb_job *job = NULL;
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    CHECK_RESULT(create_context("surfaceless", &context), PNB_OK);
    host_MakeCurrent(host->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    host_DestroyContext(host->display, host->context);
    host_DestroySurface(host->display, host->surface);
    CHECK(host_Terminate(host->display));
    pnb_result result = pnb_render(context, small_scene_get(&small), &small.settings, &job);
    printf("render after a foreign eglTerminate: %s\n", pnb_result_name(result));
    CHECK(result == PNB_OK || result == PNB_ERROR_CONTEXT_LOST);
    pnb_job_destroy(&job);
    CHECK_RESULT(create_context("surfaceless", &fresh), PNB_OK);
    CHECK_RESULT(pnb_render(fresh, small_scene_get(&small), &small.settings, &job), PNB_OK);
    pnb_job_destroy(&job);
    pnb_context_destroy(&context);
    pnb_context_destroy(&fresh);
    small_scene_destroy(&small);
}

int main(void) {
    struct host host;
    if (!host_open(&host)) {
        printf("skipped: no EGL surfaceless platform for the host's context\n");
        return CHECK_SKIPPED;
    }
    host_change_state();
    for (int i = 0; i < BACKEND_KINDS; ++i) {
        if (backend_works(backend_kinds[i])) {
            host_is_untouched(backend_kinds[i]);
        }
    }
    survives_foreign_terminate(&host);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
