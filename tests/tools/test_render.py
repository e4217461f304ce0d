# SPDX-License-Identifier: GPL-3.0-or-later
"""info, render and bench."""

import json
import os
import signal
import subprocess
import time

import files
import tool
from tool import make_scene, penumbra, refuses

SIZE = ('--size', '96x54')


def info():
    return json.loads(penumbra('info', '--json')[0])


# ---- info ----

def test_info_tells_what_json_tells():
    text, _ = penumbra('info')
    data = info()
    assert any(backend['result'] == 'PNB_OK' for backend in data['backends'])
    assert data['context']['max_texture_size'] >= 8192
    for backend in data['backends']:
        assert backend['backend'] in text
    for technique in data['techniques']:
        assert f"  {technique['id']}: {technique['label']}" in text
        assert technique['description'] in text and technique['paper'] in text
        for parameter in technique['parameters']:
            assert parameter['name'] in text and parameter['description'] in text
            assert parameter['minimum'] <= parameter['default'] <= parameter['maximum']
            assert parameter['type'] in ('float', 'int', 'bool', 'enum')
            assert (parameter['type'] == 'enum') == bool(parameter['items'])


def test_info_without_opengl_says_why_and_fails():
    _, message = penumbra('info', code=3, environment={'PENUMBRA_BACKEND': 'egl:99'})
    assert 'egl:99' in message
    output, _ = penumbra('info', '--json', code=3, environment={'PENUMBRA_BACKEND': 'egl:99'})
    assert 'context' not in json.loads(output) and json.loads(output)['techniques']


def test_help_and_usage():
    for arguments in (('--help',), ('info', '--help'), ('render', '-h'), ('compare', '--help'), ('bench', '--help')):
        output, message = penumbra(*arguments)
        assert output.startswith('usage: penumbra') and not message
        assert all(len(line) <= 100 for line in output.splitlines())
    penumbra(code=2)
    refuses('paint', code=2, mentions=('paint', 'render'))
    refuses('render', code=2, mentions=('capture',))
    refuses('compare', 'one.pfm', code=2, mentions=('two images',))
    assert penumbra('--version')[0].startswith('penumbra ')


# ---- render: formats ----

def test_formats_hold_the_same_pixels():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    penumbra('render', scene, '-o', 'all.exr')
    for name in ('Combined', 'Depth', 'Normal', 'Shadow', 'Shadow.rectangle'):
        penumbra('render', scene, '--pass', name, '-o', 'one.pfm')
        width, height, channels, _ = files.read_pfm('one.pfm')
        assert (width, height, channels) == (96, 54, 1 if name == 'Depth' else 3)
        output, _ = penumbra('compare', 'all.exr', 'one.pfm', '--pass', name, '--max-rmse', 0, '--json')
        assert json.loads(output)['max'] == 0
        penumbra('render', scene, '--pass', name, '-o', 'one.exr')
        penumbra('compare', 'one.exr', 'one.pfm', '--pass', name, '--max-rmse', 0)


def test_png_is_srgb_of_the_linear_pixels():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    for exposure in (0, 1):
        penumbra('render', scene, '-o', 'image.png', '--exposure', exposure)
        penumbra('render', scene, '-o', 'image.pfm')
        _, _, _, linear = files.read_pfm('image.pfm')
        width, height, channels, shown = files.read_png('image.png')
        assert (width, height) == (96, 54) and channels in (3, 4)
        for y in range(height):
            for x in range(width):
                for c in range(3):
                    value = min(max(linear[(y * width + x) * 3 + c] * 2 ** exposure, 0), 1)
                    encoded = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
                    byte = shown[((height - 1 - y) * width + x) * channels + c]
                    assert abs(byte - 255 * encoded) <= 0.51, (x, y, c, byte, 255 * encoded)


def test_depth_and_normal_as_png_can_be_looked_at():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    for name in ('Depth', 'Normal'):
        penumbra('render', scene, '--pass', name, '-o', 'image.png')
        values = set(files.read_png('image.png')[3])
        assert len(values) > 3, f"{name} is flat"
    penumbra('render', scene, '--pass', 'Depth', '-o', 'image.png')
    _, _, channels, shown = files.read_png('image.png')
    assert channels == 1 and max(shown) == 255 and min(shown) == 0


# ---- render: options ----

def test_size_keeps_the_height_of_the_view():
    scene = make_scene('box', 'scene.pnb', '--size', '96x54')
    penumbra('render', scene, '--pass', 'Depth', '-o', 'wide.pfm')
    penumbra('render', scene, '--pass', 'Depth', '-o', 'square.pfm', '--size', '54x54')
    _, _, _, wide = files.read_pfm('wide.pfm')
    _, _, _, square = files.read_pfm('square.pfm')
    for y in range(54):
        for x in range(54):
            # The same rays but for the rounding of the window: 1e-4 of depths of about 7 m.
            assert abs(square[y * 54 + x] - wide[y * 96 + 21 + x]) <= 1e-4 * square[y * 54 + x], (x, y)


def test_crop_equals_the_part_of_the_whole():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    penumbra('render', scene, '-o', 'whole.pfm')
    penumbra('render', scene, '-o', 'part.pfm', '--crop', '30,10,40,20')
    _, _, _, whole = files.read_pfm('whole.pfm')
    width, height, _, part = files.read_pfm('part.pfm')
    assert (width, height) == (40, 20)
    for y in range(20):
        start = ((10 + y) * 96 + 30) * 3
        for a, b in zip(part[y * 120:(y + 1) * 120], whole[start:start + 120]):
            # The crop's view is computed anew: positions differ in the last bit, shadow edges by a little more.
            assert abs(a - b) <= 1e-4, f"row {y}: {a} and {b}"


def test_technique_and_parameters_reach_the_library():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    images = {}
    for name, options in {'default': (), 'hard': ('-t', 'hard'), 'Hard': ('-t', 'Hard'),
                          'few': ('-t', 'PCSS', '-p', 'filter_samples=4'),
                          'grid': ('-t', 'pcss', '-p', 'pattern=grid'),
                          'map': ('--map-size', '64'), 'aa': ('--samples', '4')}.items():
        penumbra('render', scene, '--pass', 'Shadow', '-o', 'image.pfm', *options)
        images[name] = files.read_pfm('image.pfm')[3]
    assert images['hard'] == images['Hard']
    assert len(set(images.values())) == len(images) - 1, "an option has no effect"


def test_every_default_may_be_given_by_name():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    for technique in info()['techniques']:
        options = ['-t', technique['id'], '--light-samples', '2']
        penumbra('render', scene, '-o', 'plain.pfm', *options)
        for parameter in technique['parameters']:
            value = parameter['default']
            if parameter['type'] == 'enum':
                value = parameter['items'][int(value)].lower()
            elif parameter['type'] == 'bool':
                value = 'true' if value else 'false'
            options += ['-p', f"{parameter['name']}={value}"]
        penumbra('render', scene, '-o', 'given.pfm', *options)
        assert files.read_pfm('plain.pfm') == files.read_pfm('given.pfm'), technique['id']


def test_bad_options_are_named_with_what_is_allowed():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    ids = [technique['id'] for technique in info()['techniques']]
    render = ('render', scene, '-o', 'image.pfm')
    refuses(*render, '-t', 'magic', code=2, mentions=['-t', 'magic', *ids])
    refuses(*render, '-t', 'PCSS', '-p', 'magic=1', code=2, mentions=('magic', 'PCSS', 'filter_samples'))
    refuses(*render, '-t', 'PCSS', '-p', 'filter_samples', code=2, mentions=('NAME=VALUE',))
    for value in ('0', '1e9', '2.5', 'many', 'nan', ''):
        refuses(*render, '-p', f'filter_samples={value}', code=2, mentions=('filter_samples', ' 1 to ', f"'{value}'"))
    refuses(*render, '-p', 'pattern=round', code=2, mentions=('pattern', 'GRID', 'round'))
    refuses(*render, '-p', 'min_max=maybe', code=2, mentions=('min_max', 'true or false', 'maybe'))
    for option, values in {'--size': ('0x5', '5', '5x', '-1x5', '5x5x5'), '--samples': ('0', '-1', 'x', '4097'),
                           '--map-size': ('8', '1e3'), '--light-samples': ('65',), '--repeat': ('0',),
                           '--crop': ('1,2,3', '0,0,0,5', '90,0,10,10'), '--pass': ('Magic', 'shadow'),
                           '--exposure': ('inf', 'a')}.items():
        for value in values:
            refuses(*render, f'{option}={value}', code=2, mentions=(option, value))
    refuses(*render, '--pass', 'Shadow.Magic', code=2, mentions=('Magic', 'rectangle'))
    refuses('render', scene, '-o', 'image.gif', code=2, mentions=('image.gif', '.exr'))
    refuses('render', scene, code=2, mentions=('-o',))
    refuses(*render, '--backend', 'glide', code=2, mentions=('glide',))
    assert os.listdir() == ['scene.pnb'], "something was written"


# ---- render: whole files or none ----

def test_bad_captures_and_folders_leave_nothing():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    with open(scene, 'rb') as file:
        data = file.read()
    with open('cut.pnb', 'wb') as file:
        file.write(data[:len(data) // 2])
    with open('old.exr', 'wb') as file:
        file.write(b'old')
    refuses('render', 'missing.pnb', '-o', 'old.exr', code=3, mentions=('missing.pnb',))
    refuses('render', 'cut.pnb', '-o', 'old.exr', code=3, mentions=('cut.pnb',))
    refuses('render', scene, '-o', 'nowhere/image.exr', code=3, mentions=('nowhere/image.exr',))
    refuses('render', scene, '-o', 'old.exr', '--size', '70000x2', code=3, mentions=('70000',))
    with open('old.exr', 'rb') as file:
        assert file.read() == b'old'
    assert sorted(os.listdir()) == ['cut.pnb', 'old.exr', 'scene.pnb']


def test_a_full_disk_is_an_error():
    scene = make_scene('box', 'scene.pnb', '--size', '200x200')
    for name in ('image.exr', 'image.png', 'image.pfm'):
        limited = ['sh', '-c', 'trap "" XFSZ; ulimit -f 8; exec "$@"', 'sh', os.path.join(tool.build, 'penumbra')]
        result = subprocess.run([*limited, 'render', scene, '-o', name, '--exposure', '3'], capture_output=True,
                                text=True, env={**os.environ, 'MESA_SHADER_CACHE_DISABLE': 'true'})
        if name == 'image.png' and result.returncode == 0:
            assert os.path.getsize(name) <= 8 * 1024  # it was small enough
            os.remove(name)
            continue
        assert result.returncode == 3 and name in result.stderr, f"{name}: {result.returncode} {result.stderr}"
    assert os.listdir() == ['scene.pnb']


def test_interrupting_ends_soon_and_leaves_nothing():
    scene = make_scene('benchmark', 'scene.pnb', '--size', '640x360')
    process = subprocess.Popen([os.path.join(tool.build, 'penumbra'), 'render', scene, '-t', 'reference',
                                '--light-samples', '64', '--samples', '64', '-o', 'image.exr'],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(2)
    assert process.poll() is None, "the render was to take minutes"
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=60)
    assert process.returncode == 3 and 'cancel' in message, (process.returncode, message)
    assert os.listdir() == ['scene.pnb']


def test_repeats_are_identical():
    scene = make_scene('all-lights', 'scene.pnb', *SIZE)
    output, _ = penumbra('render', scene, '-o', 'image.exr', '--repeat', '5')
    assert '5 renders, bit-identical' in output and 'median of 5' in output


# ---- bench ----

def test_bench_reports_every_technique():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    output, _ = penumbra('bench', scene, '--all', '-n', '3', '--light-samples', '2', '--json', 'bench.json',
                         '-p', 'filter_samples=8')
    with open('bench.json') as file:
        report = json.load(file)
    assert [row['id'] for row in report['techniques']] == [row['id'] for row in info()['techniques']]
    assert report['runs'] == 3 and report['machine']['renderer'] and report['settings']['width'] == 96
    settings = report['settings']
    assert (settings['samples'], settings['shadow_map_size'], settings['light_samples']) == (1, 1024, 2)
    for row in report['techniques']:
        assert row['id'] in output and row['bytes'] > 0 and row['passes']
        for times in [row['wall_ms'], *(item[key] for item in row['passes'] for key in ('gpu_ms', 'cpu_ms'))]:
            assert 0 <= times['minimum'] <= times['median'] <= times['maximum']
        assert row['wall_ms']['median'] > 0
        for item in row['passes']:
            assert item['name'] in output and item['count'] >= 1
    assert sorted(os.listdir()) == ['bench.json', 'scene.pnb']


def test_bench_chooses_techniques():
    scene = make_scene('box', 'scene.pnb', *SIZE)
    penumbra('bench', scene, '-t', 'pcf', '-t', 'HARD', '-t', 'PCF', '-n', '1', '--warmup', '0', '--json', 'bench.json')
    with open('bench.json') as file:
        assert [row['id'] for row in json.load(file)['techniques']] == ['PCF', 'HARD']
    refuses('bench', scene, '-t', 'HARD', '-p', 'magic=1', code=2, mentions=('magic', 'HARD'))
    refuses('bench', scene, '-n', '0', code=2, mentions=('--runs',))
