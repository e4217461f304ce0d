/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "capture.h"
#include "../memory.h"
#include "file.h"
#include "scene_parts.h"

#include <inttypes.h>
#include <string.h>
#include <unistd.h>

static pnb_result check_path(const char *path) {
    return path && path[0] ? PNB_OK : error_set(PNB_ERROR_INVALID_ARGUMENT, "the path of the capture is NULL or empty");
}

static pnb_result check_settings(const pnb_settings *settings) {
    pnb_result result = CHECK_STRUCT(settings, pnb_settings);
    if (result == PNB_OK && settings->value_count > 0 && !settings->values) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_settings.values is NULL, but there are %" PRIu32,
                         settings->value_count);
    }
    for (uint32_t i = 0; result == PNB_OK && i < settings->value_count; i++) {
        if (!settings->values[i].name) {
            return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_settings.values[%" PRIu32 "].name is NULL", i);
        }
    }
    return result;
}

pnb_result pnb_capture_write(const char *path, const pnb_scene *scene, const pnb_settings *settings) {
    pnb_result result = check_path(path);
    if (result == PNB_OK) {
        result = scene_check(scene);
    }
    if (result == PNB_OK) {
        result = check_settings(settings);
    }
    if (result != PNB_OK) {
        return result;
    }
    struct byte_writer writer = {0};
    result = capture_encode(scene, settings, &writer);
    if (result == PNB_OK) {
        result = file_replace(path, writer.data, writer.size);
    }
    memory_free(writer.data);
    return result;
}

/* A file that memory cannot hold is refused before its pages push everything else out. */
static bool fits_into_memory(uint64_t size) {
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    return pages <= 0 || page_size <= 0 || size / (uint64_t)page_size < (uint64_t)pages;
}

static pnb_result unreadable(pnb_result result, const char *path) {
    return error_set(result, "cannot read '%s': %s", path, pnb_last_error());
}

static pnb_result read_file(int descriptor, const char *path, uint64_t size, pnb_capture **capture) {
    unsigned char header[CAPTURE_HEADER_SIZE];
    if (size < sizeof header) {
        return error_set(PNB_ERROR_FILE, "cannot read '%s': it is not a Penumbra capture, or truncated", path);
    }
    pnb_result result = file_read(descriptor, path, header, sizeof header);
    if (result != PNB_OK) {
        return result;
    }
    result = capture_check_header(header, size);
    if (result != PNB_OK) {
        return unreadable(result, path);
    }
    if (!fits_into_memory(size)) {
        return error_set(PNB_ERROR_FILE, "cannot read '%s': its %" PRIu64 " bytes do not fit into memory", path, size);
    }
    unsigned char *data = memory_array((size_t)size, 1);
    if (!data) {
        return unreadable(PNB_ERROR_OUT_OF_MEMORY, path);
    }
    memcpy(data, header, sizeof header);
    result = file_read(descriptor, path, data + sizeof header, (size_t)size - sizeof header);
    if (result == PNB_OK) {
        result = capture_decode(data, (size_t)size, capture);
        result = result == PNB_OK ? PNB_OK : unreadable(result, path);
    }
    memory_free(data);
    return result;
}

pnb_result pnb_capture_read(const char *path, pnb_capture **capture) {
    pnb_result result = check_path(path);
    if (result != PNB_OK) {
        return result;
    }
    if (!capture) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "capture is NULL");
    }
    int descriptor;
    uint64_t size;
    result = file_open(path, &descriptor, &size);
    if (result == PNB_OK) {
        result = read_file(descriptor, path, size, capture);
        close(descriptor);
    }
    return result;
}

const pnb_scene *pnb_capture_scene(const pnb_capture *capture) {
    return capture ? &capture->scene : NULL;
}

const pnb_settings *pnb_capture_settings(const pnb_capture *capture) {
    return capture ? &capture->settings : NULL;
}

void pnb_capture_destroy(pnb_capture **capture) {
    if (!capture || !*capture) {
        return;
    }
    pnb_capture *last = *capture;
    *capture = NULL;
    for (uint32_t i = 0; i < last->mesh_count; i++) {
        pnb_mesh_destroy(&last->meshes[i]);
    }
    for (uint32_t i = 0; i < last->texture_count; i++) {
        pnb_texture_destroy(&last->textures[i]);
    }
    for (uint32_t i = 0; i < last->scene.instance_count; i++) {
        memory_free((char *)last->instances[i].name);
    }
    for (uint32_t i = 0; i < last->scene.light_count; i++) {
        memory_free((char *)last->lights[i].name);
        memory_free((char *)last->lights[i].technique);
    }
    for (uint32_t i = 0; i < last->settings.value_count; i++) {
        memory_free((char *)last->values[i].name);
    }
    void *blocks[] = {last->meshes, last->textures, last->instances, last->materials,
                      last->slots,  last->lights,   last->values,    last->technique};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        memory_free(blocks[i]);
    }
    memory_free(last);
}
