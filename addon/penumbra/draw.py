# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and text in a region. Only while Blender draws one: at other times there is no GPU to draw with."""

import textwrap

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader
from gpu_extras.presets import draw_texture_2d

_FONT = 0
_TEXT_POINTS = 13


def make_texture(width, height, pixels):
    """Texture of RGBA floats, a ctypes array."""
    buffer = gpu.types.Buffer('FLOAT', len(pixels), pixels)
    return gpu.types.GPUTexture((width, height), format='RGBA16F', data=buffer)


def draw_picture(texture, x, y, width, height):
    """Scene-linear premultiplied colours: Blender applies the view transform afterwards."""
    gpu.state.blend_set('ALPHA_PREMULT')
    draw_texture_2d(texture, (x, y), width, height)
    gpu.state.blend_set('NONE')


# ---- The Shadow pass: over what another engine drew, or by itself ----

# Multiplied with what lies below; as it is; lit, penumbra and umbra by colours; one channel from dark to bright; a map.
MULTIPLY, SHOW, CLASSIFY, RAMP, MAP = range(5)

_shadow_shader = None
_SHADOW_VERTEX = "void main() { gl_Position = vec4(position, 0.0, 1.0); }"
# Premultiplied black of some alpha is a multiplication of what lies below. No local has the name of a push constant,
# which is a macro with Vulkan.
_SHADOW_FRAGMENT = """
vec3 ramp(float value) {
    const vec3 colors[5] = vec3[5](vec3(0.03, 0.0, 0.09), vec3(0.04, 0.1, 0.26), vec3(0.01, 0.28, 0.26),
                                   vec3(0.1, 0.55, 0.12), vec3(0.98, 0.8, 0.02));
    float band = clamp(value, 0.0, 1.0) * 3.999;
    return mix(colors[int(band)], colors[int(band) + 1], fract(band));
}

void main() {
    ivec2 pixel = ivec2(floor((gl_FragCoord.xy - place.xy) / place.zw * vec2(size)));
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size)))
        discard;
    if (mode >= 3) {
        float value = texelFetch(shadow, pixel, 0).r;
        if (mode == 3)
            result = vec4(value > 0.0 ? ramp(value / color.r) : vec3(0.0), 1.0);
        else
            result = vec4(value < 0.0 ? vec3(0.02, 0.02, 0.05) : vec3(value), 1.0);
        return;
    }
    vec3 light;
    for (int channel = 0; channel < 3; channel++)
        light[channel] = texelFetch(shadow, ivec2(3 * pixel.x + channel, pixel.y), 0).r;
    light = clamp(light, vec3(0.0), vec3(1.0));
    float mean = dot(light, vec3(1.0 / 3.0));
    if (mode == 0)
        result = vec4(color.rgb, 1.0) * (1.0 - mean) * color.a;
    else if (mode == 1)
        result = vec4(light, 1.0);
    else
        result = mean > 0.999 ? vec4(0.8, 0.7, 0.3, 1.0)
               : mean < 0.001 ? vec4(0.02, 0.05, 0.3, 1.0)
                              : vec4(mix(vec3(0.25, 0.0, 0.1), vec3(0.9, 0.2, 0.05), mean), 1.0);
}
"""


def make_shadow_texture(width, height, pixels, channels=3):
    """Texture of RGB floats: three texels of one channel per pixel, since there is no texture of three. Or of one."""
    data = gpu.types.Buffer('FLOAT', len(pixels), pixels)
    return gpu.types.GPUTexture((channels * width, height), format='R32F', data=data)


def draw_shadow(texture, size, place, mode, color=(0.0, 0.0, 0.0, 1.0)):
    """`size`: of the picture; `place`: x, y, width, height in the region; `color`: RGB and strength of MULTIPLY; its
    red is the largest value of RAMP."""
    shader = _get_shadow_shader()
    batch = batch_for_shader(shader, 'TRIS', {'position': ((-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0))})
    gpu.state.blend_set('ALPHA_PREMULT')
    gpu.state.depth_test_set('NONE')
    shader.bind()
    shader.uniform_sampler('shadow', texture)
    shader.uniform_float('place', place)
    shader.uniform_float('color', color)
    shader.uniform_int('size', size)
    shader.uniform_int('mode', mode)
    batch.draw(shader)
    gpu.state.blend_set('NONE')


def _get_shadow_shader():
    global _shadow_shader
    if _shadow_shader is None:
        info = gpu.types.GPUShaderCreateInfo()
        info.vertex_in(0, 'VEC2', 'position')
        info.sampler(0, 'FLOAT_2D', 'shadow')
        info.push_constant('VEC4', 'place')
        info.push_constant('VEC4', 'color')
        info.push_constant('IVEC2', 'size')
        info.push_constant('INT', 'mode')
        info.fragment_out(0, 'VEC4', 'result')
        info.vertex_source(_SHADOW_VERTEX)
        info.fragment_source(_SHADOW_FRAGMENT)
        _shadow_shader = gpu.shader.create_from_info(info)
    return _shadow_shader


# ---- Text ----

def draw_message(region, message):
    """An error, wrapped, in the middle of the region."""
    scale = bpy.context.preferences.system.ui_scale
    size = _TEXT_POINTS * scale
    blf.size(_FONT, size)
    characters = max(20, int(0.8 * region.width / (0.55 * size)))
    lines = [part for line in message.splitlines() for part in textwrap.wrap(line, characters)]
    y = 0.5 * region.height + 0.5 * len(lines) * 1.4 * size
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 5, 0.0, 0.0, 0.0, 1.0)
    blf.color(_FONT, 1.0, 0.5, 0.2, 1.0)
    for line in lines:
        width, _height = blf.dimensions(_FONT, line)
        y -= 1.4 * size
        blf.position(_FONT, 0.5 * (region.width - width), y, 0)
        blf.draw(_FONT, line)
    blf.disable(_FONT, blf.SHADOW)
