/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checked settings of one render, every default filled in. */
#ifndef PNB_SETTINGS_H
#define PNB_SETTINGS_H

#include "../messages.h"

/* Most parameters one technique may have. */
#define MAX_PARAMETERS 32

struct technique;

struct settings {
    const struct technique *technique;
    double parameters[MAX_PARAMETERS]; /* in the order of the technique's row */
    uint32_t flags;
    uint32_t width, height;
    uint32_t crop[4];
    uint32_t samples;
    float filter_width;
    uint32_t shadow_map_size;
    uint32_t light_samples;
    uint32_t passes;
};

/* max_texture_size: the context's limit on image and shadow-map sides. */
pnb_result settings_resolve(const pnb_settings *from, uint32_t max_texture_size, struct messages *messages,
                            struct settings *to);

#endif
