// SPDX-License-Identifier: GPL-3.0-or-later
// The material of one draw (gpu_scene.c).

uniform vec4 base_color; // rgb, alpha

#ifdef TEXTURED
uniform sampler2D base_color_texture, alpha_texture;
uniform vec4 texture_use; // x: base_color_texture, y: alpha_texture; z: 1 = alpha is the texture's own, 0 = its grey

vec4 material_color(vec2 uv) {
    vec4 color = base_color;
    if (texture_use.x != 0.0)
        color.rgb *= texture(base_color_texture, uv).rgb;
    if (texture_use.y != 0.0) {
        vec4 texel = texture(alpha_texture, uv);
        float grey = dot(texel.rgb, vec3(0.2126, 0.7152, 0.0722)); // luminance, as Blender converts colours
        color.a *= clamp(texture_use.z != 0.0 ? texel.a : grey, 0.0, 1.0);
    }
    return color;
}
#else
vec4 material_color(vec2 uv) {
    return base_color;
}
#endif
