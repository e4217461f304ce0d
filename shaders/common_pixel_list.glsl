// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels of the crop that are drawn one by one, in no order (core/passes/pixel_list.c).

layout(std430, binding = 1) buffer pixel_block {
    uint pixel_count;
    uint listed_pixels[];
};

void list_pixel(ivec2 pixel) {
    listed_pixels[atomicAdd(pixel_count, 1u)] = uint(pixel.x) | uint(pixel.y) << 16;
}

ivec2 listed_pixel(uint place) {
    uint pixel = listed_pixels[place];
    return ivec2(pixel & 0xffffu, pixel >> 16);
}
