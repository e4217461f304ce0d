/* SPDX-License-Identifier: GPL-3.0-or-later
 * Numbers handles in the order of their first appearance. */
#ifndef PNB_HANDLE_MAP_H
#define PNB_HANDLE_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct handle_map {
    const void **handles; /* by number */
    uint32_t count;
    uint32_t *table; /* open addressing: number + 1, or 0 */
    size_t mask;
};

/* Room for `maximum` different handles; false without memory. */
bool handle_map_init(struct handle_map *map, size_t maximum);
void handle_map_free(struct handle_map *map);
/* The handle's number, a new one if it is not known. */
uint32_t handle_map_add(struct handle_map *map, const void *handle);

#endif
