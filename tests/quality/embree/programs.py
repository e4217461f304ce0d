# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of a build folder that the measurements need."""

import json
import os
import subprocess
import sys

SKIPPED = 77


class Programs:
    def __init__(self, build):
        self.build = os.path.abspath(build)
        if not os.path.exists(os.path.join(self.build, 'embree_baseline')):
            print('skipped: embree_baseline is not built (is Embree 3 installed?)')
            sys.exit(SKIPPED)

    def run(self, name, *arguments):
        result = subprocess.run([os.path.join(self.build, name), *map(str, arguments)], capture_output=True, text=True)
        if result.returncode:
            raise RuntimeError(f"{name} {' '.join(map(str, arguments))}: {result.stdout}{result.stderr}")
        return result.stdout

    def scene(self, name, path, *options):
        self.run('make_scene', *options, name, path)

    def trace(self, scene, output, samples, *options):
        """Ray traces the Shadow pass; its times."""
        return json.loads(self.run('embree_baseline', scene, '--samples', samples, '-o', output, '--json', *options))

    def compare(self, a, b, *options):
        return json.loads(self.run('penumbra', 'compare', a, b, '--pass', 'Shadow', '--json', *options))
