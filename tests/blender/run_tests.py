# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: all tests of this folder, or those named after `--`."""

import os
import sys
import unittest

import addon_utils
import bpy

# As an extension the add-on lies in the package of its repository.
ADDON = os.environ['TEST_ADDON']
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, FOLDER)


def main():
    names = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    if addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit("the add-on cannot be enabled")
    sys.modules['penumbra'] = sys.modules[ADDON]
    loader = unittest.defaultTestLoader
    suite = loader.loadTestsFromNames(names) if names else loader.discover(FOLDER)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    # A test may fail in several subtests.
    failed = len({getattr(test, 'test_case', test).id() for test, _trace in result.failures + result.errors})
    skipped = f", {len(result.skipped)} skipped" if result.skipped else ""
    print(f"Blender {bpy.app.version_string}{skipped}")
    print(f"{result.testsRun - failed - len(result.skipped)} passed, {failed} failed", flush=True)
    sys.exit(0 if result.testsRun and not failed else 1)


main()
