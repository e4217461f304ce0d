/* SPDX-License-Identifier: GPL-3.0-or-later
 * A libOSMesa.so.8 that passes everything on to the real one, except for the faults of the environment variable
 * FAKE_OSMESA: a list, separated by spaces, of
 *   fail=FUNCTION          OSMesaCreateContextAttribs or OSMesaMakeCurrent fails
 *   no-function=glNAME     OSMesaGetProcAddress gives NULL for it */
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

typedef void (*function_pointer)(void);

EXPORT void *OSMesaCreateContextAttribs(const int *attributes, void *share);
EXPORT unsigned char OSMesaMakeCurrent(void *context, void *buffer, unsigned type, int width, int height);
EXPORT void OSMesaDestroyContext(void *context);
EXPORT function_pointer OSMesaGetProcAddress(const char *name);

static void *real(const char *name) {
    static void *library;
    if (!library) {
        library = dlopen(REAL_OSMESA, RTLD_NOW | RTLD_LOCAL);
    }
    return dlsym(library, name);
}

static bool has_fault(const char *kind, const char *name) {
    const char *list = getenv("FAKE_OSMESA");
    char key[128], padded[1024];
    snprintf(key, sizeof key, " %s=%s ", kind, name);
    snprintf(padded, sizeof padded, " %s ", list ? list : "");
    return strstr(padded, key) != NULL;
}

void *OSMesaCreateContextAttribs(const int *attributes, void *share) {
    void *(*create)(const int *, void *);
    *(void **)&create = real(__func__);
    return has_fault("fail", __func__) ? NULL : create(attributes, share);
}

unsigned char OSMesaMakeCurrent(void *context, void *buffer, unsigned type, int width, int height) {
    unsigned char (*make_current)(void *, void *, unsigned, int, int);
    *(void **)&make_current = real(__func__);
    return context && has_fault("fail", __func__) ? 0 : make_current(context, buffer, type, width, height);
}

void OSMesaDestroyContext(void *context) {
    void (*destroy)(void *);
    *(void **)&destroy = real(__func__);
    destroy(context);
}

function_pointer OSMesaGetProcAddress(const char *name) {
    function_pointer (*get_address)(const char *);
    *(void **)&get_address = real(__func__);
    return has_fault("no-function", name) ? NULL : get_address(name);
}
