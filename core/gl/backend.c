/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

pnb_result backend_choose(const char *name, struct backend_choice *choice) {
    const char *source = "";
    if (!name || !name[0]) {
        source = "environment variable PENUMBRA_BACKEND: ";
        name = getenv("PENUMBRA_BACKEND");
    }
    *choice = (struct backend_choice){.device = -1};
    if (!name || !name[0]) {
        choice->devices = choice->surfaceless = choice->osmesa = true;
    } else if (strcmp(name, "egl") == 0) {
        choice->devices = true;
    } else if (strncmp(name, "egl:", 4) == 0 && strspn(name + 4, "0123456789") == strlen(name + 4) &&
               strlen(name + 4) >= 1 && strlen(name + 4) <= 4) {
        choice->devices = true;
        choice->device = atoi(name + 4);
    } else if (strcmp(name, "surfaceless") == 0) {
        choice->surfaceless = true;
    } else if (strcmp(name, "osmesa") == 0) {
        choice->osmesa = true;
    } else {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "%sunknown backend \"%s\": use egl, egl:N, surfaceless or osmesa",
                         source, name);
    }
    return PNB_OK;
}

struct candidate *ladder_add(struct ladder *ladder, const char *format, ...) {
    struct candidate *candidate = &ladder->candidates[ladder->count++];
    *candidate = (struct candidate){0};
    va_list arguments;
    va_start(arguments, format);
    text_format_list(candidate->name, sizeof candidate->name, format, arguments);
    va_end(arguments);
    return candidate;
}

/* Leaves only the device egl:N, or says that there is none. */
static void keep_device(struct ladder *ladder, int device) {
    char name[BACKEND_NAME_SIZE];
    text_format(name, sizeof name, "egl:%d", device);
    uint32_t found = ladder->count;
    for (uint32_t i = 0; i < ladder->count; ++i) {
        if (strcmp(ladder->candidates[i].name, name) == 0) {
            found = i;
        } else if (ladder->candidates[i].error[0]) {
            return; /* no device at all, and why */
        }
    }
    if (found < ladder->count) {
        ladder->candidates[0] = ladder->candidates[found];
        ladder->count = 1;
        return;
    }
    uint32_t count = ladder->count;
    ladder->count = 0;
    struct candidate *missing = ladder_add(ladder, "%s", name);
    text_format(missing->error, sizeof missing->error, "EGL has %u devices, counted from 0", count);
}

void ladder_list(const struct backend_choice *choice, struct ladder *ladder) {
    ladder->count = 0;
    if (choice->devices) {
        egl_list_devices(ladder);
        if (choice->device >= 0) {
            keep_device(ladder, choice->device);
        }
    }
    if (choice->surfaceless) {
        egl_list_surfaceless(ladder);
    }
    if (choice->osmesa) {
        osmesa_list(ladder);
    }
}

static bool is_software_renderer(const struct gl *gl) {
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer", "SwiftShader"};
    const char *renderer = (const char *)gl->GetString(GL_RENDERER);
    for (size_t i = 0; renderer && i < sizeof names / sizeof names[0]; ++i) {
        if (strstr(renderer, names[i])) {
            return true;
        }
    }
    return false;
}

/* Drivers have been seen that open a context, report no error and draw nothing. */
static pnb_result probe_pixel(const struct gl *gl) {
    /* Values that 8 bits hold exactly, all different. */
    static const GLfloat color[4] = {1.0f, 0.0f, 51.0f / 255.0f, 204.0f / 255.0f};
    static const GLubyte expected[4] = {255, 0, 51, 204};
    GLubyte pixel[4] = {0};
    GLuint texture = 0, framebuffer = 0;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 1, 1);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
    gl->ClearBufferfv(GL_COLOR, 0, color);
    gl->ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->DeleteFramebuffers(1, &framebuffer);
    gl->DeleteTextures(1, &texture);
    pnb_result result = gl_check(gl, "clearing and reading one pixel");
    if (result == PNB_OK && memcmp(pixel, expected, sizeof pixel) != 0) {
        result = error_set(PNB_ERROR_NO_BACKEND, "clearing one pixel to 255 0 51 204 gave %u %u %u %u", pixel[0],
                           pixel[1], pixel[2], pixel[3]);
    }
    return result;
}

pnb_result backend_try(const struct candidate *candidate, const struct context_options *options,
                       struct backend *backend) {
    *backend = (struct backend){0};
    text_format(backend->name, sizeof backend->name, "%s", candidate->name);
    if (candidate->error[0]) {
        return error_set(PNB_ERROR_NO_BACKEND, "%s", candidate->error);
    }
    pnb_result result = candidate->open(candidate, options, backend);
    if (result != PNB_OK) {
        return result;
    }
    result = gl_load(&backend->gl, backend->lookup, backend->state);
    if (result == PNB_OK) {
        result = probe_pixel(&backend->gl);
    }
    if (result != PNB_OK) {
        backend_close(backend);
        return result;
    }
    backend->gl.is_software = is_software_renderer(&backend->gl);
    return PNB_OK;
}

void backend_close(struct backend *backend) {
    if (backend->close) {
        backend->close(backend->state);
    }
    *backend = (struct backend){0};
}

static void report_add(struct backend_report *report, const struct candidate *candidate) {
    char before[ERROR_TEXT_SIZE];
    memcpy(before, report->failures, sizeof before);
    text_format(report->failures, sizeof report->failures, "%s%s%s: %s", before, before[0] ? "; " : "", candidate->name,
                pnb_last_error());
    report->hardware_failed = report->hardware_failed || candidate->is_hardware;
}

/* Bytes of address space in use, or 0. */
static uint64_t used_address_space(void) {
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (fscanf(file, "%lu", &pages) != 1) {
            pages = 0;
        }
        fclose(file);
    }
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

pnb_result backend_check_address_space(uint64_t least) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return PNB_OK;
    }
    uint64_t used = used_address_space();
    uint64_t left = limit.rlim_cur > used ? limit.rlim_cur - used : 0;
    if (left < least) {
        return error_set(PNB_ERROR_OUT_OF_MEMORY,
                         "the limit on address space (ulimit -v) leaves %u MiB of memory, OpenGL needs %u",
                         (unsigned)(left >> 20), (unsigned)(least >> 20));
    }
    return PNB_OK;
}

pnb_result backend_open(const struct backend_choice *choice, const struct context_options *options,
                        struct backend *backend, struct backend_report *report) {
    struct ladder ladder;
    pnb_result result = backend_check_address_space(ADDRESS_SPACE_TO_START);
    if (result != PNB_OK) {
        return result;
    }
    ladder_list(choice, &ladder);
    *report = (struct backend_report){0};
    bool too_old = false;
    for (uint32_t i = 0; i < ladder.count; ++i) {
        result = backend_try(&ladder.candidates[i], options, backend);
        if (result == PNB_OK || result == PNB_ERROR_OUT_OF_MEMORY) {
            return result; /* the next backend would need the memory as well */
        }
        too_old = too_old || result == PNB_ERROR_UNSUPPORTED;
        report_add(report, &ladder.candidates[i]);
    }
    return error_set(too_old ? PNB_ERROR_UNSUPPORTED : PNB_ERROR_NO_BACKEND, "no usable OpenGL: %s", report->failures);
}
