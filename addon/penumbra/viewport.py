# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport. A region's engine exports the scene when Blender says that it changed, renders on the
library's thread and draws the newest picture: first a quick one, then all pixels and more samples, then the
reference."""

import collections
import time
import traceback
import weakref
from typing import NamedTuple

import bpy

from . import capi, command_line, device, draw, export, geometry, jobs, pictures, settings, statistics, view

# Seconds between two looks at the library's thread.
_POLL = 0.005
# Seconds without input before more samples are worth starting.
_REST = 0.12
# So many milliseconds Blender's event loop may stand still while first pictures are waited for, by all viewports
# together, and shown. Without a wait Blender would show the old picture once more, at the cost of the new one where the
# CPU draws both, and show the new one in a second turn.
_BLOCK_MS = 200
# The least that a picture is waited for.
_LEAST_WAIT_MS = 150
# Of the region's width and height, for the first picture.
_SCALES = (1.0, 0.7, 0.5, 0.35, 0.25)
# First pictures for which a scale that was too slow is not tried again.
_MEMORY = 40
# First pictures that are not waited for after many waits that were too short; after the first it is one.
_LONGEST_PAUSE = 3
# Of the user's latency, what is left for our part however long Blender takes to show a picture.
_LEAST_SHARE = 0.5

# What a run makes: a quick picture, all samples, all samples by the reference.
_FIRST, _SAMPLES, _REFERENCE = range(3)

_viewports = weakref.WeakSet()


class EngineHost:
    """What a viewport needs of the region's engine, which Blender frees when it likes."""

    def __init__(self, engine):
        self._engine = weakref.ref(engine)

    def tag_redraw(self):
        """False if the engine is no more."""
        try:
            self._engine().tag_redraw()
        except (AttributeError, ReferenceError):
            return False
        return True

    def pixel_scale(self, scene):
        """By the user's Viewport Pixel Size."""
        return 1.0 / self._engine().get_preview_pixel_size(scene)

    def show_status(self, text):
        self._engine().update_stats("Penumbra", text)


class Viewport:
    """What one region shows and what is being done for it. Lives as long as the region's engine."""
    def __init__(self, host):
        self._host = host
        self._exported = None
        self._kept = geometry.Kept()
        self._visibility = None     # what decides which objects this viewport shows
        self._version = 0           # of the exported scene
        self._wanted = None         # everything the picture depends on
        self._run = None
        self._next = None           # (kind, time) of the next run
        self._picture = None
        self._error = ''
        self._speed = Speed()
        _viewports.add(self)

    def close(self):
        _viewports.discard(self)
        self._stop()
        self._forget()
        self._kept.close()

    def _forget(self):
        if self._exported:
            self._exported.close()
        self._exported = None

    # ---- Called by Blender ----

    def update(self, context, depsgraph):
        """The scene may have changed."""
        self._guard(self._update, context, depsgraph)

    def draw(self, context, depsgraph):
        self._guard(self._draw, context, depsgraph)
        if self._picture and not self._error:
            self._guard(self._picture.draw, context.region)
        if self._error:
            draw.draw_message(context.region, self._error)
        self._show_status()
        if self._run is None:       # else both share the processor
            _turn.drawn = time.monotonic()

    def _guard(self, action, *arguments):
        """An exception that leaves a callback is printed at every redraw and seen by nobody."""
        try:
            action(*arguments)
        except Exception as error:
            self._fail(error)

    def _fail(self, error):
        self._stop()
        if self._exported is None:
            self._kept.close()      # of an export that did not get to its end
        if isinstance(error, (capi.Error, command_line.UsageError)):
            self._error = f"Penumbra cannot draw this viewport: {error}"
        else:
            traceback.print_exc()
            self._error = f"Penumbra cannot draw this viewport. Unexpected {type(error).__name__}: {error}"
        if getattr(error, 'result', None) == capi.CONTEXT_LOST:
            device.close()

    def _update(self, context, depsgraph):
        self._error = ''
        self._visibility = _visibility(context.space_data)
        shows = None if not any(self._visibility) else context.space_data
        changed = self.changes(depsgraph)
        self._forget()          # it may point to what is dropped now, whatever becomes of the new one
        self._kept.begin(changed)
        self._exported = export.SceneExport(depsgraph, kept=self._kept, shown_in=shows)
        self._kept.end()
        self._version += 1
        self._schedule(context, depsgraph)

    def changes(self, depsgraph):
        return geometry.changed_data(depsgraph)

    def is_stale(self):
        """Whether the scene may have changed without an update."""
        return self._exported is None

    def _draw(self, context, depsgraph):
        if self.is_stale() or self._visibility != _visibility(context.space_data):
            self._update(context, depsgraph)
        else:
            self._schedule(context, depsgraph)
        self._take_picture()
        if self.is_at_rest() and self._kept.has_changed_images():   # looks at all pixels of painted ones
            self._update(context, depsgraph)

    # ---- Deciding what to render ----

    def _schedule(self, context, depsgraph):
        # A change of our settings does not update the evaluated scene.
        scene = depsgraph.scene
        wanted = Wanted(self._version, self.read_view(context, depsgraph.scene_eval), settings.viewport_key(scene),
                        self.image_wanted(scene), self._host.pixel_scale(scene))
        if wanted != self._wanted:
            self._wanted = wanted
            self._error = ''
            self._next = (_FIRST, 0.0)
            # A quick picture is finished: else none would be seen while the input does not pause.
            if self._run and self._run.kind != _FIRST:
                self._stop_run()
        self._start_next(scene)

    def _start_next(self, scene):
        if self._run or not self._next or self._error or time.monotonic() < self._next[1]:
            _wake()
            return
        if bpy.app.is_job_running('RENDER'):
            self._next = self._next[0], time.monotonic() + _REST
            _wake()
            return
        kind, self._next = self._next[0], None
        self._run = Run(kind, self._wanted, self._exported, scene, self._speed)
        if kind == _FIRST:
            self._wait_for_first()
        _wake()

    def _wait_for_first(self):
        run, left = self._run, _turn.left_ms()
        if left > 0 and self._speed.is_worth_waiting(run.share):
            run.job.wait(left)
            _turn.waited_ms += run.elapsed_ms()
            self._speed.note_wait(run.share, run.job.is_done())

    def _take_picture(self):
        """The newest picture of the run, if there is a newer one; then what follows."""
        run = self._run
        if run is None:
            return
        try:
            samples = run.job.samples_done()
            if samples > run.samples_taken:
                if run.kind == _FIRST:
                    self._speed.add(run.technique, run.share, run.elapsed_ms())
                self._picture = run.wanted.image.picture(run)
        except capi.Error as error:
            self._stop_run()
            if error.result != capi.CANCELLED:
                raise
            self._next = self._next or (_FIRST, 0.0)
            return
        if run.samples_taken == run.job.samples:
            self._finish(run)

    def read_view(self, context, scene):
        return view.read(context, scene)

    def image_wanted(self, scene):
        return pictures.wanted(scene.penumbra, self._exported.scene)

    def _finish(self, run):
        run.record_statistics()
        self._stop_run()
        if self._next is None and run.wanted == self._wanted:
            follows = run.following_kind()
            if follows is not None:
                self._next = follows, time.monotonic() + (_REST if run.kind == _FIRST else 0.0)
        _wake()

    def _stop_run(self):
        if self._run:
            self._run.job.discard()
            self._run = None

    def _stop(self):
        self._stop_run()
        self._next = None

    # ---- Between Blender's calls ----

    def poll(self):
        """Asks for a redraw when there is something to draw or to start; whether to be asked again."""
        due = self._next is not None and self._run is None and time.monotonic() >= self._next[1]
        if (due or self._run and self._run.has_news()) and not self._host.tag_redraw():
            self._stop()            # nothing shows it any more, or not for now: then it starts anew when drawn
            self._wanted = None
        return not self.is_at_rest()

    def is_at_rest(self):
        return self._run is None and self._next is None

    def _show_status(self):
        self._host.show_status(self._error.splitlines()[0] if self._error else
                               self._picture.label if self._picture else "Preparing")


class Wanted(NamedTuple):
    """Everything a picture depends on, compared by value."""
    version: int            # of the exported scene
    view: view.View
    key: tuple              # of the settings
    image: pictures.ImageWanted
    pixel_scale: float


class Run:
    """One job and the picture it makes."""

    def __init__(self, kind, wanted, exported, scene, speed):
        self.kind, self.wanted = kind, wanted
        options = scene.penumbra
        self.share = speed.choose(options.viewport_latency) if kind == _FIRST else 1.0
        self.scale = wanted.pixel_scale * self.share
        self.samples_taken = 0
        self._seen = 0
        is_single = bool(wanted.image.title)
        samples = 1 if is_single else options.viewport_samples
        self._options = options.technique, options.use_refine, is_single
        width, height = (max(1, int(size * self.scale + 0.5)) for size in wanted.view[:2])
        values = settings.for_viewport(scene, width, height, view.crop(wanted.view, width, height),
                                       1 if kind == _FIRST else samples, kind == _REFERENCE,
                                       wanted.image.image_pass, self.share, kind == _FIRST)
        self.technique = values.technique.decode()
        self.size = width, height
        self.crop = tuple(values.crop)
        view.fill_camera(exported.scene.camera, wanted.view)
        exported.use_own_techniques(kind != _REFERENCE, self.share)
        self._started = time.monotonic()
        self._exported, self._values = exported, values
        self._context = device.context(settings.backend())
        self.job = jobs.Job(self._context, exported.scene, values)

    def record_statistics(self):
        statistics.record("Viewport", self._exported, self._values, self.job.timings(), self._context)

    def elapsed_ms(self):
        return (time.monotonic() - self._started) * 1000.0

    def has_news(self):
        """A new picture or an error, once each."""
        try:
            samples = self.job.samples_done()
        except capi.Error:
            samples = -1
        news = samples != self._seen
        self._seen = samples
        return news

    def following_kind(self):
        technique, refine, is_single = self._options
        # A quick picture may be made with what an earlier one left: it is never the last.
        if self.kind == _FIRST and (self.share < 1.0 or not is_single):
            return _SAMPLES
        if self.kind != _REFERENCE and refine and not is_single and technique != 'REFERENCE':
            return _REFERENCE
        return None


class Speed:
    """How long first pictures take at each scale, to choose the largest that meets the latency."""

    def __init__(self):
        self._measured = {}     # scale: (milliseconds, when, in pictures)
        self._last = None       # scale
        self._count = 0
        self._known = set()     # techniques whose shaders are compiled
        self._pauses = {}       # scale: (first pictures not waited for after the last wait, until when), in pictures

    def add(self, technique, scale, ms):
        if technique not in self._known:
            self._known.add(technique)
            return
        self._count += 1
        self._measured[scale] = ms, self._count
        self._last = scale

    def expected(self, scale):
        """As measured lately, else in proportion to the last picture: part of its time does not depend on size."""
        ms, when = self._measured.get(scale, (0.0, -_MEMORY))
        if self._count - when < _MEMORY:
            return ms
        return self._measured[self._last][0] * scale / self._last if self._last else float('inf')

    def choose(self, latency_ms):
        if self._last is None:
            return _SCALES[2]
        left = max(latency_ms - _turn.display_ms(), _LEAST_SHARE * latency_ms)
        return next((scale for scale in _SCALES if self.expected(scale) <= left), _SCALES[-1])

    def is_worth_waiting(self, scale):
        return self._count >= self._pauses.get(scale, (0, 0))[1]

    def note_wait(self, scale, is_done):
        """One that was too short may have met a moment in which the machine did something else."""
        pause = 0 if is_done else min(max(1, 2 * self._pauses.get(scale, (0, 0))[0]), _LONGEST_PAUSE)
        self._pauses[scale] = pause, self._count + 1 + pause


class Turn:
    """One turn of Blender's event loop: what viewports have waited in it, and how long Blender takes to show what they
    drew."""

    def __init__(self):
        self.waited_ms = 0.0
        self.drawn = None       # when a viewport that renders nothing ended drawing
        self._display = collections.deque(maxlen=5)

    def left_ms(self):
        return int(max(_BLOCK_MS - self.display_ms(), _LEAST_WAIT_MS) - self.waited_ms)

    def display_ms(self):
        return sorted(self._display)[len(self._display) // 2] if self._display else 0.0

    def begin(self):
        if self.drawn is not None:
            self._display.append((time.monotonic() - self.drawn) * 1000.0)
        self.waited_ms, self.drawn = 0.0, None


_turn = Turn()


_KINDS = [item.identifier for item in bpy.types.SpaceView3D.bl_rna.properties
          if item.identifier.startswith('show_object_viewport_')]


def _visibility(space):
    """Local views, local collections and hidden kinds of objects, which come and go without an update of the scene."""
    hidden = tuple(name for name in _KINDS if not getattr(space, name))
    return bool(space.local_view), space.use_local_collections, hidden


def _wake():
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_POLL, persistent=True)


def _tick():
    _turn.begin()
    busy = [viewport.poll() for viewport in list(_viewports)]
    return _POLL if jobs.sweep() or any(busy) else None


def all_at_rest():
    """Whether every viewport shows the last picture it is going to show."""
    return all(viewport.is_at_rest() for viewport in _viewports)


def unregister():
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    for viewport in list(_viewports):
        viewport.close()
