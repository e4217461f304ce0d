# SPDX-License-Identifier: GPL-3.0-or-later
"""What comes out of shader nodes whose inputs are constant."""

import colorsys
import math

from .nodes import read_once


class _Varies(Exception):
    """A value that is not constant."""


def constant(source, default, leaf=None):
    """The value of an input as a number or a list, or None if it is not constant. `leaf(source)`: the value of what is
    not a constant to this file, or None."""
    try:
        return _Evaluation(leaf).value(source, default)
    except _Varies:
        return None


def own(source, default):
    """The value that a socket has beside what is linked to it."""
    value = getattr(source.socket, 'default_value', default)
    return value if isinstance(value, (int, float)) else list(value)


def number(value):
    """As a link from a colour or a vector to a number converts it."""
    if not isinstance(value, list):
        return float(value)
    return _luminance(value) if len(value) == 4 else sum(value) / len(value)


def color(value):
    return value[:3] if isinstance(value, list) else [float(value)] * 3


def _luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


class _Evaluation:
    """Of one input. What several inputs share is evaluated once."""

    def __init__(self, leaf):
        self._leaf = leaf
        self._known = {}

    def value(self, source, default=0.0):
        if source.output is None:
            return own(source, default)
        value = read_once(self._known, source, self._node)
        if value is None:
            raise _Varies
        return value

    def _node(self, source):
        evaluate = _NODES.get(source.output.node.type)
        try:
            if evaluate:
                return evaluate(source.output.node, _Inputs(self, source), source.output)
        except (_Varies, ArithmeticError, ValueError):
            pass
        return self._leaf(source) if self._leaf else None


class _Inputs:
    """The values of a node's inputs, by name or index."""

    def __init__(self, evaluation, source):
        self._evaluation = evaluation
        self._source = source

    def number(self, key):
        return number(self._evaluation.value(self._source.input(key)))

    def color(self, key):
        return color(self._evaluation.value(self._source.input(key)))


def _clamped(value, low=0.0, high=1.0):
    return min(max(value, low), high)


def _mixed(a, b, share):
    return [x + (y - x) * share for x, y in zip(a, b)]


_MATH = {
    'ADD': lambda a, b, c: a + b, 'SUBTRACT': lambda a, b, c: a - b, 'MULTIPLY': lambda a, b, c: a * b,
    'DIVIDE': lambda a, b, c: a / b if b else 0.0, 'MULTIPLY_ADD': lambda a, b, c: a * b + c,
    'POWER': lambda a, b, c: math.pow(a, b), 'SQRT': lambda a, b, c: math.sqrt(a) if a > 0.0 else 0.0,
    'EXPONENT': lambda a, b, c: math.exp(a), 'ABSOLUTE': lambda a, b, c: abs(a),
    'LOGARITHM': lambda a, b, c: math.log(a, b) if a > 0.0 and b > 0.0 else 0.0,
    'MINIMUM': lambda a, b, c: min(a, b), 'MAXIMUM': lambda a, b, c: max(a, b),
    'LESS_THAN': lambda a, b, c: float(a < b), 'GREATER_THAN': lambda a, b, c: float(a > b),
    'SIGN': lambda a, b, c: float((a > 0.0) - (a < 0.0)), 'COMPARE': lambda a, b, c: float(abs(a - b) <= max(c, 1e-5)),
    'ROUND': lambda a, b, c: math.floor(a + 0.5), 'FLOOR': lambda a, b, c: math.floor(a),
    'CEIL': lambda a, b, c: math.ceil(a), 'TRUNC': lambda a, b, c: math.trunc(a),
    'FRACT': lambda a, b, c: a - math.floor(a), 'MODULO': lambda a, b, c: math.fmod(a, b) if b else 0.0,
    'SINE': lambda a, b, c: math.sin(a), 'COSINE': lambda a, b, c: math.cos(a), 'TANGENT': lambda a, b, c: math.tan(a),
    'RADIANS': lambda a, b, c: math.radians(a), 'DEGREES': lambda a, b, c: math.degrees(a),
}

# Of the first colour's channel and the second's, mixed by the factor afterwards.
_BLEND = {
    'MIX': lambda a, b: b, 'ADD': lambda a, b: a + b, 'SUBTRACT': lambda a, b: a - b, 'MULTIPLY': lambda a, b: a * b,
    'SCREEN': lambda a, b: 1.0 - (1.0 - a) * (1.0 - b), 'DIVIDE': lambda a, b: a / b if b else a,
    'DIFFERENCE': lambda a, b: abs(a - b), 'DARKEN': min, 'LIGHTEN': max,
    'OVERLAY': lambda a, b: 2.0 * a * b if a < 0.5 else 1.0 - 2.0 * (1.0 - a) * (1.0 - b),
}


def _math(node, inputs, _output):
    operate = _MATH.get(node.operation)
    if operate is None:
        raise _Varies
    value = float(operate(*(inputs.number(index) if index < len(node.inputs) else 0.0 for index in range(3))))
    return _clamped(value) if node.use_clamp else value


def _blended(kind, first, second, share):
    """Two colours by the kind of a Mix node."""
    blend = _BLEND.get(kind)
    if blend is None:
        raise _Varies
    return _mixed(first, [blend(a, b) for a, b in zip(first, second)], share)


def _mix_rgb(node, inputs, _output):
    share = _clamped(inputs.number(0))
    only = only_input(node, share)
    mixed = inputs.color(only) if only else _blended(node.blend_type, inputs.color(1), inputs.color(2), share)
    return [*(map(_clamped, mixed) if node.use_clamp else mixed), 1.0]


def mixed_inputs(node):
    """Numbers of the inputs of a Mix node, of either kind: factor, first, second; None for others, and for one with a
    factor for each number."""
    if node.type == 'MIX_RGB':
        return 0, 1, 2
    if node.type != 'MIX' or node.data_type == 'VECTOR' and node.factor_mode != 'UNIFORM':
        return None
    return _MIX_INPUTS.get(node.data_type)


def blends(node, kind):
    """Whether a Mix node mixes colours in this way."""
    return node.blend_type == kind and (node.type == 'MIX_RGB' or node.data_type == 'RGBA')


def only_input(node, share):
    """The number of the input that a Mix node passes on as it is at this factor; None where it needs both."""
    _factor, first, second = mixed_inputs(node)
    if share == 0.0:
        return first
    is_plain = node.type == 'MIX' and node.data_type != 'RGBA' or node.blend_type == 'MIX'
    return second if share == 1.0 and is_plain else None


_MIX_INPUTS = {'FLOAT': (0, 2, 3), 'VECTOR': (0, 4, 5), 'RGBA': (0, 6, 7)}


def _mix(node, inputs, _output):
    if mixed_inputs(node) is None:
        raise _Varies
    factor, first, second = mixed_inputs(node)
    share = inputs.number(factor)
    share = _clamped(share) if node.clamp_factor else share
    only = only_input(node, share)
    if node.data_type == 'FLOAT':
        return inputs.number(only) if only else _mixed([inputs.number(first)], [inputs.number(second)], share)[0]
    if node.data_type == 'VECTOR':
        return inputs.color(only) if only else _mixed(inputs.color(first), inputs.color(second), share)
    mixed = inputs.color(only) if only else _blended(node.blend_type, inputs.color(first), inputs.color(second), share)
    return [*(map(_clamped, mixed) if node.clamp_result else mixed), 1.0]


def _ramp(node, inputs, output):
    found = list(node.color_ramp.evaluate(inputs.number(0)))
    return found[3] if output.name == 'Alpha' else found


def _invert(_node, inputs, _output):
    found = inputs.color(1)
    return [*_mixed(found, [1.0 - channel for channel in found], inputs.number(0)), 1.0]


def _gamma(_node, inputs, _output):
    exponent = inputs.number(1)
    return [*(channel ** exponent if channel > 0.0 else channel for channel in inputs.color(0)), 1.0]


def _bright_contrast(_node, inputs, _output):
    bright, contrast = inputs.number(1), inputs.number(2)
    return [*(max((1.0 + contrast) * channel + bright - contrast / 2.0, 0.0) for channel in inputs.color(0)), 1.0]


def _hue_saturation(_node, inputs, _output):
    found = inputs.color('Color')
    hue, saturation, value = colorsys.rgb_to_hsv(*(max(channel, 0.0) for channel in found))
    changed = colorsys.hsv_to_rgb((hue + inputs.number('Hue') + 0.5) % 1.0,
                                  _clamped(saturation * inputs.number('Saturation')), value * inputs.number('Value'))
    return [*(max(channel, 0.0) for channel in _mixed(found, changed, inputs.number(3))), 1.0]


def _clamp(node, inputs, _output):
    low, high = inputs.number('Min'), inputs.number('Max')
    if node.clamp_type == 'RANGE' and low > high:
        low, high = high, low
    return _clamped(inputs.number('Value'), low, high)


def _map_range(node, inputs, _output):
    if getattr(node, 'data_type', 'FLOAT') != 'FLOAT' or node.interpolation_type != 'LINEAR':
        raise _Varies
    value, from_min, from_max, to_min, to_max = (inputs.number(index) for index in range(5))
    share = (value - from_min) / (from_max - from_min) if from_max != from_min else 0.0
    mapped = to_min + (to_max - to_min) * share
    return _clamped(mapped, min(to_min, to_max), max(to_min, to_max)) if node.clamp else mapped


def _combine(node, inputs, _output):
    if getattr(node, 'mode', 'RGB') != 'RGB':
        raise _Varies
    found = [inputs.number(index) for index in range(3)]
    return found if node.type == 'COMBXYZ' else [*found, 1.0]


def _separate(node, inputs, output):
    if getattr(node, 'mode', 'RGB') != 'RGB':
        raise _Varies
    return inputs.color(0)[list(node.outputs).index(output)]


_NODES = {
    'VALUE': lambda _node, _inputs, output: output.default_value,
    'RGB': lambda _node, _inputs, output: list(output.default_value),
    'MATH': _math, 'MIX_RGB': _mix_rgb, 'MIX': _mix, 'VALTORGB': _ramp, 'INVERT': _invert, 'GAMMA': _gamma,
    'BRIGHTCONTRAST': _bright_contrast, 'HUE_SAT': _hue_saturation, 'CLAMP': _clamp, 'MAP_RANGE': _map_range,
    'RGBTOBW': lambda _node, inputs, _output: _luminance(inputs.color(0)),
    'COMBRGB': _combine, 'COMBINE_COLOR': _combine, 'COMBXYZ': _combine,
    'SEPRGB': _separate, 'SEPARATE_COLOR': _separate, 'SEPXYZ': _separate,
}

# Nodes that change a colour or a number, of which the picture that goes through them may be kept.
CHANGES = _NODES.keys() - {'VALUE', 'RGB'} | {'CURVE_RGB', 'CURVE_FLOAT', 'VECT_MATH'}
