/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "texture.h"
#include "../memory.h"
#include "content_key.h"
#include "strided.h"

#include <inttypes.h>
#include <math.h>

/* ---- One texel ---- */

/* sRGB values that images of 8 bits have, decoded: powf for every texel would take most of the time. */
struct srgb_table {
    float linear[256];
};

static float srgb_decode(float value) {
    return value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
}

static void srgb_table_fill(struct srgb_table *table) {
    for (int i = 0; i < 256; i++) {
        table->linear[i] = srgb_decode((float)i / 255.0f);
    }
}

static float srgb_to_linear(const struct srgb_table *table, float value) {
    if (value <= 1.0f) {
        unsigned nearest = (unsigned)(value * 255.0f + 0.5f);
        if (value == (float)nearest / 255.0f) {
            return table->linear[nearest];
        }
    }
    return srgb_decode(value);
}

static float clamp(float value, float maximum) {
    if (!isfinite(value) || value < 0) {
        return 0;
    }
    return value < maximum ? value : maximum;
}

/* table: NULL if the colours are linear already. */
static void texel_convert(const float *from, uint32_t channels, const struct srgb_table *table, float rgba[4]) {
    uint32_t colors = channels >= 3 ? 3 : 1;
    for (uint32_t i = 0; i < 3; i++) {
        float value = clamp(from[i % colors], TEXTURE_MAX_COLOR);
        rgba[i] = table ? clamp(srgb_to_linear(table, value), TEXTURE_MAX_COLOR) : value;
    }
    rgba[3] = channels % 2 == 0 ? clamp(from[channels - 1], 1) : 1;
}

/* ---- Textures ---- */

static pnb_result texture_check(const pnb_texture_desc *desc) {
    pnb_result result = CHECK_STRUCT(desc, pnb_texture_desc);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "texture";
    if (desc->width < 1 || desc->height < 1 || desc->width > TEXTURE_MAX_SIDE || desc->height > TEXTURE_MAX_SIDE) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT,
                         "texture '%s': its size is %" PRIu32 " x %" PRIu32 ", but sides must be 1 to %u texels", name,
                         desc->width, desc->height, TEXTURE_MAX_SIDE);
    }
    if (desc->channels < 1 || desc->channels > 4) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "texture '%s': %" PRIu32 " channels, but 1 to 4 are possible",
                         name, desc->channels);
    }
    if (desc->flags & ~TEXTURE_FLAGS) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "texture '%s': unknown flags 0x%" PRIx32, name, desc->flags);
    }
    if (!desc->pixels.data) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "texture '%s': pixels is NULL", name);
    }
    return PNB_OK;
}

static void texture_fill(pnb_texture *texture, const pnb_texture_desc *desc) {
    struct srgb_table table;
    if (desc->is_srgb) {
        srgb_table_fill(&table);
    }
    size_t count = (size_t)desc->width * desc->height;
    for (size_t i = 0; i < count; i++) {
        float texel[4];
        strided_read(&desc->pixels, i, texel, desc->channels * sizeof *texel);
        texel_convert(texel, desc->channels, desc->is_srgb ? &table : NULL, texture->rgba + 4 * i);
    }
}

pnb_result pnb_texture_create(const pnb_texture_desc *desc, pnb_texture **texture) {
    pnb_result result = texture_check(desc);
    if (result != PNB_OK) {
        return result;
    }
    if (!texture) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "texture is NULL");
    }
    pnb_texture *made = texture_allocate(desc->name);
    if (!made) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    made->width = desc->width;
    made->height = desc->height;
    made->flags = desc->flags;
    made->has_alpha = desc->channels % 2 == 0;
    made->rgba = memory_array((size_t)desc->width * desc->height, 4 * sizeof *made->rgba);
    if (!made->rgba) {
        pnb_texture_destroy(&made);
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    texture_fill(made, desc);
    texture_finish(made);
    *texture = made;
    return PNB_OK;
}

pnb_texture *texture_allocate(const char *name) {
    pnb_texture *texture = memory_array(1, sizeof *texture);
    if (texture) {
        atomic_init(&texture->references, 1);
        texture->name = memory_string(name, "texture");
        if (!texture->name) {
            pnb_texture_destroy(&texture);
        }
    }
    return texture;
}

void texture_finish(pnb_texture *texture) {
    uint32_t header[4] = {texture->width, texture->height, texture->has_alpha, texture->flags};
    texture->content = (struct content_key){{0}};
    content_key_add(&texture->content, header, sizeof header);
    content_key_add(&texture->content, texture->rgba,
                    (size_t)texture->width * texture->height * 4 * sizeof *texture->rgba);
}

pnb_texture *texture_retain(pnb_texture *texture) {
    atomic_fetch_add_explicit(&texture->references, 1, memory_order_relaxed);
    return texture;
}

void pnb_texture_destroy(pnb_texture **texture) {
    if (!texture || !*texture) {
        return;
    }
    pnb_texture *last = *texture;
    *texture = NULL;
    if (atomic_fetch_sub_explicit(&last->references, 1, memory_order_acq_rel) > 1) {
        return;
    }
    memory_free(last->name);
    memory_free(last->rgba);
    memory_free(last);
}
