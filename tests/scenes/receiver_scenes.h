/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scenes that are hard on what prefiltered maps know of receivers: their depths, and their size on the screen. */
#ifndef RECEIVER_SCENES_H
#define RECEIVER_SCENES_H

#include "scene_builder.h"

void build_terraces(struct scene_builder *builder);
void build_grazing_fence(struct scene_builder *builder);

#endif
