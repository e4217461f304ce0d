# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: all tests of this folder, or those named after `--`. A test that is a generator
gives control back to Blender's event loop at each `yield`, with 'soon' for less time: nothing is drawn meanwhile
otherwise."""

import os
import sys
import time
import traceback
import unittest

import addon_utils
import bpy
import gpu

ADDON = os.environ['TEST_ADDON']
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [FOLDER, os.path.dirname(FOLDER)]
# Seconds between two looks at a test that waits.
STEP, SOON = 0.02, 0.005


def tests_of(suite):
    for item in suite:
        if isinstance(item, unittest.TestCase):
            yield item
        else:
            yield from tests_of(item)


def run(test):
    """A generator that ends with None, or with what failed."""
    try:
        test.setUp()
        steps = getattr(test, test._testMethodName)()
        if steps is not None:
            yield from steps
    except unittest.SkipTest as reason:
        return f"skipped: {reason}"
    except Exception:
        return traceback.format_exc()
    finally:
        test.doCleanups()
    return None


def run_all(tests):
    passed = failed = 0
    for test in tests:
        print(test.id(), "...", flush=True)
        start = time.monotonic()
        problem = yield from run(test)
        print(problem or "ok", f"{time.monotonic() - start:.1f} s", flush=True)
        for _ in range(5):      # Blender crashes if it quits before it has drawn a changed screen
            yield 'draw'
        passed += problem is None
        failed += problem is not None and not problem.startswith("skipped")
    print(f"Blender {bpy.app.version_string}, {gpu.platform.backend_type_get()}, {gpu.platform.renderer_get()}")
    print(f"{passed} passed, {failed} failed", flush=True)
    with open(os.path.join(os.environ['TEST_OUTPUT'], 'window-status'), 'w', encoding='ascii') as file:
        file.write('0' if passed and not failed else '1')


def main():
    names = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    if addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit("the add-on cannot be enabled")
    if os.environ['TEST_BACKEND'] not in {'', gpu.platform.backend_type_get()}:
        sys.exit(f"Blender draws with {gpu.platform.backend_type_get()}")   # falls back without an error
    sys.modules['penumbra'] = sys.modules[ADDON]
    bpy.context.preferences.view.show_splash = False
    loader = unittest.defaultTestLoader
    suite = loader.loadTestsFromNames(names) if names else loader.discover(FOLDER)
    steps = run_all(list(tests_of(suite)))

    def step():
        what = next(steps, 'end')
        if what == 'end':
            bpy.ops.wm.quit_blender()
            return None
        return SOON if what == 'soon' else STEP
    bpy.app.timers.register(step, first_interval=0.5, persistent=True)


main()
