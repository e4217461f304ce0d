/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reading host arrays of any stride and alignment. */
#ifndef PNB_STRIDED_H
#define PNB_STRIDED_H

#include "penumbra.h"

#include <string.h>

/* Copies element `index` of `size` bytes; stride 0 means that the elements are `size` bytes apart. */
static inline void strided_read(const pnb_array *array, uint64_t index, void *element, size_t size) {
    uint64_t stride = array->stride ? array->stride : size;
    memcpy(element, (const unsigned char *)array->data + index * stride, size);
}

static inline uint32_t strided_read_u32(const pnb_array *array, uint64_t index) {
    uint32_t value;
    strided_read(array, index, &value, sizeof value);
    return value;
}

#endif
