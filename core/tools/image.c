/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct image *image_set_add(struct image_set *set, const char *name, size_t length, uint32_t width, uint32_t height,
                            uint32_t channels) {
    struct image *images = realloc(set->images, (set->count + 1) * sizeof *images);
    if (images)
        set->images = images;
    struct image image = {.name = strndup(name, length), .width = width, .height = height, .channels = channels};
    image.pixels = calloc((size_t)width * height, channels * sizeof *image.pixels);
    if (!images || !image.name || !image.pixels) {
        free(image.name);
        free(image.pixels);
        tool_error("out of memory for an image of %u x %u pixels", width, height);
        return NULL;
    }
    set->images[set->count] = image;
    return &set->images[set->count++];
}

void image_set_free(struct image_set *set) {
    for (uint32_t i = 0; i < set->count; i++) {
        free(set->images[i].name);
        free(set->images[i].pixels);
    }
    free(set->images);
    *set = (struct image_set){0};
}

static bool ends_with_pass(const char *text, const char *name) {
    size_t length = strlen(text), tail = strlen(name);
    return length > tail && text[length - tail - 1] == '.' && strcmp(text + length - tail, name) == 0;
}

const struct image *image_set_get(const struct image_set *set, const char *name) {
    for (uint32_t i = 0; i < set->count; i++)
        if (strcmp(set->images[i].name, name) == 0)
            return &set->images[i];
    return NULL;
}

const struct image *image_set_find(const struct image_set *set, const char *name) {
    const struct image *exact = image_set_get(set, name);
    if (exact)
        return exact;
    for (uint32_t i = 0; i < set->count; i++)
        if (ends_with_pass(set->images[i].name, name))
            return &set->images[i];
    return image_set_get(set, "");
}

void image_set_print_names(const struct image_set *set, FILE *file) {
    for (uint32_t i = 0; i < set->count; i++)
        fprintf(file, "%s%s", i ? ", " : "", set->images[i].name[0] ? set->images[i].name : "(unnamed)");
}

enum image_format image_format_of(const char *path) {
    static const char *const endings[] = {[IMAGE_EXR] = ".exr", [IMAGE_PNG] = ".png", [IMAGE_PFM] = ".pfm"};
    const char *dot = strrchr(path, '.');
    for (int format = IMAGE_EXR; dot && format < IMAGE_UNKNOWN; format++)
        if (strcasecmp(dot, endings[format]) == 0)
            return (enum image_format)format;
    return IMAGE_UNKNOWN;
}

bool image_read(const char *path, struct image_set *set) {
    *set = (struct image_set){0};
    bool good = false;
    switch (image_format_of(path)) {
    case IMAGE_EXR:
        good = image_read_exr(path, set);
        break;
    case IMAGE_PFM:
        good = image_read_pfm(path, set);
        break;
    case IMAGE_PNG:
        good = image_read_png(path, set);
        break;
    case IMAGE_UNKNOWN:
        tool_error("%s: images are .exr, .pfm or .png files", path);
        break;
    }
    if (good && set->count == 0)
        good = tool_error("%s has no channels", path);
    if (!good)
        image_set_free(set);
    return good;
}
