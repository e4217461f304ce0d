/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checked settings of one render, every default filled in. */
#ifndef PNB_SETTINGS_H
#define PNB_SETTINGS_H

#include "../messages.h"

/* Most parameters one technique may have. */
#define MAX_PARAMETERS 32

/* Most techniques the table may have. */
#define MAX_TECHNIQUES 32

struct technique;
struct scene;
struct scene_light;

struct settings {
    const struct technique *technique;                 /* of the lights that have none of their own */
    double parameters[MAX_TECHNIQUES][MAX_PARAMETERS]; /* of every technique, in the order of table and row */
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
/* Whether techniques and map sizes of the scene's own lights exist; the message names the light. */
pnb_result settings_check_lights(const struct scene *scene, uint32_t max_texture_size);
/* What a light takes, its own or else the settings'. */
const struct technique *settings_technique(const struct settings *settings, const struct scene_light *light);
uint32_t settings_map_size(const struct settings *settings, const struct scene_light *light);

#endif
