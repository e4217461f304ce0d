/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle.h"

#include <math.h>

#define PI       3.14159265358979323846
#define FAR_AWAY 1e6

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double normalize(double v[3]) {
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length;
}

static void column(const pnb_light *light, int index, double v[3]) {
    for (int i = 0; i < 3; i++)
        v[i] = light->matrix[4 * index + i];
}

/* Two unit vectors across v, which is one itself. */
static void across(const double v[3], double x[3], double y[3]) {
    const int smallest =
        fabs(v[0]) < fabs(v[1]) ? (fabs(v[0]) < fabs(v[2]) ? 0 : 2) : (fabs(v[1]) < fabs(v[2]) ? 1 : 2);
    for (int i = 0; i < 3; i++)
        x[i] = (i == smallest) - v[smallest] * v[i];
    normalize(x);
    for (int i = 0; i < 3; i++)
        y[i] = v[(i + 1) % 3] * x[(i + 2) % 3] - v[(i + 2) % 3] * x[(i + 1) % 3];
}

/* Intensity of a point of a SPOT in the direction of a position, over that of its axis. */
static double cone(const pnb_light *light, const double point[3], const double position[3]) {
    double axes[3][3], lengths[3], local[3], to_point[3];
    for (int i = 0; i < 3; i++) {
        column(light, i, axes[i]);
        lengths[i] = normalize(axes[i]);
        to_point[i] = position[i] - point[i];
    }
    for (int i = 0; i < 3; i++)
        local[i] = dot(to_point, axes[i]) * lengths[2] / lengths[i];
    const double cosine = -local[2] / normalize(local), edge = cos(0.5 * light->spot_angle);
    if (cosine <= edge)
        return 0;
    const double fade = (1 - edge) * light->spot_blend, t = fade > 0 ? fmin((cosine - edge) / fade, 1) : 1;
    return t * t * (3 - 2 * t) * (light->flags & PNB_LIGHT_COSINE_SPOT ? cosine : 1);
}

/* A disk, evenly: equal areas for equal areas of the square, by polar coordinates. */
static void to_disk(double s[2]) {
    const double radius = sqrt(0.5 * (s[0] + 1)), angle = PI * s[1];
    s[0] = radius * cos(angle);
    s[1] = radius * sin(angle);
}

/* Point of the emitter for s in the square or disk, as seen from `position`: where it is, and the irradiance that the
 * whole emitter would give to a surface facing the point, were it all there. */
static double emitter_point(const pnb_light *light, const double position[3], const double s[2], double point[3]) {
    double u[3], v[3], z[3], to_point[3];
    column(light, 2, z);
    normalize(z);
    if (light->type == PNB_LIGHT_SUN) {
        across(z, u, v);
        const double radius = tan(0.5 * light->angle);
        for (int i = 0; i < 3; i++)
            point[i] = position[i] + FAR_AWAY * (z[i] + radius * (s[0] * u[i] + s[1] * v[i]));
        return light->emission[0];
    }
    double half[2] = {light->radius, light->radius};
    if (light->type == PNB_LIGHT_AREA) {
        column(light, 0, u);
        column(light, 1, v);
        half[0] = 0.5 * light->size[0];
        half[1] = 0.5 * light->size[1];
    } else { /* a disk that faces the surface */
        for (int i = 0; i < 3; i++)
            z[i] = light->matrix[12 + i] - position[i];
        normalize(z);
        across(z, u, v);
    }
    for (int i = 0; i < 3; i++) {
        point[i] = light->matrix[12 + i] + half[0] * s[0] * u[i] + half[1] * s[1] * v[i];
        to_point[i] = point[i] - position[i];
    }
    const double distance = normalize(to_point), facing = dot(to_point, z);
    if (facing <= 0 && light->type == PNB_LIGHT_AREA)
        return 0;
    const double intensity = light->emission[0] * fabs(facing) / (distance * distance);
    if (light->type != PNB_LIGHT_AREA)
        return intensity * (light->type == PNB_LIGHT_SPOT ? cone(light, point, position) : 1);
    const double area = light->size[0] * light->size[1] * normalize(u) * normalize(v);
    return intensity * area * (light->shape == PNB_AREA_ELLIPSE ? PI / 4 : 1);
}

struct oracle oracle_light(const pnb_light *light, const double position[3], const double normal[3], int n,
                           oracle_blocker blocker, const void *user) {
    const bool disk = light->type != PNB_LIGHT_AREA || light->shape == PNB_AREA_ELLIPSE;
    struct oracle sum = {.lowest = 1};
    for (int i = 0; i < n * n; i++) {
        double s[2] = {(2 * (i % n) + 1.0) / n - 1, (2 * (i / n) + 1.0) / n - 1}, point[3], to_point[3];
        if (disk)
            to_disk(s);
        double irradiance = emitter_point(light, position, s, point);
        for (int k = 0; k < 3; k++)
            to_point[k] = point[k] - position[k];
        normalize(to_point);
        const double height = dot(to_point, normal);
        sum.lowest = fmin(sum.lowest, height);
        irradiance *= fmax(height, 0) / (n * n);
        const bool visible = !blocker || !blocker(position, point, user);
        sum.irradiance += irradiance;
        sum.visibility += visible ? irradiance : 0;
        sum.visible += visible ? 1.0 / (n * n) : 0;
    }
    sum.visibility = sum.irradiance > 0 ? sum.visibility / sum.irradiance : 1;
    return sum;
}

/* ---- Blockers ---- */

bool half_plane_blocks(const double from[3], const double to[3], const void *user) {
    const struct half_plane *plane = user;
    const double t = (plane->z - from[2]) / (to[2] - from[2]);
    return t > 0 && t < 1 && from[0] + t * (to[0] - from[0]) < plane->edge;
}

bool ball_blocks(const double from[3], const double to[3], const void *user) {
    const struct ball *ball = user;
    double to_center[3], direction[3];
    for (int i = 0; i < 3; i++) {
        to_center[i] = ball->center[i] - from[i];
        direction[i] = to[i] - from[i];
    }
    const double t = fmin(fmax(dot(to_center, direction) / dot(direction, direction), 0), 1);
    double distance2 = 0;
    for (int i = 0; i < 3; i++) {
        const double d = to_center[i] - t * direction[i];
        distance2 += d * d;
    }
    return distance2 < ball->radius * ball->radius;
}

bool box_blocks(const double from[3], const double to[3], const void *user) {
    const float *matrix = user;
    double low = 0, high = 1;
    for (int axis = 0; axis < 3; axis++) {
        double a = 0, b = 0, length2 = 0;
        for (int i = 0; i < 3; i++) {
            const double m = matrix[4 * axis + i];
            a += m * (from[i] - (double)matrix[12 + i]);
            b += m * (to[i] - (double)matrix[12 + i]);
            length2 += m * m;
        }
        a = a / length2 - (axis == 2 ? 0.5 : 0);
        b = b / length2 - (axis == 2 ? 0.5 : 0);
        const double step = fabs(b - a) > 1e-300 ? b - a : 1e-300, enter = (-0.5 - a) / step, leave = (0.5 - a) / step;
        low = fmax(low, fmin(enter, leave));
        high = fmin(high, fmax(enter, leave));
    }
    return low < high;
}
