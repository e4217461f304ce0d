/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "handle_map.h"
#include "../memory.h"

bool handle_map_init(struct handle_map *map, size_t maximum) {
    /* At most half full, so that probing ends soon. */
    size_t capacity = 2;
    while (capacity < 2 * maximum) {
        capacity *= 2;
    }
    *map = (struct handle_map){.mask = capacity - 1};
    map->handles = memory_array(maximum, sizeof *map->handles);
    map->table = map->handles ? memory_array(capacity, sizeof *map->table) : NULL;
    return map->table != NULL;
}

void handle_map_free(struct handle_map *map) {
    memory_free(map->handles);
    memory_free(map->table);
    *map = (struct handle_map){0};
}

uint32_t handle_map_add(struct handle_map *map, const void *handle) {
    /* Handles are aligned: the upper half of the product mixes all of their bits. */
    size_t at = (size_t)((uint64_t)(uintptr_t)handle * 0x6a09e667f3bcc909u >> 32) & map->mask;
    while (map->table[at] > 0) {
        if (map->handles[map->table[at] - 1] == handle) {
            return map->table[at] - 1;
        }
        at = (at + 1) & map->mask;
    }
    map->handles[map->count] = handle;
    map->table[at] = ++map->count;
    return map->count - 1;
}
