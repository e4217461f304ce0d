/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "technique.h"

static const struct parameter parameters[] = {
    {.name = "kernel_width",
     .label = "Kernel Width",
     .description = "Side of the square that is averaged: how soft every edge is, whatever the light's size",
     .unit = "texels",
     .type = PNB_FLOAT,
     .minimum = 1,
     .maximum = 128,
     .default_value = 5},
    {.name = "samples",
     .label = "Samples",
     .description = "Samples along each side of the square; cost grows with its square",
     .unit = "",
     .type = PNB_INT,
     .minimum = 1,
     .maximum = 32,
     .default_value = 4},
    {0}};

const struct technique technique_pcf = {
    .id = "PCF",
    .label = "Percentage-Closer Filtering",
    .description = "Shadow edges softened by one width everywhere",
    .paper = "W. Reeves, D. Salesin, R. Cook, Rendering Antialiased Shadows with Depth Maps, 1987",
    .parameters = parameters,
    .shader = "tech_pcf.glsl",
};
