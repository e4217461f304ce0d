// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees in a tile of 16 x 16 pixels of the full image (tiles.c: struct tile).

const int TILE = 16;

struct tile {
    vec4 minimum, maximum; // xyz: bounds of the positions, relative world, minimum > maximum: nothing seen;
                           // w: of dot(normal, position)
    vec4 normal;           // xyz: a geometric normal; w: length of its difference from any other, at most
};
