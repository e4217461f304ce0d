// SPDX-License-Identifier: GPL-3.0-or-later
// One tile as a square point. The viewport covers all tiles.

layout(location = 0) in float visibility; // of pass_classify.comp
uniform ivec2 tile_count;
uniform int undecided_only;

flat out float tile_visibility;

void main() {
    vec2 center = vec2(gl_VertexID % tile_count.x, gl_VertexID / tile_count.x) + 0.5;
    bool drawn = undecided_only == 0 || visibility == 0.5;
    gl_Position = drawn ? vec4(2.0 * center / vec2(tile_count) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    tile_visibility = visibility;
}
