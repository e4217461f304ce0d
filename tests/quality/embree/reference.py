# SPDX-License-Identifier: GPL-3.0-or-later
"""reference.py BUILD_DIR: REFERENCE against ray tracing, for every kind of light."""

import os
import sys
import tempfile

from programs import Programs

LIGHTS = ('rectangle', 'ellipse', 'point', 'spot', 'sun')
# Flat faces only: on curved ones, and on the sides of thin bars, a few grazing pixels decide, where next to no light
# arrives and the ratio of two small numbers says little.
SCENES = ('half-plane', 'slats', 'discs', 'box', 'stairs')
# The figure REFERENCE must keep against Cycles. 16 x 16 light samples on their own leave up to 0.010 here, because a
# penumbra whose edge is parallel to the rows of samples has steps of 1/16.
LIMIT = 0.015


def measure(programs, scene, light):
    programs.scene(scene, 'scene.pnb', '--light', light, '--size', '192x108')
    programs.run('penumbra', 'render', 'scene.pnb', '-t', 'reference', '--light-samples', 16, '-o', 'reference.exr')
    programs.trace('scene.pnb', 'traced.pfm', 400)
    return programs.compare('reference.exr', 'traced.pfm')


def main():
    programs = Programs(sys.argv[1])
    passed = failed = 0
    print(f"{'scene':12} {'light':10} {'RMSE':>8} {'SSIM':>8} {'above 0.2':>10}")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for scene in SCENES:
            for light in LIGHTS:
                result = measure(programs, scene, light)
                good = result['rmse'] <= LIMIT
                passed, failed = passed + good, failed + (not good)
                print(f"{scene:12} {light:10} {result['rmse']:8.5f} {result['ssim']:8.5f} "
                      f"{100 * result['share_above_0.2']:8.3f} %{'' if good else '  ABOVE ' + str(LIMIT)}", flush=True)
        os.chdir('/')
    print(f'{passed} passed, {failed} failed')
    return 1 if failed else 0


sys.exit(main())
