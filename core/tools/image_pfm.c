/* SPDX-License-Identifier: GPL-3.0-or-later
 * Portable float map: a text header, then rows bottom-up. A negative scale means little-endian. */
#include "image.h"

#include <errno.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "floats are read and written as they lie in memory");

/* Far more than any image; keeps sizes in range. */
#define MAX_SIDE 65536u

bool image_write_pfm(const char *path, const struct image *image) {
    FILE *file = fopen(path, "wb");
    if (!file)
        return tool_error("cannot write %s: %s", path, strerror(errno));
    uint32_t channels = image->channels < 3 ? 1 : 3;
    size_t pixels = (size_t)image->width * image->height, written = 0;
    fprintf(file, "%s\n%u %u\n-1.0\n", channels == 3 ? "PF" : "Pf", image->width, image->height);
    for (size_t i = 0; i < pixels; i++)
        written += fwrite(image->pixels + i * image->channels, sizeof(float), channels, file);
    bool good = fclose(file) == 0 && written == pixels * channels;
    return good || tool_error("cannot write %s: %s", path, strerror(errno));
}

static bool read_pixels(FILE *file, const char *path, struct image_set *set) {
    char kind = 0;
    uint32_t width, height;
    float scale;
    if (fscanf(file, "P%c %u %u %f", &kind, &width, &height, &scale) != 4 || fgetc(file) == EOF ||
        (kind != 'F' && kind != 'f') || !width || !height || width > MAX_SIDE || height > MAX_SIDE)
        return tool_error("%s is not a portable float map", path);
    if (scale >= 0)
        return tool_error("%s: big-endian float maps are not supported", path);
    struct image *image = image_set_add(set, "", 0, width, height, kind == 'F' ? 3 : 1);
    if (!image)
        return false;
    size_t floats = (size_t)width * height * image->channels;
    return fread(image->pixels, sizeof(float), floats, file) == floats || tool_error("%s is truncated", path);
}

bool image_read_pfm(const char *path, struct image_set *set) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return tool_error("cannot read %s: %s", path, strerror(errno));
    bool good = read_pixels(file, path, set);
    fclose(file);
    return good;
}
