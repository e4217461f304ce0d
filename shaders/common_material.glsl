// SPDX-License-Identifier: GPL-3.0-or-later
// The material of one draw (gpu_scene.c). SPECIAL: it has textures, holes or culled faces.

uniform vec4 base_color; // rgb, alpha
uniform vec4 emission;   // rgb; a: 1 = holdout

#ifdef SPECIAL
uniform sampler2D base_color_texture, alpha_texture, emission_texture;
uniform vec4 texture_use; // x: base_color_texture, y: alpha_texture, z: 1 = alpha is the texture's own, 0 = its grey,
                          // w: emission_texture
uniform vec4 clearness;   // rgb: share of the light that shines through, not absorbed; a: 1 = tinted by the texture
uniform float shadow_threshold; // 0, or the alpha from which on a shadow is opaque, while there is none below
uniform vec4 uv_rows[2]; // texture coordinates are these rows times (u, v, 1)
uniform int use_vertex_color;
uniform int culled_faces; // 0: none, 1: back, 2: front
flat in int mirrored; // 1: front faces are drawn clockwise

vec2 material_uv(vec2 uv) {
    return vec2(dot(uv_rows[0].xyz, vec3(uv, 1.0)), dot(uv_rows[1].xyz, vec3(uv, 1.0)));
}

// `tint`: the mesh's own colour.
vec4 material_color(vec2 mesh_uv, vec3 tint) {
    vec2 uv = material_uv(mesh_uv);
    vec4 color = base_color;
    if (use_vertex_color != 0)
        color.rgb *= tint;
    if (texture_use.x != 0.0)
        color.rgb *= texture(base_color_texture, uv).rgb;
    if (texture_use.y != 0.0) {
        vec4 texel = texture(alpha_texture, uv);
        float grey = dot(texel.rgb, vec3(0.2126, 0.7152, 0.0722)); // luminance, as Blender converts colours
        color.a *= clamp(texture_use.z != 0.0 ? texel.a : grey, 0.0, 1.0);
    }
    return color;
}

// What counts as opaque or as nothing at all.
const float TRANSMITTANCE_OPAQUE = 1.0 / 1024.0, TRANSMITTANCE_CLEAR = 1023.0 / 1024.0;

// Share of the light that passes straight through.
vec3 material_transmittance(vec2 mesh_uv) {
    if (shadow_threshold > 0.0)
        return vec3(material_color(mesh_uv, vec3(1.0)).a < shadow_threshold ? 1.0 : 0.0);
    vec3 tint = vec3(1.0);
    if (clearness.a != 0.0)
        tint = min(texture(base_color_texture, material_uv(mesh_uv)).rgb, vec3(1.0));
    return (1.0 - material_color(mesh_uv, vec3(1.0)).a) * clearness.rgb * tint;
}

vec3 material_emission(vec2 mesh_uv) {
    vec2 uv = material_uv(mesh_uv);
    return texture_use.w != 0.0 ? emission.rgb * texture(emission_texture, uv).rgb : emission.rgb;
}

bool is_culled() {
    return culled_faces != 0 && gl_FrontFacing == ((mirrored != 0) == (culled_faces == 1));
}
#else
vec4 material_color(vec2 uv, vec3 tint) {
    return base_color;
}

vec3 material_emission(vec2 uv) {
    return emission.rgb;
}
#endif
