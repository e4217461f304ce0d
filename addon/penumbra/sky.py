# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean colour of a Sky Texture over the sphere, without the disc of its sun."""

from math import asin, degrees

# By the sun's elevation in degrees, as Cycles renders the node's own settings; the air's densities, altitude and
# turbidity are not looked at.
_SINGLE = ((-5, (0.005, 0.005, 0.005)), (0, (0.31, 0.24, 0.21)), (5, (1.48, 1.23, 0.91)), (15, (2.10, 2.08, 2.00)),
           (30, (1.89, 2.12, 2.44)), (45, (1.66, 1.98, 2.50)), (60, (1.51, 1.87, 2.47)), (90, (1.39, 1.77, 2.42)))
_MEANS = {
    'NISHITA': _SINGLE, 'SINGLE_SCATTERING': _SINGLE,
    'MULTIPLE_SCATTERING': ((-5, (0.006, 0.013, 0.041)), (0, (0.38, 0.30, 0.36)), (5, (1.36, 1.40, 1.51)),
                            (15, (1.92, 2.57, 3.48)), (30, (2.01, 3.00, 4.49)), (45, (2.07, 3.21, 4.99)),
                            (60, (2.12, 3.35, 5.29)), (90, (2.17, 3.45, 5.51))),
    'PREETHAM': ((0, (0.60, 0.48, 0.23)), (15, (0.66, 0.60, 0.58)), (30, (0.64, 0.65, 0.83)), (45, (0.60, 0.64, 0.89)),
                 (60, (0.56, 0.61, 0.83)), (75, (0.53, 0.58, 0.79)), (90, (0.60, 0.68, 1.00))),
    'HOSEK_WILKIE': ((0, (0.021, 0.011, 0.005)), (15, (0.085, 0.099, 0.090)), (30, (0.097, 0.131, 0.145)),
                     (45, (0.108, 0.146, 0.173)), (60, (0.112, 0.152, 0.190)), (75, (0.104, 0.154, 0.204)),
                     (90, (0.083, 0.155, 0.219))),
}


def mean(node):
    """Linear RGB, or None for a kind of sky that is not known."""
    table = _MEANS.get(node.sky_type)
    return table and _interpolated(table, _elevation(node))


def _elevation(node):
    """Of the sun, in degrees; beyond the zenith it sinks again."""
    if node.sky_type in {'PREETHAM', 'HOSEK_WILKIE'}:
        return degrees(asin(min(max(node.sun_direction[2], -1.0), 1.0)))
    angle = degrees(node.sun_elevation)
    return 180.0 - angle if angle > 90.0 else angle


def _interpolated(table, angle):
    if angle <= table[0][0]:
        return list(table[0][1])
    for (low, first), (high, second) in zip(table, table[1:]):
        if angle <= high:
            return [a + (b - a) * (angle - low) / (high - low) for a, b in zip(first, second)]
    return list(table[-1][1])
