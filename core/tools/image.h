/* SPDX-License-Identifier: GPL-3.0-or-later
 * Float images and the files they are kept in. */
#ifndef IMAGE_H
#define IMAGE_H

#include "tool.h"

/* One pass. Pixels are linear, tightly packed, rows bottom-up. */
struct image {
    char *name; /* pass; "" in files that do not name it */
    uint32_t width, height, channels;
    float *pixels;
};

/* The passes of one file. */
struct image_set {
    struct image *images;
    uint32_t count;
};

/* A new image of zeros at the end of the set, or NULL (out of memory, reported). `length` bytes of `name` are used. */
struct image *image_set_add(struct image_set *set, const char *name, size_t length, uint32_t width, uint32_t height,
                            uint32_t channels);
void image_set_free(struct image_set *set);
/* The pass of exactly that name, or NULL. */
const struct image *image_set_get(const struct image_set *set, const char *name);
/* The pass of that name: the exact name, else one that ends with ".<name>" (Blender puts the view layer's name
 * first), else the pass without a name. NULL if there is none. */
const struct image *image_set_find(const struct image_set *set, const char *name);
/* Prints the names of the passes, separated by commas. */
void image_set_print_names(const struct image_set *set, FILE *file);

enum image_format { IMAGE_EXR, IMAGE_PNG, IMAGE_PFM, IMAGE_UNKNOWN };
/* By the ending of the name. */
enum image_format image_format_of(const char *path);

/* Reads an EXR (scanlines; float, half or uint), PFM or PNG file. Failures are reported. */
bool image_read(const char *path, struct image_set *set);

/* Writers of one format, to exactly this path. Failures are reported. */
bool image_write_exr(const char *path, const struct image_set *set);
bool image_write_pfm(const char *path, const struct image *image);

/* How values become the 0..1 of a PNG. */
enum image_encoding {
    IMAGE_ENCODE_COLOR, /* linear, to be shown: sRGB */
    IMAGE_ENCODE_RAW    /* as they are */
};
bool image_write_png(const char *path, const struct image *image, enum image_encoding encoding);

/* Readers of one format. Failures are reported. */
bool image_read_exr(const char *path, struct image_set *set);
bool image_read_pfm(const char *path, struct image_set *set);
bool image_read_png(const char *path, struct image_set *set);

#endif
