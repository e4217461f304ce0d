# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport shows: the picture, or by *Viewport View* something that helps to understand it."""

from typing import NamedTuple

from . import capi, draw


class ImageWanted(NamedTuple):
    image_pass: int         # of the library
    index: int              # among the images of that pass
    picture: type           # what draws it
    title: str = ''         # of what one sample shows; '': all samples count


class Picture:
    """The newest picture of a run."""

    def __init__(self, run):
        pixels, run.samples_taken = run.job.picture(run.wanted.image.index)
        self.texture = self.make_texture(run.job, pixels)
        self.size = run.job.width, run.job.height
        self._crop, self._size = run.crop, run.size
        self.label = self.describe(run)
        if run.scale < 1.0:
            self.label += f", {run.scale:.0%} resolution"

    def describe(self, run):
        return f"{run.technique}, sample {run.samples_taken} of {run.job.samples}"

    def make_texture(self, job, pixels):
        return draw.make_texture(job.width, job.height, pixels)

    def place(self, region):
        """x, y, width, height in pixels of the region."""
        x, y = region.width / self._size[0], region.height / self._size[1]
        return self._crop[0] * x, self._crop[1] * y, self._crop[2] * x, self._crop[3] * y

    def draw(self, region):
        draw.draw_picture(self.texture, *self.place(region))


class ShadowPicture(Picture):
    """The Shadow pass, or that of a light."""
    mode = draw.SHOW

    def make_texture(self, job, pixels):
        return draw.make_shadow_texture(job.width, job.height, pixels)

    def draw(self, region):
        draw.draw_shadow(self.texture, self.size, self.place(region), self.mode)


class ClassesPicture(ShadowPicture):
    """Lit, penumbra and umbra."""
    mode = draw.CLASSIFY


class RampPicture(ShadowPicture):
    """Metres, from 0 to the largest there are."""
    mode = draw.RAMP
    unit = " m"

    def make_texture(self, job, pixels):
        self._largest = max(pixels)
        return draw.make_shadow_texture(job.width, job.height, pixels, channels=1)

    def describe(self, run):
        range_ = f"0 to {self._largest:.3g}{self.unit}" if self._largest > 0.0 else "no blocker"
        return f"{run.wanted.image.title}: {range_}"

    def draw(self, region):
        draw.draw_shadow(self.texture, self.size, self.place(region), self.mode, (self._largest, 0.0, 0.0, 1.0))


class MapPicture(RampPicture):
    """A shadow map's own depths."""
    mode = draw.MAP

    def describe(self, run):
        return f"{run.wanted.image.title}: near is dark, far is bright"


# What viewports show of one light: pass, picture, title.
_LIGHT_VIEWS = {'LIGHT': (capi.PASS_LIGHT_SHADOWS, ShadowPicture, ''),
                'PENUMBRA': (capi.PASS_PENUMBRAE, RampPicture, "Penumbra width"),
                'BLOCKER': (capi.PASS_BLOCKERS, RampPicture, "Distance of the average blocker"),
                'MAP': (capi.PASS_SHADOW_MAPS, MapPicture, "Shadow map")}


def wanted(options, scene):
    """ImageWanted by the debug view, of a pnb_scene."""
    if options.viewport_view == 'FINAL':
        return ImageWanted(capi.PASS_COMBINED, 0, Picture)
    if options.viewport_view in {'SHADOW', 'CLASSES'}:
        return ImageWanted(capi.PASS_SHADOW, 0, ShadowPicture if options.viewport_view == 'SHADOW' else ClassesPicture)
    names = [light.name.decode() for light in scene.lights[:scene.light_count]]
    name = options.viewport_light
    if not names or options.viewport_view == 'LIGHT' and name not in names:
        return ImageWanted(capi.PASS_SHADOW, 0, ShadowPicture)
    index = names.index(name) if name in names else 0   # else the first light's
    image_pass, picture, title = _LIGHT_VIEWS[options.viewport_view]
    return ImageWanted(image_pass, index, picture, f"{title} of {names[index]}" if title else '')
