# SPDX-License-Identifier: GPL-3.0-or-later
"""run_tests.py BUILD_DIR [TEST...]: tests the command-line tool as a user meets it."""

import os
import sys
import tempfile
import traceback

import test_compare
import test_damage
import test_render
import tool


def collect(wanted):
    tests = [(f'{module.__name__}.{name}', function) for module in (test_render, test_damage, test_compare)
             for name, function in vars(module).items() if name.startswith('test_')]
    return [(name, function) for name, function in tests if not wanted or any(part in name for part in wanted)]


def main():
    build = os.path.abspath(sys.argv[1])
    tests = collect(sys.argv[2:])
    passed = skipped = 0
    failed = []
    for name, function in tests:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            tool.build = build
            try:
                function()
                passed += 1
                print(f'ok       {name}', flush=True)
            except tool.Skip as reason:
                skipped += 1
                print(f'skipped  {name}: {reason}', flush=True)
            except Exception:
                failed.append(name)
                print(f'FAILED   {name}\n{traceback.format_exc()}', flush=True)
            os.chdir('/')
    if skipped:
        print(f'{skipped} skipped')
    print(f'{passed} passed, {len(failed)} failed')
    return 1 if failed or not passed else 0


sys.exit(main())
