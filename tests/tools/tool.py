# SPDX-License-Identifier: GPL-3.0-or-later
"""Running the programs of a build folder."""

import os
import subprocess

build = None  # set by run_tests.py


class Skip(Exception):
    """The test cannot run here; the text says why."""


def penumbra(*arguments, code=0, environment=None):
    """(stdout, stderr) of the tool, which must end with the exit code."""
    result = subprocess.run([os.path.join(build, 'penumbra'), *map(str, arguments)], capture_output=True, text=True,
                            timeout=300, env={**os.environ, **(environment or {})})
    assert result.returncode == code, \
        f"penumbra {' '.join(map(str, arguments))}: exit status {result.returncode}, not {code}\n" \
        f"{result.stdout}{result.stderr}"
    return result.stdout, result.stderr


def refuses(*arguments, code, mentions):
    """The tool must fail with this code and one message that names all of `mentions`."""
    output, message = penumbra(*arguments, code=code)
    for text in mentions:
        assert text in message, f"{text!r} is not in: {message}"
    assert 'Traceback' not in message and message.startswith('penumbra: ')
    return output


def make_scene(name, path='scene.pnb', *options):
    subprocess.run([os.path.join(build, 'make_scene'), *options, name, path], check=True)
    return path
