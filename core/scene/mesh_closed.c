/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whether a mesh is the whole surface of a body. */
#include "content_key.h"
#include "mesh.h"

#include <string.h>

static uint64_t position_hash(const float position[3]) {
    uint32_t bits[3];
    for (int i = 0; i < 3; i++) {
        const float value = position[i] + 0.0f; /* one zero */
        memcpy(&bits[i], &value, sizeof value);
    }
    return content_key_mix(content_key_mix((uint64_t)bits[0] << 32 | bits[1]) + bits[2]);
}

/* Six times the volume of the tetrahedron of a triangle and a point. */
static double volume(const float *corners[3], const float *point) {
    double edges[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            edges[k][i] = (double)corners[k][i] - (double)point[i];
    return edges[0][0] * (edges[1][1] * edges[2][2] - edges[1][2] * edges[2][1]) +
           edges[0][1] * (edges[1][2] * edges[2][0] - edges[1][0] * edges[2][2]) +
           edges[0][2] * (edges[1][0] * edges[2][1] - edges[1][1] * edges[2][0]);
}

/* The hashes of the edges, known by the places of their ends, add up to 0 if each is walked as often in one direction
 * as in the other, since opposite directions have opposite signs; otherwise by a chance of 2^-64. */
bool mesh_is_closed(const pnb_mesh *mesh) {
    uint64_t sum = 0;
    double enclosed = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const float *corners[3];
        uint64_t ends[3];
        for (int k = 0; k < 3; k++) {
            corners[k] = mesh->vertices[mesh->indices[i + (uint32_t)k]].position;
            ends[k] = position_hash(corners[k]);
        }
        for (int k = 0; k < 3; k++) {
            const uint64_t a = ends[k], b = ends[(k + 1) % 3];
            sum += content_key_mix(3 * a + b) - content_key_mix(3 * b + a);
        }
        enclosed += volume(corners, mesh->vertices[0].position);
    }
    return sum == 0 && enclosed > 0;
}
