/* SPDX-License-Identifier: GPL-3.0-or-later
 * The steps of scene_create. */
#ifndef PNB_SCENE_PARTS_H
#define PNB_SCENE_PARTS_H

#include "scene.h"

/* Structure sizes, missing pointers, unknown enumerators and flags, the number of lights: what no scene may have. */
pnb_result scene_check(const pnb_scene *scene);

/* Fills everything but the name; `name` is for messages. False: the light cannot be used. */
bool light_resolve(const pnb_light *from, const char *name, struct messages *messages, struct scene_light *to);
void camera_resolve(const pnb_camera *from, struct messages *messages, struct scene_camera *to);

#endif
