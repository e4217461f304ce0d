# SPDX-License-Identifier: GPL-3.0-or-later
"""compare, on files this test makes itself or Blender wrote."""

import json
import math
import os
import random
import shutil
import struct
import subprocess

import files
import metrics
from tool import Skip, penumbra, refuses

WIDTH, HEIGHT = 24, 18


def noise(seed, channels=1):
    generator = random.Random(seed)
    # Through float32, so that both sides see the same numbers.
    return [struct.unpack('<f', struct.pack('<f', generator.random()))[0] for _ in range(WIDTH * HEIGHT * channels)]


def compare(a, b, *options, code=0):
    return json.loads(penumbra('compare', a, b, '--json', *options, code=code)[0])


def test_identical_images():
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 3, noise(1, 3))
    result = compare('a.pfm', 'a.pfm', '--max-rmse', 0)
    assert result['rmse'] == result['max'] == result['share_above_1/64'] == 0 and result['ssim'] == 1
    assert result['pixels'] == result['pixels_total'] == WIDTH * HEIGHT


def test_measures_agree_with_their_definitions():
    a, b = noise(1), noise(2)
    b = [0.7 * x + 0.3 * y for x, y in zip(a, b)]
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, a)
    files.write_pfm('b.pfm', WIDTH, HEIGHT, 1, b)
    _, _, _, b = files.read_pfm('b.pfm')
    result = compare('a.pfm', 'b.pfm')
    differences = [abs(x - y) for x, y in zip(a, b)]
    worst = max(range(len(a)), key=differences.__getitem__)
    # Both sides compute in doubles from the same floats, and print 9 digits.
    assert math.isclose(result['rmse'], metrics.rmse(a, b), rel_tol=1e-8)
    assert math.isclose(result['mean'], sum(differences) / len(differences), rel_tol=1e-8)
    assert math.isclose(result['ssim'], metrics.ssim(a, b, WIDTH, HEIGHT, [True] * len(a)), rel_tol=1e-6)
    assert (result['max_x'], result['max_y']) == (worst % WIDTH, worst // WIDTH)
    assert math.isclose(result['max'], differences[worst], rel_tol=1e-8)
    for limit, key in ((0.2, 'share_above_0.2'), (1 / 64, 'share_above_1/64')):
        assert math.isclose(result[key], sum(d > limit for d in differences) / len(differences), rel_tol=1e-8)


def test_colour_counts_per_channel_and_luminance():
    a = noise(1, 3)
    b = [value + (0.25 if i % 3 == 0 else 0) for i, value in enumerate(a)]
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 3, a)
    files.write_pfm('b.pfm', WIDTH, HEIGHT, 3, b)
    result = compare('a.pfm', 'b.pfm')
    # One channel of three is off by 0.25, to within the floats.
    assert math.isclose(result['rmse'], 0.25 / math.sqrt(3), rel_tol=1e-6)
    assert result['share_above_0.2'] == 1
    grey = [[0.2126 * p[3 * i] + 0.7152 * p[3 * i + 1] + 0.0722 * p[3 * i + 2] for i in range(WIDTH * HEIGHT)]
            for p in (a, b)]
    expected = metrics.ssim(*grey, WIDTH, HEIGHT, [True] * (WIDTH * HEIGHT))
    # The tool's luminance is a float: 1e-7 of it, enlarged by small variances.
    assert math.isclose(result['ssim'], expected, rel_tol=1e-4)


def write_layers(path, values, depth, **options):
    channels = {'Shadow.R': values, 'Shadow.G': values, 'Shadow.B': values, 'Depth.Z': depth}
    files.write_exr(path, WIDTH, HEIGHT, channels, **options)


def test_background_and_masks_do_not_count():
    a, b = noise(1), noise(2)
    depth = [1e10 if i % WIDTH < 6 else 3.0 for i in range(WIDTH * HEIGHT)]
    write_layers('a.exr', a, depth)
    files.write_pfm('b.pfm', WIDTH, HEIGHT, 1, b)
    counts = [value < 1e10 for value in depth]
    result = compare('a.exr', 'b.pfm', '--pass', 'Shadow')
    kept = [(x, y) for x, y, count in zip(a, b, counts) if count]
    assert result['pixels'] == len(kept) == 18 * HEIGHT
    assert math.isclose(result['rmse'], metrics.rmse(*zip(*kept)), rel_tol=1e-8)
    assert math.isclose(result['ssim'], metrics.ssim(a, b, WIDTH, HEIGHT, counts), rel_tol=1e-4)

    files.write_pfm('mask.pfm', WIDTH, HEIGHT, 1, [float(i // WIDTH < 4) for i in range(WIDTH * HEIGHT)])
    assert compare('a.exr', 'b.pfm', '--mask-from', 'mask.pfm')['pixels'] == 18 * 4
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, a)
    assert compare('a.pfm', 'b.pfm', '--mask-from', 'a.exr')['pixels'] == 18 * HEIGHT
    files.write_pfm('none.pfm', WIDTH, HEIGHT, 1, [0.0] * (WIDTH * HEIGHT))
    refuses('compare', 'a.pfm', 'b.pfm', '--mask-from', 'none.pfm', code=1, mentions=('no pixel',))


def test_exit_status_follows_the_limit():
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, [0.5] * (WIDTH * HEIGHT))
    files.write_pfm('b.pfm', WIDTH, HEIGHT, 1, [0.625] * (WIDTH * HEIGHT))
    compare('a.pfm', 'b.pfm', '--max-rmse', 0.125)
    refuses('compare', 'a.pfm', 'b.pfm', '--max-rmse', 0.1249, code=1, mentions=('0.125', '0.1249'))
    refuses('compare', 'a.pfm', 'b.pfm', '--max-rmse', '-1', code=2, mentions=('--max-rmse', '-1'))


def test_values_that_are_not_finite_fail():
    good = [0.5] * (WIDTH * HEIGHT)
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, good)
    for bad in (math.nan, math.inf):
        files.write_pfm('b.pfm', WIDTH, HEIGHT, 1, [bad] + good[1:])
        result = compare('a.pfm', 'b.pfm', code=1)
        assert result['pixels_not_finite'] == 1 and result['rmse'] == 0


def test_what_cannot_be_compared():
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, noise(1))
    files.write_pfm('small.pfm', WIDTH - 1, HEIGHT, 1, noise(1)[:(WIDTH - 1) * HEIGHT])
    refuses('compare', 'a.pfm', 'small.pfm', code=1, mentions=('24 x 18', '23 x 18', 'small.pfm'))
    refuses('compare', 'a.pfm', 'missing.exr', code=3, mentions=('missing.exr',))
    refuses('compare', 'a.pfm', 'a.txt', code=3, mentions=('a.txt',))
    write_layers('layers.exr', noise(1), noise(2))
    refuses('compare', 'layers.exr', 'a.pfm', '--pass', 'Normal', code=2, mentions=('Normal', 'Depth, Shadow'))
    files.write_exr('tall.exr', 2, 2, {'R': [0.0] * 4})
    refuses('compare', 'tall.exr', 'a.pfm', code=1, mentions=('2 x 2',))


def test_error_map():
    a = [0.0] * (WIDTH * HEIGHT)
    b = [0.0, 0.2, 0.1, 5.0] + a[4:]
    depth = [3.0] * (WIDTH * HEIGHT - 1) + [1e10]
    write_layers('a.exr', a, depth)
    files.write_pfm('b.pfm', WIDTH, HEIGHT, 1, b)
    output, _ = penumbra('compare', 'a.exr', 'b.pfm', '-o', 'error.png')
    assert 'white 0.2' in output
    width, height, channels, shown = files.read_png('error.png')
    assert (width, height, channels) == (WIDTH, HEIGHT, 3)
    bottom = [tuple(shown[((height - 1) * width + x) * 3 + c] for c in range(3)) for x in range(5)]
    assert bottom[0] == bottom[4] == (0, 0, 0) and bottom[1] == bottom[3] == (255, 255, 255)
    luminance = 0.30 * bottom[2][0] + 0.59 * bottom[2][1] + 0.11 * bottom[2][2]
    assert len(set(bottom[2])) == 3 and abs(luminance - 127.5) < 4  # half way: half as bright, and coloured
    assert len(set(shown[(width - 1) * 3:width * 3])) == 1 and 50 < shown[(width - 1) * 3] < 100  # grey
    penumbra('compare', 'a.exr', 'b.pfm', '-o', 'error.png', '--error-range', 10)
    assert max(files.read_png('error.png')[3][-WIDTH * 3:][3:6]) < 20


# ---- Files of other programs ----

def test_half_and_zip_files():
    values, depth = noise(1), [2.0] * (WIDTH * HEIGHT)
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 1, values)
    for kind in ('float', 'half'):
        for zipped in (False, True):
            write_layers('a.exr', values, depth, kind=kind, zipped=zipped)
            result = compare('a.exr', 'a.pfm', '--pass', 'Shadow')
            # Halves below 1 have 11 bits: half a step is 2^-12.
            assert result['max'] <= (0 if kind == 'float' else 2 ** -12), (kind, zipped, result)


def test_channels_in_any_order_and_with_view_layer_names():
    red, green, blue, alpha = (noise(seed) for seed in range(4))
    rgb = [value for pixel in zip(red, green, blue) for value in pixel]
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 3, rgb)
    for prefix in ('', 'ViewLayer.Combined.', 'Combined.'):
        channels = {prefix + letter: values for letter, values in zip('RGBA', (red, green, blue, alpha))}
        channels['Z' if not prefix else prefix.replace('Combined', 'Depth') + 'Z'] = [1.0] * (WIDTH * HEIGHT)
        files.write_exr('a.exr', WIDTH, HEIGHT, channels)
        assert compare('a.exr', 'a.pfm', '--pass', 'Combined')['max'] == 0, prefix


def test_damaged_files_are_refused():
    write_layers('good.exr', noise(1), noise(2), zipped=True)
    files.write_pfm('good.pfm', WIDTH, HEIGHT, 1, noise(1))
    for name in ('good.exr', 'good.pfm'):
        with open(name, 'rb') as file:
            data = file.read()
        ending = os.path.splitext(name)[1]
        for size in [*range(0, 400, 23), *range(400, len(data) - 1, len(data) // 20)]:
            with open('bad' + ending, 'wb') as file:
                file.write(data[:size])
            penumbra('compare', 'bad' + ending, name, code=3)


BLENDER_SCRIPT = """
import bpy
scene = bpy.context.scene
image = bpy.data.images.new('image', {width}, {height}, float_buffer=True)
image.colorspace_settings.name = 'Linear'
image.pixels.foreach_set({pixels})
settings = scene.render.image_settings
scene.view_settings.view_transform = 'Standard'
settings.file_format, settings.color_mode = 'OPEN_EXR', 'RGBA'
for depth in '16', '32':
    for codec in 'NONE', 'ZIP', 'PIZ', 'RLE', 'ZIPS':
        settings.color_depth, settings.exr_codec = depth, codec
        image.save_render({folder!r} + '/blender_' + depth + '_' + codec + '.exr', scene=scene)
"""


def test_files_blender_writes():
    blender = shutil.which(os.environ.get('BLENDER', 'blender'))
    if not blender:
        raise Skip("Blender is not installed")
    rgb = noise(1, 3)
    rgba = [value for i in range(WIDTH * HEIGHT) for value in (*rgb[3 * i:3 * i + 3], 1.0)]
    files.write_pfm('a.pfm', WIDTH, HEIGHT, 3, rgb)
    with open('script.py', 'w') as file:
        file.write(BLENDER_SCRIPT.format(width=WIDTH, height=HEIGHT, pixels=rgba, folder=os.getcwd()))
    result = subprocess.run([blender, '-b', '--factory-startup', '--python-exit-code', '1', '--python',
                             os.path.abspath('script.py')], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    for depth, tolerance in (('16', 2 ** -11), ('32', 1e-6)):  # halves may be cut instead of rounded
        for codec in ('NONE', 'ZIP', 'PIZ', 'RLE', 'ZIPS'):
            result = compare(f'blender_{depth}_{codec}.exr', 'a.pfm')
            assert result['max'] <= tolerance, (depth, codec, result['max'])
