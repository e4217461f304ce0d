/* SPDX-License-Identifier: GPL-3.0-or-later
 * The making of textures, shared by pnb_texture_create and captures. */
#ifndef PNB_TEXTURE_H
#define PNB_TEXTURE_H

#include "scene.h"

#define TEXTURE_MAX_SIDE 16384u
/* The largest finite half float. */
#define TEXTURE_MAX_COLOR 65504.0f
/* All of enum pnb_texture_flags. */
#define TEXTURE_FLAGS ((uint32_t)(PNB_TEXTURE_NEAREST | PNB_TEXTURE_EXTEND | PNB_TEXTURE_CLIP | PNB_TEXTURE_MIRROR))

/* An empty texture with one reference; NULL without memory. */
pnb_texture *texture_allocate(const char *name);
/* Computes the content key of a filled texture. */
void texture_finish(pnb_texture *texture);

#endif
