/* SPDX-License-Identifier: GPL-3.0-or-later
 * Procedural scenes for tests and measurements, made through the public API. */
#ifndef TEST_SCENES_H
#define TEST_SCENES_H

#include <penumbra.h>

enum test_light { TEST_LIGHT_RECTANGLE, TEST_LIGHT_ELLIPSE, TEST_LIGHT_POINT, TEST_LIGHT_SPOT, TEST_LIGHT_SUN };
#define TEST_LIGHT_COUNT 5
/* "rectangle", "ellipse", "point", "spot", "sun" */
extern const char *const test_light_names[TEST_LIGHT_COUNT];

/* All zero: the scene's defaults. */
struct test_scene_options {
    enum test_light light; /* the kind of the scene's one light */
    float light_size;      /* its full width in metres; 0: the scene's own */
    float parameter;       /* the scene's parameter, if has_parameter; else its default is taken */
    int has_parameter;
};

struct test_scene_info {
    const char *name, *description;
    const char *parameter; /* what options.parameter means, with its unit; NULL: nothing */
    float parameter_default;
    int translucent;       /* 1: its casters let light through */
};

/* NULL beyond the last scene. */
const struct test_scene_info *test_scene_info(uint32_t index);

struct test_scene;

/* NULL for an unknown name or on failure; pnb_last_error tells which. options may be NULL. */
struct test_scene *test_scene_create(const char *name, const struct test_scene_options *options);
void test_scene_destroy(struct test_scene **scene);
/* Description and settings (image size; the rest default), valid until the scene is destroyed. */
const pnb_scene *test_scene_get(const struct test_scene *scene);
const pnb_settings *test_scene_settings(const struct test_scene *scene);

#endif
