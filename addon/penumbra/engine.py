# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: stills and animations here, viewports in viewport.py."""

import os
import re
import traceback
from ctypes import byref, c_void_p

import bpy

from . import capi, command_line, device, export, output, passes, report, settings, statistics, viewport
from .names import name_of, one_line

# How long a wait for the library may delay a cancel, in milliseconds.
POLL_MS = 20
# Warnings shown in Blender; a scene with many faults would flood its log.
MAX_WARNINGS = 20


class RenderFailed(Exception):
    """A failure with a message for the user."""


class CaptureRequest:
    """Set by the capture operator: the next render writes a capture instead of rendering."""
    path = None


class PenumbraEngine(bpy.types.RenderEngine):
    bl_idname = 'PENUMBRA'
    bl_label = "Penumbra"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    _viewport = None    # of an engine that draws a region

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)

    def __del__(self):
        if self._viewport:
            self._viewport.close()

    def view_update(self, context, depsgraph):
        self._region().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        self._region().draw(context, depsgraph)

    def _region(self):
        if self._viewport is None:
            self._viewport = viewport.Viewport(viewport.EngineHost(self))
        return self._viewport

    def update_render_passes(self, scene=None, renderlayer=None):
        try:
            for item in passes.list_passes(renderlayer):
                self.register_pass(scene, renderlayer, item.name, len(item.channels), item.channels, item.kind)
        except Exception as error:
            self._fail(error)

    def render(self, depsgraph):
        # An exception that leaves this method would end in a black file and exit code 0, or in a crash.
        try:
            self._render(depsgraph)
        except Exception as error:
            self._fail(error)

    def _fail(self, error):
        message = one_line(str(error))
        if not isinstance(error, (RenderFailed, capi.Error, command_line.UsageError)):
            traceback.print_exc()
            message = f"Unexpected {type(error).__name__}: {message}"
        # The report makes `blender -b` exit with an error and write no file, error_set shows in the image editor.
        self.report({'ERROR'}, message)
        self.error_set(message)
        output.note_failure()

    def _render(self, depsgraph):
        scene = depsgraph.scene_eval
        if scene.camera is None:
            raise RenderFailed(f"Scene '{name_of(scene)}' has no camera")
        self.update_stats("", "Exporting")
        try:
            exported = export.SceneExport(depsgraph, is_cancelled=self.is_cancelled)
        except export.Cancelled:
            return
        with exported:
            views = [view.name for view in scene.render.views if view.use] if scene.render.use_multiview else [""]
            for view in views:
                if not self._render_view(depsgraph, exported, view):
                    return
        report.set_lines(exported.warnings)
        for line in report.lines[:MAX_WARNINGS]:
            self.report({'WARNING'}, line)
        if len(report.lines) > MAX_WARNINGS:
            self.report({'WARNING'}, f"{len(report.lines) - MAX_WARNINGS} more lines are in Render > Report")

    def _render_view(self, depsgraph, exported, view):
        """False if it was cancelled."""
        scene = depsgraph.scene_eval
        width, height = self.resolution_x, self.resolution_y
        if view:
            self.active_view_set(view)
        render = scene.render
        camera = self.camera_override or scene.camera   # views of several cameras: the active view's
        exported.set_camera(camera, *self._pose(camera), width, height, render.pixel_aspect_y / render.pixel_aspect_x)
        values = settings.for_still(depsgraph, width, height)
        exported.use_own_techniques(settings.forced_technique() is None)
        path = CaptureRequest.path or capture_path(depsgraph)
        if path:
            export.write_capture(path, exported.scene, values)
        if CaptureRequest.path:
            return False
        result = self.begin_result(0, 0, width, height, layer=depsgraph.view_layer.name, view=view)
        done = False
        try:
            values.crop[2:] = result.resolution_x, result.resolution_y
            job = c_void_p()
            context = device.context(settings.backend())
            capi.library().render_start(context, byref(exported.scene), byref(values), byref(job))
            try:
                done = self._wait(job, exported)
                if done:
                    left_out = passes.fill_layer(result.layers[0], depsgraph.view_layer, job, *values.crop[2:])
                    exported.warnings.extend(
                        f"light '{name.removeprefix(passes.LIGHT_PREFIX)}': its shadow has no pass: Blender "
                        "asks for the passes before it makes instances" for name in left_out)
                    timings = list(_timings(job))
                    statistics.record("Still", exported, values, timings, context)
                    self._show_statistics(timings)
            finally:
                capi.library().destroy('job', job)
        finally:
            self.end_result(result, cancel=not done)
        return done

    def _pose(self, camera):
        """(matrix, shift in x), those of the eye in stereo. Of what is no camera Blender would read random memory."""
        if camera.type != 'CAMERA':
            return camera.matrix_world.normalized(), 0.0
        return self.camera_model_matrix(camera), self.camera_shift_x(camera)

    def _wait(self, job, exported):
        """Shows progress until the job ends; False if the user cancelled it."""
        library = capi.library()
        progress = capi.Progress()
        shown = None
        try:
            while library.job_wait(job, POLL_MS, byref(progress)) == capi.TIMEOUT:
                if progress.text != shown:  # in the background each one is a line of output
                    shown = progress.text
                    self.update_progress(progress.fraction)
                    self.update_stats("", shown.decode(errors='replace'))
                if self.is_cancelled():
                    library.job_cancel(job)
        except capi.Error as error:
            if error.result == capi.CANCELLED:
                return False
            if error.result == capi.CONTEXT_LOST:
                device.close()
            raise
        self.update_progress(1.0)
        for index in range(library.job_message_count(job)):
            exported.add_message(library.job_message(job, index).decode(errors='replace'))
        return True

    def is_cancelled(self):
        """Whether the user ended the render. Tests replace it; what Blender defines itself cannot be."""
        return self.test_break()

    def _show_statistics(self, timings):
        megabytes = sum(timing.bytes for timing in timings) / 2 ** 20
        self.update_memory_stats(memory_used=megabytes, memory_peak=megabytes)
        if 'stats' not in command_line.options():
            return
        print(f"Penumbra: {'pass':<28}{'times':>8}{'GPU ms':>12}{'CPU ms':>12}{'MiB':>10}")
        for timing in timings:
            print(f"Penumbra: {timing.name.decode():<28}{timing.count:>8}{timing.gpu_ms:>12.3f}{timing.cpu_ms:>12.3f}"
                  f"{timing.bytes / 2 ** 20:>10.2f}", flush=True)


def _timings(job):
    for index in range(capi.library().job_timing_count(job)):
        timing = capi.Timing()
        capi.library().job_get_timing(job, index, byref(timing))
        yield timing


def capture_path(depsgraph):
    """Path given by `-- --penumbra-capture PATH` or PENUMBRA_CAPTURE, with `#` as frame number; None without."""
    path = command_line.options().get('capture') or os.environ.get('PENUMBRA_CAPTURE')
    if not path:
        return None
    scene = depsgraph.scene
    path = re.sub('#+', lambda match: str(scene.frame_current).zfill(len(match.group())), path)
    if scene.render.use_single_layer or len(scene.view_layers) == 1:
        return path
    root, extension = os.path.splitext(path)
    return f"{root}.{depsgraph.view_layer.name}{extension}"


class PENUMBRA_OT_capture(bpy.types.Operator):
    """Write the current frame's scene as the library sees it, for the penumbra command-line tool"""
    bl_idname = 'penumbra.capture'
    bl_label = "Write Penumbra Capture"

    filepath: bpy.props.StringProperty(subtype='FILE_PATH')
    filter_glob: bpy.props.StringProperty(default='*.pnb', options={'HIDDEN'})

    def invoke(self, context, _event):
        self.filepath = self.filepath or os.path.splitext(bpy.data.filepath)[0] + '.pnb'
        context.window_manager.fileselect_add(self)
        return {'RUNNING_MODAL'}

    def execute(self, context):
        scene = context.scene
        before = scene.render.engine
        path = bpy.path.abspath(self.filepath)
        if not path:
            self.report({'ERROR'}, "No file name was given")
            return {'CANCELLED'}
        CaptureRequest.path = path
        try:
            scene.render.engine = 'PENUMBRA'
            bpy.ops.render.render()
        except RuntimeError as error:
            self.report({'ERROR'}, str(error))
            return {'CANCELLED'}
        finally:
            CaptureRequest.path = None
            scene.render.engine = before
        self.report({'INFO'}, f"Wrote {path}")
        return {'FINISHED'}
