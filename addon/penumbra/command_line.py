# SPDX-License-Identifier: GPL-3.0-or-later
"""Options behind `--` on Blender's command line: --penumbra-technique ID, --penumbra-backend NAME, --penumbra-stats and
--penumbra-capture PATH. They go before what the .blend and the preferences say."""

import sys

_PREFIX = '--penumbra-'
_WITH_VALUE = {'technique', 'backend', 'capture'}
_FLAGS = {'stats'}


class UsageError(Exception):
    """An option that cannot be followed."""


def options():
    """Values by option name."""
    arguments = iter(sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else [])
    found = {}
    for argument in arguments:
        if not argument.startswith(_PREFIX):
            continue
        name = argument[len(_PREFIX):]
        if name in _FLAGS:
            found[name] = True
        elif name in _WITH_VALUE:
            found[name] = next(arguments, None)
            if not found[name]:
                raise UsageError(f"{argument} needs a value")
        else:
            known = ', '.join(_PREFIX + name for name in sorted(_WITH_VALUE | _FLAGS))
            raise UsageError(f"unknown option {argument}; there are: {known}")
    return found
