# SPDX-License-Identifier: GPL-3.0-or-later
"""What a 3D viewport looks at: region and its matrices -> pnb_camera, image size and border."""

from typing import NamedTuple

from . import capi
from .lights import column_major


# Left, bottom, right, top of a picture without border.
WHOLE = 0.0, 0.0, 1.0, 1.0


class View(NamedTuple):
    """Compared by value: two equal views show the same picture of the same scene."""
    width: int          # pixels of the region
    height: int
    projection: int
    matrix: tuple       # view to world, column-major
    window: tuple       # left, right, bottom, top: see pnb_camera
    clip_start: float
    clip_end: float
    border: tuple       # left, bottom, right, top, as fractions of the region


def read(context, scene):
    """The view of the context's region. Zoom, offset and shift of a camera view are in Blender's matrices."""
    region, region_3d = context.region, context.region_data
    projection = region_3d.window_matrix
    matrix = region_3d.view_matrix.inverted()
    if region_3d.is_perspective:
        kind, window, clip = capi.PERSPECTIVE, _perspective_window(projection), _perspective_clip(projection)
    else:
        kind, window, clip = capi.ORTHOGRAPHIC, _orthographic_window(projection), _orthographic_clip(projection)
        if clip[0] <= 0.0:
            # Such a view begins behind its own origin, where no camera does.
            matrix.translation += matrix.col[2].xyz * -clip[0]
            clip = 0.0, clip[1] - clip[0]
    return View(region.width, region.height, kind, tuple(column_major(matrix)), window, *_safe_clip(*clip),
                _border(context, scene))


def fill_camera(target, view):
    target.projection = view.projection
    target.matrix[:] = view.matrix
    target.window[:] = view.window
    target.clip_start, target.clip_end = view.clip_start, view.clip_end


def crop(view, width, height):
    """x, y, width, height in pixels of the border in an image of this size; of at least one pixel."""
    left, bottom, right, top = (int(fraction * size + 0.5) for fraction, size in
                                zip(view.border, (width, height, width, height)))
    left, bottom = min(left, width - 1), min(bottom, height - 1)
    return [left, bottom, max(right - left, 1), max(top - bottom, 1)]


def _perspective_window(projection):
    (x, _, x_shift, _), (_, y, y_shift, _) = projection[0], projection[1]
    return (x_shift - 1.0) / x, (x_shift + 1.0) / x, (y_shift - 1.0) / y, (y_shift + 1.0) / y


def _perspective_clip(projection):
    depth, shift = projection[2][2], projection[2][3]
    return shift / (depth - 1.0), shift / (depth + 1.0 or -1e-9)


def _orthographic_window(projection):
    (x, _, _, x_shift), (_, y, _, y_shift) = projection[0], projection[1]
    return (-x_shift - 1.0) / x, (-x_shift + 1.0) / x, (-y_shift - 1.0) / y, (-y_shift + 1.0) / y


def _orthographic_clip(projection):
    depth, shift = projection[2][2], projection[2][3]
    return (shift + 1.0) / depth, (shift - 1.0) / depth


def _safe_clip(start, end):
    start = max(start, 1e-6)
    return start, max(end, start * 1.001)


def _border(context, scene):
    """Of the camera frame in camera view, of the region elsewhere; all of the region without one."""
    region_3d, space = context.region_data, context.space_data
    if region_3d.view_perspective == 'CAMERA':
        if not scene.render.use_border or not scene.camera or scene.camera.type != 'CAMERA':
            return WHOLE
        left, bottom, right, top = _camera_frame(region_3d, scene)
        bounds = scene.render
    else:
        if not space.use_render_border:
            return WHOLE
        left, bottom, right, top = WHOLE
        bounds = space
    width, height = right - left, top - bottom
    border = (left + width * _bound(bounds, 'min_x'), bottom + height * _bound(bounds, 'min_y'),
              left + width * _bound(bounds, 'max_x'), bottom + height * _bound(bounds, 'max_y'))
    return tuple(min(max(bound, 0.0), 1.0) for bound in border)


def _bound(owner, name):
    return getattr(owner, 'border_' + name if hasattr(owner, 'border_' + name) else 'render_border_' + name)


def _camera_frame(region_3d, scene):
    """Left, bottom, right, top of the camera's picture in the region, as fractions of it."""
    corners = [region_3d.perspective_matrix @ (scene.camera.matrix_world.normalized() @ corner).to_4d()
               for corner in scene.camera.data.view_frame(scene=scene)]
    xs = [0.5 + 0.5 * corner.x / corner.w for corner in corners]
    ys = [0.5 + 0.5 * corner.y / corner.w for corner in corners]
    return min(xs), min(ys), max(xs), max(ys)
