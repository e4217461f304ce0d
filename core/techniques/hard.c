/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "technique.h"

static const struct parameter parameters[] = {{0}};

const struct technique technique_hard = {
    .id = "HARD",
    .label = "Hard",
    .description = "Hard shadows from the centre of each light",
    .paper = "L. Williams, Casting Curved Shadows on Curved Surfaces, 1978",
    .parameters = parameters,
    .shader = "tech_hard.glsl",
};
