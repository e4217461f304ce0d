# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a picture has arrived on the disk: Blender's writers overlook that it is full and leave a part of one."""

import atexit
import contextlib
import os
import tempfile
import time

import bpy

# Last bytes of whole files.
_ENDS = {b'\x89PNG': b'IEND\xaeB`\x82', b'\xff\xd8\xff': b'\xff\xd9'}

failures = []       # messages; with one, a Blender without a window ends with status 1
_started = [0.0]    # when the render of the last frame began
_has_failed = [False]   # whether a frame of the render could not be made
_movie = []         # where a movie may lie whose render has not ended; Blender does not say when it could not begin one


def find_fault(path):
    """What is wrong with a file that was just written, or None."""
    try:
        with open(path, 'rb') as file:
            start = file.read(8)
            end = _ENDS.get(start[:4]) or _ENDS.get(start[:3])
            if end:
                file.seek(-len(end), os.SEEK_END)
                return None if file.read() == end else "its end is missing"
    except OSError as error:
        return error.strerror
    return _find_fault_of_disk(path) if start else "it is empty"


def _find_fault_of_disk(path):
    """Of other formats we see only whether the disk, or a quota, has room for one block more."""
    try:
        with tempfile.TemporaryFile(dir=os.path.dirname(path), buffering=0) as file:
            file.write(bytes(512))
    except OSError as error:
        return error.strerror
    return None


def _candidates(scene):
    """Paths of each file: with the frame's number, and of a still. Blender does not tell which of them it writes."""
    render = scene.render
    if render.engine != 'PENUMBRA':
        return
    each = render.use_multiview and render.image_settings.views_format == 'INDIVIDUAL'
    extension = render.file_extension if render.use_file_extension else ""
    still = bpy.path.abspath(render.filepath).removesuffix(extension)
    for view in [view for view in render.views if view.use] if each else [None]:
        yield render.frame_path(frame=scene.frame_current, view=view.name if view else "")
        yield still + (view.file_suffix if view else "") + extension


def _written(paths):
    """Those that this render has written."""
    return [path for path in paths if os.path.isfile(path) and os.path.getmtime(path) >= _started[0]]


def _lasting_faults(paths):
    """{path: fault} of files that do not change for a second: a Blender that shares the folder and took the same frame
    may be writing one."""
    lasting = {}
    while faults := {path: fault for path in paths if path not in lasting and (fault := find_fault(path))}:
        before = {path: _state(path) for path in faults}
        time.sleep(1)
        lasting.update((path, fault) for path, fault in faults.items() if _state(path) == before[path])
    return lasting


def _state(path):
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_size, status.st_mtime_ns, status.st_ino


def _remove_faulty(paths):
    """(path, fault) of what was written and is not whole. What could not be made at all, Blender reports."""
    for path, fault in _lasting_faults(_written(paths)).items():
        with contextlib.suppress(FileNotFoundError):
            os.remove(path)
        yield path, fault


def note_failure():
    """A frame could not be rendered."""
    _has_failed[0] = True


@bpy.app.handlers.persistent
def begin(scene, *_arguments):
    """Handler of `render_init`."""
    note_start()
    _has_failed[0] = False
    _movie[:] = _candidates(scene) if scene.render.is_movie_format else ()


@bpy.app.handlers.persistent
def note_start(*_arguments):
    """Handler of `render_pre`. File systems cut times to their clock's ticks."""
    _started[0] = time.time() - 0.1


@bpy.app.handlers.persistent
def check_still(scene, *_arguments):
    """Handler of `render_write`, at which a movie is not whole yet."""
    if not scene.render.is_movie_format:
        _check(_candidates(scene))


@bpy.app.handlers.persistent
def check_movie(scene, *_arguments):
    """Handler of `render_complete`."""
    if scene.render.is_movie_format:
        _movie.clear()
        _check(_candidates(scene))


def _check(paths):
    """Removes what is not whole, says so, and remembers it for the exit status."""
    for path, fault in _remove_faulty(paths):
        failures.append(f"'{path}' could not be written: {fault}")
        print(f"Error: Penumbra: {failures[-1]}", flush=True)


@bpy.app.handlers.persistent
def clean_up(scene, *_arguments):
    """Handler of `render_cancel`: after failures that Blender noticed itself a part of a picture may lie there, and the
    part of a movie before a frame that failed. Who sees the error in the window may want that."""
    _movie.clear()
    if not scene.render.is_movie_format:
        for _path, _fault in _remove_faulty(_candidates(scene)):
            pass
    elif _has_failed[0] and bpy.app.background:
        for path in _written(_candidates(scene)):
            os.remove(path)
            print(f"Error: Penumbra: '{path}' was removed, a frame of it failed", flush=True)


def _end_with_failure():
    """Blender itself ends with 0. It has closed its files when Python ends."""
    _check(_movie)
    if failures and bpy.app.background:
        os._exit(1)


# Not in `register`: Blender disables all add-ons before Python ends.
atexit.register(_end_with_failure)

_HANDLERS = (('render_init', begin), ('render_pre', note_start), ('render_write', check_still),
             ('render_complete', check_movie), ('render_cancel', clean_up))


def register():
    for kind, handler in _HANDLERS:
        getattr(bpy.app.handlers, kind).append(handler)


def unregister():
    for kind, handler in _HANDLERS:
        getattr(bpy.app.handlers, kind).remove(handler)
