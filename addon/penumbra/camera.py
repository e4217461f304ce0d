# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera object -> pnb_camera."""

from math import tan
from types import SimpleNamespace

from . import capi
from .lights import column_major
from .names import name_of


def fill_camera(target, ob, matrix, shift_x, width, height, aspect, warnings):
    """`aspect`: height over width of a pixel; `shift_x`: the camera's, with the eye's shift in stereo."""
    camera = ob.data if ob.type == 'CAMERA' else _stand_in(ob, warnings)
    if ob.type == 'CAMERA' and camera.dof.use_dof:
        warnings.append(f"camera '{name_of(ob)}': depth of field is not supported, all is sharp")
    target.matrix[:] = column_major(matrix)
    orthographic = camera.type == 'ORTHO'
    if camera.type not in {'ORTHO', 'PERSP'}:
        warnings.append(
            f"camera '{name_of(ob)}': {camera.type.lower()} is not supported, it is rendered in perspective")
    target.projection = capi.ORTHOGRAPHIC if orthographic else capi.PERSPECTIVE
    target.window[:] = _window(camera, orthographic, shift_x, width, height * aspect)
    target.clip_start = camera.clip_start
    target.clip_end = camera.clip_end


def _stand_in(ob, warnings):
    """Any object may be a scene's camera: Blender looks through it with 35 mm, through a spot light with its cone."""
    is_spot = ob.type == 'LIGHT' and ob.data.type == 'SPOT'
    lens = 16.0 / tan(ob.data.spot_size / 2.0) if is_spot else 35.0
    warnings.append(f"object '{name_of(ob)}': it is no camera, it is looked through with a lens of {lens:.3g} mm")
    return SimpleNamespace(type='PERSP', sensor_fit='AUTO', sensor_width=36.0, sensor_height=24.0, lens=lens,
                           shift_y=0.0, clip_start=0.1, clip_end=1000.0)


def _window(camera, orthographic, shift_x, width, height):
    """Left, right, bottom, top: what Blender calls the view plane, at distance 1 in perspective."""
    fit = camera.sensor_fit
    if fit == 'AUTO':
        fit = 'HORIZONTAL' if width >= height else 'VERTICAL'
    side = width if fit == 'HORIZONTAL' else height
    if orthographic:
        extent = camera.ortho_scale
    else:
        sensor = camera.sensor_height if camera.sensor_fit == 'VERTICAL' else camera.sensor_width
        extent = sensor / camera.lens
    half_x, half_y = 0.5 * width / side, 0.5 * height / side
    return [extent * bound for bound in (shift_x - half_x, shift_x + half_x,
                                         camera.shift_y - half_y, camera.shift_y + half_y)]
