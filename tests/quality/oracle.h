/* SPDX-License-Identifier: GPL-3.0-or-later
 * What lights do, by brute force in double precision: written from the definitions of penumbra.h, sharing no code with
 * the library. */
#ifndef ORACLE_H
#define ORACLE_H

#include <penumbra.h>
#include <stdbool.h>

/* Whether something stands between two points. A SUN's points are far away. */
typedef bool (*oracle_blocker)(const double from[3], const double to[3], const void *user);

struct oracle {
    double irradiance; /* W/m2 of the first channel, were nothing in between */
    double visibility; /* share of that irradiance that arrives: what the Shadow pass holds */
    double visible;    /* share of the emitter's points that are visible: what PCSS estimates */
    double lowest;     /* sine of the elevation of its lowest point above the surface */
};

/* Splits the emitter into n x n cells. blocker NULL: nothing is in between. */
struct oracle oracle_light(const pnb_light *light, const double position[3], const double normal[3], int n,
                           oracle_blocker blocker, const void *user);

/* ---- Blockers ---- */

/* Points with x < edge at height z. */
struct half_plane {
    double edge, z;
};
bool half_plane_blocks(const double from[3], const double to[3], const void *half_plane);

struct ball {
    double center[3], radius;
};
bool ball_blocks(const double from[3], const double to[3], const void *ball);

/* The box -0.5..0.5 x -0.5..0.5 x 0..1, placed by a matrix (column-major, object to world). */
bool box_blocks(const double from[3], const double to[3], const void *matrix);

#endif
