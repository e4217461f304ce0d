/* SPDX-License-Identifier: GPL-3.0-or-later
 * Drivers that are missing, broken or too old: the ladder must go on to the next backend, or say why there is none.
 * Each row runs in a process of its own. */
#include "spawn.h"

#define FAULTY "LD_LIBRARY_PATH=" FAKE_GL_FOLDER "/faulty"
#define EMPTY  "LD_LIBRARY_PATH=" FAKE_GL_FOLDER "/empty"

/* ---- In the new process ------------------------------------------------------------------------------------ */

static int use_library(void) {
    struct log_record log;
    struct small_scene small;
    pnb_context *context = NULL;
    pnb_job *job = NULL;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    pnb_result result = create_logged(NULL, PNB_LOG_INFO, &log, &context);
    printf("create %s\nmessage %s\n", pnb_result_name(result), result == PNB_OK ? "" : pnb_last_error());
    if (result == PNB_OK) {
        pnb_context_get_info(context, &info);
        small_scene_create(&small);
        result = pnb_render(context, small_scene_get(&small), &small.settings, &job);
        printf("backend %s\nrender %s\n", info.backend, pnb_result_name(result));
        pnb_job_destroy(&job);
        small_scene_destroy(&small);
        pnb_context_destroy(&context);
    }
    printf("%slive blocks %lld\n", log.text, (long long)memory_live_blocks());
    return 0;
}

/* ---- Rows -------------------------------------------------------------------------------------------------- */

struct row {
    const char *name;
    struct spawn spawn;
    const char *result;   /* of pnb_context_create */
    const char *parts[4]; /* of what is printed, ended by NULL; "!..." must not be in it */
};

#define ROW_OK(backend)                                                                                                \
    "PNB_OK", {                                                                                                        \
        "backend " backend, "render PNB_OK"                                                                            \
    }
#define ENVIRONMENT(...)                                                                                               \
    {                                                                                                                  \
        .variables = { __VA_ARGS__ }                                                                                   \
    }
#define NO_BACKEND        "PNB_ERROR_NO_BACKEND"
#define UNSUPPORTED       "PNB_ERROR_UNSUPPORTED"
#define NO_OSMESA         "FAKE_OSMESA=fail=OSMesaCreateContextAttribs"
#define FAULT(list)       ENVIRONMENT(FAULTY, "FAKE_EGL=" list)
#define FAULT_ALONE(list) ENVIRONMENT(FAULTY, "FAKE_EGL=" list, NO_OSMESA)

static const struct row rows[] = {
    /* As it is. */
    {"nothing special", ENVIRONMENT(NULL), "PNB_OK", {"render PNB_OK", "3: OpenGL 4."}},
    {"egl", ENVIRONMENT("PENUMBRA_BACKEND=egl"), ROW_OK("egl:")},
    {"egl:0", ENVIRONMENT("PENUMBRA_BACKEND=egl:0"), ROW_OK("egl:0")},
    {"egl:999", ENVIRONMENT("PENUMBRA_BACKEND=egl:999"), NO_BACKEND, {"egl:999: EGL has"}},
    {"surfaceless", ENVIRONMENT("PENUMBRA_BACKEND=surfaceless"), ROW_OK("surfaceless")},
    {"osmesa", ENVIRONMENT("PENUMBRA_BACKEND=osmesa"), ROW_OK("osmesa")},
    {"unknown backend",
     ENVIRONMENT("PENUMBRA_BACKEND=glx"),
     "PNB_ERROR_INVALID_ARGUMENT",
     {"PENUMBRA_BACKEND: unknown backend \"glx\""}},
    {"fakes without a fault", FAULT(""), ROW_OK("egl:0")},
    {"display server that is not there", ENVIRONMENT("DISPLAY=:99", "EGL_PLATFORM=x11"), "PNB_OK", {"render PNB_OK"}},
    {"unusable home and cache",
     ENVIRONMENT("HOME=/nonexistent", "MESA_SHADER_CACHE_DIR=/proc/nonexistent", "XDG_CACHE_HOME=/proc/nonexistent"),
     "PNB_OK",
     {"render PNB_OK"}},
    {"no shader cache", ENVIRONMENT("MESA_SHADER_CACHE_DISABLE=true"), "PNB_OK", {"render PNB_OK"}},
    /* LLVM compiles on our thread's stack, for which this would be too little. */
    {"small stacks", {.variables = {"MESA_SHADER_CACHE_DISABLE=true"}, .stack = 64 << 10}, "PNB_OK", {"render PNB_OK"}},
    {"one llvmpipe thread", ENVIRONMENT("LP_NUM_THREADS=0"), "PNB_OK", {"render PNB_OK"}},
    {"decimal comma", ENVIRONMENT("LC_ALL=de_DE.UTF-8"), "PNB_OK", {"render PNB_OK"}},

    /* Drivers missing. */
    {"no vendor", ENVIRONMENT("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"), ROW_OK("osmesa")},
    {"no vendor, egl",
     ENVIRONMENT("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent", "PENUMBRA_BACKEND=egl"),
     NO_BACKEND,
     {"egl: EGL lacks EGL_EXT_device_enumeration", "egl_vendor.d"}},
    {"no vendor, egl:0",
     ENVIRONMENT("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent", "PENUMBRA_BACKEND=egl:0"),
     NO_BACKEND,
     {"egl: EGL lacks EGL_EXT_device_enumeration", "egl_vendor.d"}},
    {"no vendor, surfaceless",
     ENVIRONMENT("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent", "PENUMBRA_BACKEND=surfaceless"),
     NO_BACKEND,
     {"surfaceless: EGL lacks EGL_MESA_platform_surfaceless"}},
    {"no drivers", ENVIRONMENT("LIBGL_DRIVERS_PATH=/nonexistent"), ROW_OK("osmesa")},
    {"no drivers, egl",
     ENVIRONMENT("LIBGL_DRIVERS_PATH=/nonexistent", "PENUMBRA_BACKEND=egl"),
     NO_BACKEND,
     {"egl:0: eglInitialize failed: EGL_NOT_INITIALIZED (0x3001)"}},
    {"no drivers, surfaceless",
     ENVIRONMENT("LIBGL_DRIVERS_PATH=/nonexistent", "PENUMBRA_BACKEND=surfaceless"),
     NO_BACKEND,
     {"surfaceless: eglInitialize failed: EGL_NOT_INITIALIZED (0x3001)"}},
    {"empty libraries",
     ENVIRONMENT(EMPTY),
     NO_BACKEND,
     {"egl: libEGL.so.1 lacks eglBindAPI", "surfaceless: libEGL.so.1 lacks", "osmesa: libOSMesa is too old"}},

    /* OpenGL too old. */
    {"softpipe", ENVIRONMENT("GALLIUM_DRIVER=softpipe"), UNSUPPORTED, {"needs OpenGL 4.3, found 3.3", "osmesa: needs"}},
    {"OpenGL 2.1", ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=2.1"), UNSUPPORTED, {"needs OpenGL 4.3, found 2.1"}},
    {"OpenGL 3.3", ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=3.3"), UNSUPPORTED, {"needs OpenGL 4.3, found 3.3"}},
    {"OpenGL 4.2", ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=4.2"), UNSUPPORTED, {"needs OpenGL 4.3, found 4.2"}},
    {"OpenGL 4.2, osmesa",
     ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=4.2", "PENUMBRA_BACKEND=osmesa"),
     UNSUPPORTED,
     {"osmesa: needs OpenGL 4.3, found 4.2"}},
    {"OpenGL 4.3", ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=4.3"), "PNB_OK", {"OpenGL 4.3", "render PNB_OK"}},
    {"OpenGL 4.3, osmesa",
     ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=4.3", "PENUMBRA_BACKEND=osmesa"),
     "PNB_OK",
     {"OpenGL 4.3", "render PNB_OK"}},
    {"OpenGL 4.6", ENVIRONMENT("MESA_GL_VERSION_OVERRIDE=4.6"), "PNB_OK", {"OpenGL 4.6", "render PNB_OK"}},
    {"no compute shaders",
     ENVIRONMENT("MESA_EXTENSION_OVERRIDE=-GL_ARB_compute_shader"),
     UNSUPPORTED,
     {"needs OpenGL 4.3, found 4.2"}},
    {"OpenGL ES", FAULT_ALONE("gl-version=OpenGL_ES_3.2_Mesa"), UNSUPPORTED, {"found OpenGL ES 3.2 Mesa"}},
    {"garbled version", FAULT("gl-version=unknown"), ROW_OK("osmesa")},

    /* Extensions that are not there. */
    {"no device platform", FAULT("hide=EGL_EXT_platform_device"), ROW_OK("surfaceless")},
    {"no device enumeration, but device_base", FAULT("hide=EGL_EXT_device_enumeration"), ROW_OK("egl:0")},
    {"no way to list devices", FAULT("hide=EGL_EXT_device_enumeration hide=EGL_EXT_device_base"),
     ROW_OK("surfaceless")},
    {"no way to ask devices", FAULT("hide=EGL_EXT_device_query hide=EGL_EXT_device_base"), ROW_OK("egl:0")},
    {"no surfaceless platform", FAULT("no-devices hide=EGL_MESA_platform_surfaceless"), ROW_OK("osmesa")},
    {"no platforms", FAULT_ALONE("hide=EGL_EXT_platform_base"), NO_BACKEND, {"EGL lacks EGL_EXT_platform_base"}},
    {"no create_context extension", FAULT("hide=EGL_KHR_create_context"), ROW_OK("egl:0")},
    {"no client extensions",
     FAULT_ALONE("fail=eglQueryString:3008"),
     NO_BACKEND,
     {"EGL lacks EGL_EXT_device_enumeration", "EGL lacks EGL_MESA_platform_surfaceless"}},
    {"no robustness", FAULT("hide=EGL_EXT_create_context_robustness"), ROW_OK("egl:0")},

    /* Devices. */
    {"no devices", FAULT("no-devices"), ROW_OK("surfaceless")},
    {"a graphics device that fails",
     FAULT("hardware"),
     "PNB_OK",
     {"backend egl:1", "2: rendering on the CPU, because a graphics device failed: egl:0: eglGetPlatformDisplayEXT "
                       "failed: EGL_BAD_ACCESS (0x3002)"}},
    {"only that device",
     ENVIRONMENT(FAULTY, "FAKE_EGL=hardware", "PENUMBRA_BACKEND=egl:0"),
     NO_BACKEND,
     {"EGL_BAD_ACCESS (0x3002)", "!egl:1"}},
    {"only the other device",
     ENVIRONMENT(FAULTY, "FAKE_EGL=hardware", "PENUMBRA_BACKEND=egl:1"),
     "PNB_OK",
     {"backend egl:1", "!2: "}},
    {"software alone is no warning", FAULT("no-devices"), "PNB_OK", {"backend surfaceless", "!2: "}},

    /* Surfaces and configs. */
    {"needs a surface", FAULT("surface"), ROW_OK("egl:0")},
    {"needs a surface and has none", FAULT("surface fail=eglCreatePbufferSurface:3003"), ROW_OK("osmesa")},
    {"needs a surface and has none, alone",
     FAULT_ALONE("surface fail=eglCreatePbufferSurface:3003"),
     NO_BACKEND,
     {"eglCreatePbufferSurface failed: EGL_BAD_ALLOC (0x3003)"}},
    {"no configs", FAULT("no-configs"), ROW_OK("egl:0")},
    {"no configs, and none needed is not allowed", FAULT("no-configs hide=EGL_KHR_no_config_context"),
     ROW_OK("osmesa")},
    {"no configs, but a surface needed", FAULT("no-configs surface"), ROW_OK("osmesa")},
    {"failing configs", FAULT("fail=eglChooseConfig:3004"), ROW_OK("egl:0")},

    /* Functions of OpenGL, and what they do. */
    {"no glDispatchCompute",
     FAULT_ALONE("no-function=glDispatchCompute"),
     UNSUPPORTED,
     {"egl:0: OpenGL lacks glDispatchCompute"}},
    {"no glGetString", FAULT_ALONE("no-function=glGetString"), UNSUPPORTED, {"OpenGL lacks glGetString"}},
    {"no glGetGraphicsResetStatus", FAULT("no-function=glGetGraphicsResetStatus"), ROW_OK("egl:0")},
    {"pixels that are never written",
     FAULT_ALONE("no-pixels"),
     NO_BACKEND,
     {"egl:0: clearing one pixel to 255 0 51 204 gave 0 0 0 0"}},
    {"pixels that are never written, then OSMesa", FAULT("no-pixels"), ROW_OK("osmesa")},
    {"OSMesa without a function",
     ENVIRONMENT(FAULTY, "FAKE_OSMESA=no-function=glViewport", "PENUMBRA_BACKEND=osmesa"),
     UNSUPPORTED,
     {"osmesa: OpenGL lacks glViewport"}},
    {"OSMesa cannot be created",
     ENVIRONMENT(FAULTY, NO_OSMESA, "PENUMBRA_BACKEND=osmesa"),
     NO_BACKEND,
     {"osmesa: OSMesaCreateContextAttribs failed"}},
    {"OSMesa cannot be made current",
     ENVIRONMENT(FAULTY, "FAKE_OSMESA=fail=OSMesaMakeCurrent", "PENUMBRA_BACKEND=osmesa"),
     NO_BACKEND,
     {"osmesa: OSMesaMakeCurrent failed"}},
};

static void check_row(const struct row *row) {
    char output[8192], expected[64];
    int before = checks_failed, status = spawn_self(&row->spawn, output, sizeof output);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    snprintf(expected, sizeof expected, "create %s\n", row->result);
    CHECK_CONTAINS(output, expected);
    for (int i = 0; i < 4 && row->parts[i]; ++i) {
        if (row->parts[i][0] == '!') {
            CHECK(!strstr(output, row->parts[i] + 1));
        } else {
            CHECK_CONTAINS(output, row->parts[i]);
        }
    }
    CHECK_CONTAINS(output, "live blocks 0\n");
    if (checks_failed > before) {
        printf("in \"%s\", status %#x:\n%s", row->name, (unsigned)status, output);
    }
}

/* ---- Every EGL function in turn ---------------------------------------------------------------------------- */

static const struct {
    const char *name, *text;
} egl_errors[] = {{"3000", "EGL_SUCCESS (0x3000)"},       {"3001", "EGL_NOT_INITIALIZED (0x3001)"},
                  {"3002", "EGL_BAD_ACCESS (0x3002)"},    {"3003", "EGL_BAD_ALLOC (0x3003)"},
                  {"3008", "EGL_BAD_DISPLAY (0x3008)"},   {"3009", "EGL_BAD_MATCH (0x3009)"},
                  {"300c", "EGL_BAD_PARAMETER (0x300c)"}, {"31ff", "unknown error (0x31ff)"}};

static void each_function_fails(void) {
    static const char *const functions[] = {"eglGetPlatformDisplayEXT", "eglInitialize", "eglBindAPI",
                                            "eglCreateContext", "eglMakeCurrent"};
    for (size_t f = 0; f < sizeof functions / sizeof functions[0]; ++f) {
        for (size_t e = 0; e < sizeof egl_errors / sizeof egl_errors[0]; ++e) {
            char fault[128], message[128];
            snprintf(fault, sizeof fault, "FAKE_EGL=fail=%s:%s", functions[f], egl_errors[e].name);
            snprintf(message, sizeof message, "failed: %s", egl_errors[e].text);
            struct row alone = {
                functions[f],
                {.argument = "use", .variables = {FAULTY, fault, NO_OSMESA}},
                NO_BACKEND,
                {functions[f], message, "surfaceless: egl", "osmesa: OSMesaCreateContextAttribs failed"}};
            check_row(&alone);
        }
        char fault[128];
        snprintf(fault, sizeof fault, "FAKE_EGL=fail=%s:3001", functions[f]);
        struct row next = {functions[f], {.argument = "use", .variables = {FAULTY, fault}}, ROW_OK("osmesa")};
        check_row(&next);
    }
}

/* However little memory there is: an error, or an image. */
static void any_address_space(void) {
    char output[8192];
    int refused = 0, rendered = 0;
    for (rlim_t megabytes = 150; megabytes <= 1500; megabytes += 75) {
        struct spawn spawn = {.argument = "use", .address_space = megabytes << 20};
        int status = spawn_self(&spawn, output, sizeof output);
        bool is_refused = strstr(output, "create PNB_ERROR_OUT_OF_MEMORY\nmessage the limit on address space") != NULL;
        bool is_rendered = strstr(output, "render PNB_OK") != NULL;
        refused += is_refused;
        rendered += is_rendered;
        if (!CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0 && (is_refused || is_rendered))) {
            printf("with %lu MiB, status %#x:\n%s", (unsigned long)megabytes, (unsigned)status, output);
        }
    }
    printf("limits on address space: %d refused, %d rendered\n", refused, rendered);
    CHECK(refused > 0 && rendered > 0);
}

int main(int argc, char **argv) {
    (void)argv;
    if (argc > 1) {
        return use_library();
    }
    size_t count = sizeof rows / sizeof rows[0];
    for (size_t i = 0; i < count; ++i) {
        struct row row = rows[i];
        row.spawn.argument = "use";
        check_row(&row);
    }
    each_function_fails();
    if (!UNDER_ADDRESS_SANITIZER) { /* which needs terabytes of it */
        any_address_space();
    }
    printf("%zu rows and every EGL function in turn\n", count);
    return check_report();
}
