# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders on the library's thread that the user interface never waits for."""

from ctypes import byref, c_float, c_uint32, c_void_p

from . import capi

# Of an image of each pass that a viewport shows.
_CHANNELS = {capi.PASS_COMBINED: 4, capi.PASS_SHADOW: 3, capi.PASS_LIGHT_SHADOWS: 3, capi.PASS_BLOCKERS: 1,
             capi.PASS_PENUMBRAE: 1, capi.PASS_SHADOW_MAPS: 1}
# Cancelled jobs that have not ended yet: destroying one waits for it.
_ending = []


class Job:
    """One started render."""

    def __init__(self, context, scene, settings):
        self._handle = c_void_p()
        self.samples = settings.samples
        self.width, self.height = settings.crop[2:]
        self.channels = _CHANNELS[settings.passes]
        capi.library().render_start(context, byref(scene), byref(settings), byref(self._handle))

    def samples_done(self):
        """How many samples there is a picture of. Raises what ended the job."""
        count = c_uint32()
        capi.library().job_copy_image(self._handle, 0, None, 0, byref(count))
        return count.value

    def is_done(self):
        return capi.library().job_wait(self._handle, 0, None) != capi.TIMEOUT

    def wait(self, milliseconds):
        capi.library().job_wait(self._handle, milliseconds, None)

    def picture(self, index):
        """(floats of an image as ctypes array, their number of samples). Valid as long as the job."""
        if self.is_done():
            image = capi.Image()
            capi.library().job_get_image(self._handle, index, byref(image))
            return (c_float * (self.channels * self.width * self.height)).from_address(image.pixels), self.samples
        count = c_uint32()
        pixels = (c_float * (self.channels * self.width * self.height))()
        capi.library().job_copy_image(self._handle, index, pixels, len(pixels), byref(count))
        return pixels, count.value

    def messages(self):
        library = capi.library()
        return [library.job_message(self._handle, index).decode(errors='replace')
                for index in range(library.job_message_count(self._handle))]

    def timings(self):
        for index in range(capi.library().job_timing_count(self._handle)):
            timing = capi.Timing()
            capi.library().job_get_timing(self._handle, index, byref(timing))
            yield timing

    def discard(self):
        """Ends it without waiting."""
        capi.library().job_cancel(self._handle)
        _ending.append(self._handle)
        sweep()


def sweep():
    """Frees the discarded jobs that have ended; whether there are more."""
    for handle in list(_ending):
        if _has_ended(handle):
            _ending.remove(handle)
            capi.library().destroy('job', handle)
    return bool(_ending)


def _has_ended(handle):
    try:
        return capi.library().job_wait(handle, 0, None) != capi.TIMEOUT
    except capi.Error:
        return True
