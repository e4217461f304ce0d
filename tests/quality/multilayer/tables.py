# SPDX-License-Identifier: GPL-3.0-or-later
"""tables.py BUILD_DIR [times|errors|layers...] [SCENE...]: see run.sh. ROUNDS: measured renders of each (default 5)."""

import json
import os
import statistics
import subprocess
import sys
import tempfile

SCENES = ('benchmark', 'cubes')
SIZE = '1280x720'
SETTINGS = {
    'default': {},
    'epsilon x5': {'merge_distance': 10},
    'five levels': {'levels': 5},
    'sub': {'subsampling': 'true'},
    'all': {'merge_distance': 10, 'levels': 5, 'subsampling': 'true'},
    'MIP map': {'pyramid': 'MIP_MAP'},
    'map 512': {'map': 512},
    'map 2048': {'map': 2048},
    'map 2048, base sub': {'map': 2048, 'base_subsampling': 1},
    '1 lookup': {'lookups': 1},
}
ROWS = {'Scene rendering': ('G-buffer', 'Tiles', 'Irradiance', 'Shading', 'Resolve and read-back'),
        'Shadow map': ('Shadow map', 'Min-max pyramid'),
        'Frag counting': ('Fragment count',), 'Scan': ('Fragment scan',), 'Frag collecting': ('Fragment collect',),
        'Frag sorting': ('Fragment sort',), 'Filtering': ('Fragment filter',),
        'Soft shadows': ('Visibility', 'Interpolation')}
PARTS = ('times', 'errors', 'layers')
LAYERS = (1, 2, 4, 16, 0)
OVERLAPPING = ('slats', 'discs', 'lantern')


class Tool:
    def __init__(self, build):
        self.build = build

    def run(self, program, *arguments):
        command = [os.path.join(self.build, program), *map(str, arguments)]
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout

    def scene(self, name):
        self.run('make_scene', name, name + '.pnb')
        return name + '.pnb'

    def bench(self, scene, technique, setting):
        self.run('penumbra', 'bench', scene, '-s', SIZE, '-n', 1, *options(technique, setting), '--json', 'times.json')
        with open('times.json') as file:
            return json.load(file)['techniques'][0]

    def render(self, scene, size, technique, setting, output):
        self.run('penumbra', 'render', scene, '-s', size, *options(technique, setting), '-o', output)

    def error(self, scene, size, technique, setting):
        self.render(scene, size, technique, setting, 'image.exr')
        return json.loads(self.run('penumbra', 'compare', 'image.exr', 'truth.exr', '--json'))['rmse']


def options(technique, setting):
    result = ['-t', technique]
    for name, value in setting.items():
        result += ['--map-size', value] if name == 'map' else ['-p', f'{name}={value}']
    return result


def wall_and_passes(times):
    return times['wall_ms']['median'], {item['name']: item['gpu_ms']['median'] for item in times['passes']}


def times_of(tool, scene, rounds):
    """Settings take turns: {setting: [(wall, {pass: ms})]}."""
    runs = {name: [] for name in (*SETTINGS, 'ESSM', 'PCSS')}
    for _ in range(rounds):
        for name in runs:
            technique = 'multilayer' if name in SETTINGS else name
            runs[name].append(wall_and_passes(tool.bench(scene, technique, SETTINGS.get(name, {}))))
    return runs


def print_times(scene, runs):
    print(f"\n{scene}, {SIZE}, ms, medians of {len(runs['default'])}")
    print(f"{'':16}" + ''.join(f'{name:>20}' for name in runs))
    for row, passes in ROWS.items():
        cells = (statistics.median(sum(own.get(name, 0.0) for name in passes) for _, own in runs[setting])
                 for setting in runs)
        print(f'{row:16}' + ''.join(f'{cell:20.1f}' for cell in cells))
    walls = {name: statistics.median(wall for wall, _ in own) for name, own in runs.items()}
    print(f"{'Frame':16}" + ''.join(f'{wall:20.1f}' for wall in walls.values()))
    print(f"{'default / it':16}" + ''.join(f"{walls['default'] / wall:20.2f}" for wall in walls.values()))


def print_errors(tool, scene, path):
    tool.render(path, SIZE, 'reference', {}, 'truth.exr')
    errors = {name: tool.error(path, SIZE, 'multilayer', setting) for name, setting in SETTINGS.items()}
    errors.update((name, tool.error(path, SIZE, name, {})) for name in ('ESSM', 'PCSS'))
    print(f'\n{scene}, RMSE against REFERENCE of 16 x 16')
    print(f"{'':16}" + ''.join(f'{name:>20}' for name in errors))
    print(f"{'RMSE':16}" + ''.join(f'{error:20.5f}' for error in errors.values()))
    print(f"{'to default':16}" + ''.join(f"{error / errors['default']:20.2f}" for error in errors.values()), flush=True)


def print_layers(tool):
    print('\nRMSE at 640x360 against REFERENCE of 32 x 32, by number of layers')
    print(f"{'':10}" + ''.join(f"{layers or 'all':>9}" for layers in LAYERS) + '     PCSS     ESSM  all/PCSS  all/ESSM')
    for scene in OVERLAPPING:
        path, size = tool.scene(scene), '640x360'
        tool.run('penumbra', 'render', path, '-s', size, '-t', 'reference', '--light-samples', 32, '-o', 'truth.exr')
        errors = [tool.error(path, size, 'multilayer', {'depth_layers': layers}) for layers in LAYERS]
        pcss, essm = (tool.error(path, size, technique, {}) for technique in ('pcss', 'essm'))
        print(f'{scene:10}' + ''.join(f'{error:9.4f}' for error in (*errors, pcss, essm)) +
              f'{errors[-1] / pcss:10.2f}{errors[-1] / essm:10.2f}', flush=True)


def main():
    tool = Tool(os.path.abspath(sys.argv[1]))
    parts = [part for part in PARTS if part in sys.argv[2:]] or PARTS
    scenes = [scene for scene in sys.argv[2:] if scene not in PARTS] or SCENES
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for scene in scenes if {'times', 'errors'} & set(parts) else ():
            path = tool.scene(scene)
            if 'times' in parts:
                print_times(scene, times_of(tool, path, int(os.environ.get('ROUNDS', 5))))
            if 'errors' in parts:
                print_errors(tool, scene, path)
        if 'layers' in parts:
            print_layers(tool)
        os.chdir('/')


main()
