/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scenes whose casters let light through. */
#ifndef TRANSLUCENT_SCENES_H
#define TRANSLUCENT_SCENES_H

#include "scene_builder.h"

void build_glass(struct scene_builder *builder);
void build_panes(struct scene_builder *builder);
void build_alpha_fence(struct scene_builder *builder);
void build_foliage(struct scene_builder *builder);
void build_layers(struct scene_builder *builder);

#endif
