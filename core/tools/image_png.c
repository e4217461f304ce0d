/* SPDX-License-Identifier: GPL-3.0-or-later
 * 8-bit PNG through libpng's simplified interface. */
#include "image.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

static float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

static png_byte encode(float value, enum image_encoding encoding) {
    value = value > 0 ? fminf(value, 1) : 0; /* NaN becomes 0 */
    if (encoding == IMAGE_ENCODE_COLOR)
        value = srgb_encode(value);
    return (png_byte)lrintf(value * 255);
}

/* Pixels are premultiplied, PNG is not. */
static void encode_pixel(const float *from, uint32_t channels, enum image_encoding encoding, png_byte *to) {
    float alpha = channels == 4 ? from[3] : 1;
    float scale = alpha > 0 ? 1 / alpha : 1;
    uint32_t colors = channels < 3 ? 1 : 3;
    for (uint32_t i = 0; i < colors; i++)
        to[i] = encode(from[i] * scale, encoding);
    if (channels == 4)
        to[3] = encode(alpha, IMAGE_ENCODE_RAW);
}

bool image_write_png(const char *path, const struct image *image, enum image_encoding encoding) {
    static const png_uint_32 formats[] = {0, PNG_FORMAT_GRAY, 0, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
    png_image png = {.version = PNG_IMAGE_VERSION, .width = image->width, .height = image->height};
    png.format = formats[image->channels];
    size_t pixels = (size_t)image->width * image->height;
    png_byte *bytes = malloc(pixels * image->channels);
    if (!bytes)
        return tool_error("out of memory for %s", path);
    for (size_t i = 0; i < pixels; i++)
        encode_pixel(image->pixels + i * image->channels, image->channels, encoding, bytes + i * image->channels);
    /* A negative stride: our rows are bottom-up. */
    png_int_32 stride = -(png_int_32)(image->width * image->channels);
    bool good = png_image_write_to_file(&png, path, 0, bytes, stride, NULL) != 0;
    free(bytes);
    return good || tool_error("cannot write %s: %s", path, png.message);
}

bool image_read_png(const char *path, struct image_set *set) {
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&png, path))
        return tool_error("cannot read %s: %s", path, png.message);
    png.format = PNG_FORMAT_LINEAR_RGB_ALPHA;
    struct image *image = image_set_add(set, "", 0, png.width, png.height, 4);
    png_uint_16 *values = malloc(PNG_IMAGE_SIZE(png));
    bool good = image && values && png_image_finish_read(&png, NULL, values, -(png_int_32)(4 * png.width), NULL);
    if (good)
        for (size_t i = 0; i < (size_t)4 * png.width * png.height; i++)
            image->pixels[i] = (float)values[i] / 65535;
    else
        tool_error("cannot read %s: %s", path, png.message[0] ? png.message : "out of memory");
    free(values);
    png_image_free(&png);
    return good;
}
