/* SPDX-License-Identifier: GPL-3.0-or-later
 * OpenEXR scanline files through the OpenEXRCore C interface. Channel "<pass>.<letter>" belongs to pass "<pass>". */
#include "image.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIDE 65536

/* Last message of OpenEXR; its handler has no other way out for files that do not open. */
static char last_message[512];

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context;
    (void)code;
    snprintf(last_message, sizeof last_message, "%s", message);
}

static exr_context_initializer_t initializer(void) {
    exr_context_initializer_t initial = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initial.error_handler_fn = keep_message;
    last_message[0] = 0;
    return initial;
}

static bool failed(const char *path, exr_result_t result) {
    return tool_error("%s: %s", path, last_message[0] ? last_message : exr_get_default_error_message(result));
}

/* Lines of one chunk of every channel as planar floats, top line first. */
struct planes {
    float *values;
    size_t plane; /* floats per channel */
};

static bool planes_create(struct planes *planes, int channels, int width, int lines) {
    planes->plane = (size_t)width * (size_t)lines;
    planes->values = calloc(planes->plane * (size_t)channels, sizeof(float));
    return planes->values || tool_error("out of memory");
}

static void describe_plane(exr_coding_channel_info_t *channel, int width) {
    channel->user_bytes_per_element = sizeof(float);
    channel->user_data_type = EXR_PIXEL_FLOAT;
    channel->user_pixel_stride = sizeof(float);
    channel->user_line_stride = (int32_t)sizeof(float) * width;
}

/* ---- Where a channel lies in a set of images ---- */

struct channel_place {
    uint32_t image, channel;
};

static const char *channel_letters(const struct image *image) {
    if (image->channels == 1)
        return strcmp(image->name, "Depth") == 0 ? "Z" : "V";
    return strcmp(image->name, "Normal") == 0 ? "XYZ" : "RGBA";
}

/* Copies line `y` (from the top) between a plane's line and one channel of an image. */
static void line_from_image(const struct image *image, uint32_t channel, uint32_t y, float *line) {
    const float *row = image->pixels + (size_t)(image->height - 1 - y) * image->width * image->channels + channel;
    for (uint32_t x = 0; x < image->width; x++)
        line[x] = row[(size_t)x * image->channels];
}

static void line_to_image(const struct image *image, uint32_t channel, uint32_t y, const float *line) {
    float *row = image->pixels + (size_t)(image->height - 1 - y) * image->width * image->channels + channel;
    for (uint32_t x = 0; x < image->width; x++)
        row[(size_t)x * image->channels] = line[x];
}

/* ---- Writing ---- */

static exr_result_t add_channels(exr_context_t file, int part, const struct image_set *set) {
    exr_result_t result = EXR_ERR_SUCCESS;
    for (uint32_t i = 0; i < set->count; i++) {
        for (uint32_t c = 0; c < set->images[i].channels && result == EXR_ERR_SUCCESS; c++) {
            char name[256];
            snprintf(name, sizeof name, "%s.%c", set->images[i].name, channel_letters(&set->images[i])[c]);
            result = exr_add_channel(file, part, name, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
        }
    }
    return result;
}

/* The place of a channel that add_channels made. */
static struct channel_place written_place(const struct image_set *set, const char *name) {
    const char *dot = strrchr(name, '.');
    size_t length = (size_t)(dot - name);
    struct channel_place place = {0};
    while (strncmp(set->images[place.image].name, name, length) != 0 || set->images[place.image].name[length])
        place.image++;
    const char *letters = channel_letters(&set->images[place.image]);
    place.channel = (uint32_t)(strchr(letters, dot[1]) - letters);
    return place;
}

static void fill_chunk(exr_encode_pipeline_t *encode, const struct image_set *set, const struct planes *planes) {
    for (int i = 0; i < encode->channel_count; i++) {
        exr_coding_channel_info_t *channel = &encode->channels[i];
        struct channel_place place = written_place(set, channel->channel_name);
        float *plane = planes->values + planes->plane * (size_t)i;
        for (int line = 0; line < encode->chunk.height; line++)
            line_from_image(&set->images[place.image], place.channel, (uint32_t)(encode->chunk.start_y + line),
                            plane + (size_t)line * (size_t)channel->width);
        describe_plane(channel, channel->width);
        channel->encode_from_ptr = (const uint8_t *)plane;
    }
}

static exr_result_t write_chunks(exr_context_t file, int part, const struct image_set *set, const struct planes *planes,
                                 int lines) {
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    int height = (int)set->images[0].height;
    for (int y = 0; y < height && result == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(file, part, y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = y == 0 ? exr_encoding_initialize(file, part, &chunk, &encode)
                            : exr_encoding_update(file, part, &chunk, &encode);
        if (result != EXR_ERR_SUCCESS)
            break;
        fill_chunk(&encode, set, planes);
        if (y == 0)
            result = exr_encoding_choose_default_routines(file, part, &encode);
        if (result == EXR_ERR_SUCCESS)
            result = exr_encoding_run(file, part, &encode);
    }
    exr_encoding_destroy(file, &encode);
    return result;
}

static exr_result_t write_part(exr_context_t file, const struct image_set *set) {
    int width = (int)set->images[0].width, height = (int)set->images[0].height;
    int part = 0, lines = 0, channels = 0;
    for (uint32_t i = 0; i < set->count; i++)
        channels += (int)set->images[i].channels;
    exr_set_longname_support(file, 1);
    exr_result_t result = exr_add_part(file, "penumbra", EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(file, part, width, height, EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS)
        result = add_channels(file, part, set);
    if (result == EXR_ERR_SUCCESS)
        result = exr_write_header(file);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_scanlines_per_chunk(file, part, &lines);
    struct planes planes;
    if (result == EXR_ERR_SUCCESS) {
        if (!planes_create(&planes, channels, width, lines))
            return EXR_ERR_OUT_OF_MEMORY;
        result = write_chunks(file, part, set, &planes, lines);
        free(planes.values);
    }
    return result;
}

bool image_write_exr(const char *path, const struct image_set *set) {
    exr_context_initializer_t initial = initializer();
    exr_context_t file = NULL;
    exr_result_t result = exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &initial);
    if (result == EXR_ERR_SUCCESS) {
        result = write_part(file, set);
        exr_result_t finished = exr_finish(&file);
        if (result == EXR_ERR_SUCCESS)
            result = finished;
    }
    return result == EXR_ERR_SUCCESS || failed(path, result);
}

/* ---- Reading ---- */

/* Length of the pass's name in a channel's name. A plain file has none, and its depth is "Z". */
static size_t pass_length(const char *name) {
    const char *dot = strrchr(name, '.');
    return dot ? (size_t)(dot - name) : 0;
}

static bool same_pass(const char *a, const char *b) {
    size_t length = pass_length(a);
    if (length != pass_length(b) || strncmp(a, b, length) != 0)
        return false;
    return length > 0 || (strcmp(a, "Z") == 0) == (strcmp(b, "Z") == 0);
}

/* Channels are kept in alphabetical order; this is the order they are meant in. */
static int channel_rank(const char *name) {
    size_t length = pass_length(name);
    const char *letter = length ? name + length + 1 : name;
    static const char *const ranks[] = {"RXU", "GYV", "BZ", "AW"};
    for (int rank = 0; letter[0] && !letter[1] && rank < 4; rank++)
        if (strchr(ranks[rank], letter[0]))
            return rank;
    return 4;
}

/* Adds the images of a part and finds the place of each of its channels. */
static bool add_images(struct image_set *set, const exr_attr_chlist_t *list, uint32_t width, uint32_t height,
                       struct channel_place *places) {
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        uint32_t before = 0, channels = 0;
        int first = i;
        for (int j = list->num_channels - 1; j >= 0; j--) {
            const char *other = list->entries[j].name.str;
            if (!same_pass(name, other))
                continue;
            first = j;
            channels++;
            int order = channel_rank(other) - channel_rank(name);
            before += order < 0 || (order == 0 && j < i);
        }
        if (first == i) {
            size_t length = pass_length(name);
            bool plain_depth = strcmp(name, "Z") == 0;
            if (!image_set_add(set, plain_depth ? "Depth" : name, plain_depth ? 5 : length, width, height, channels))
                return false;
            places[i].image = set->count - 1;
        } else {
            places[i].image = places[first].image;
        }
        places[i].channel = before;
    }
    return true;
}

static exr_result_t read_chunk(exr_context_t file, int part, int y, exr_decode_pipeline_t *decode,
                               const struct planes *planes, bool first) {
    exr_chunk_info_t chunk;
    exr_result_t result = exr_read_scanline_chunk_info(file, part, y, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = first ? exr_decoding_initialize(file, part, &chunk, decode)
                       : exr_decoding_update(file, part, &chunk, decode);
    if (result != EXR_ERR_SUCCESS)
        return result;
    for (int i = 0; i < decode->channel_count; i++) {
        describe_plane(&decode->channels[i], chunk.width);
        decode->channels[i].decode_to_ptr = (uint8_t *)(planes->values + planes->plane * (size_t)i);
    }
    if (first)
        result = exr_decoding_choose_default_routines(file, part, decode);
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(file, part, decode) : result;
}

static exr_result_t read_chunks(exr_context_t file, int part, const exr_attr_box2i_t *window, int lines,
                                const struct image_set *set, const struct channel_place *places,
                                const struct planes *planes) {
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = window->min.y; y <= window->max.y && result == EXR_ERR_SUCCESS; y += lines) {
        result = read_chunk(file, part, y, &decode, planes, y == window->min.y);
        for (int i = 0; result == EXR_ERR_SUCCESS && i < decode.channel_count; i++)
            for (int line = 0; line < decode.chunk.height; line++)
                line_to_image(&set->images[places[i].image], places[i].channel, (uint32_t)(y - window->min.y + line),
                              planes->values + planes->plane * (size_t)i + (size_t)line * (size_t)decode.chunk.width);
    }
    exr_decoding_destroy(file, &decode);
    return result;
}

static bool check_part(const char *path, exr_storage_t storage, const exr_attr_box2i_t *window,
                       const exr_attr_chlist_t *list) {
    int64_t width = (int64_t)window->max.x - window->min.x + 1, height = (int64_t)window->max.y - window->min.y + 1;
    if (storage != EXR_STORAGE_SCANLINE)
        return tool_error("%s: only scanline images can be read, not tiled or deep ones", path);
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE)
        return tool_error("%s: an image of %lld x %lld pixels cannot be read", path, (long long)width,
                          (long long)height);
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return tool_error("%s: channel %s is subsampled", path, list->entries[i].name.str);
    return true;
}

static bool read_part(exr_context_t file, int part, const char *path, struct image_set *set) {
    exr_storage_t storage;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *list;
    int lines;
    exr_result_t result = exr_get_storage(file, part, &storage);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_data_window(file, part, &window);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_channels(file, part, &list);
    if (result != EXR_ERR_SUCCESS)
        return failed(path, result);
    if (!check_part(path, storage, &window, list))
        return false;
    result = exr_get_scanlines_per_chunk(file, part, &lines);
    if (result != EXR_ERR_SUCCESS)
        return failed(path, result);
    int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    struct channel_place *places = calloc((size_t)list->num_channels + 1, sizeof *places);
    struct planes planes = {0};
    bool good = places && planes_create(&planes, list->num_channels, width, lines) &&
                add_images(set, list, (uint32_t)width, (uint32_t)height, places);
    if (good) {
        result = read_chunks(file, part, &window, lines, set, places, &planes);
        good = result == EXR_ERR_SUCCESS || failed(path, result);
    }
    free(planes.values);
    free(places);
    return good;
}

bool image_read_exr(const char *path, struct image_set *set) {
    exr_context_initializer_t initial = initializer();
    exr_context_t file = NULL;
    int parts = 0;
    exr_result_t result = exr_start_read(&file, path, &initial);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_count(file, &parts);
    bool good = result == EXR_ERR_SUCCESS || failed(path, result);
    for (int part = 0; good && part < parts; part++)
        good = read_part(file, part, path, set);
    exr_finish(&file);
    return good;
}
