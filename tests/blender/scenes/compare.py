# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: renders every row with Cycles and with Penumbra and writes the numbers and pictures.

After `--`: the folder of the results and names of rows (none: all). Cycles' pictures are kept there from run to run, by
the text of the row and of its stage: delete them after changes of functions that rows share."""

import hashlib
import json
import math
import os
import sys
import time
import traceback
from array import array

import addon_utils
import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]

from harness import ADDON, OUTPUT, read_exr, render_exr  # noqa: E402
import frame_rows  # noqa: E402, F401
import geometry_rows  # noqa: E402, F401
import instance_rows  # noqa: E402, F401
import light_rows  # noqa: E402, F401
import material_rows  # noqa: E402, F401
import ray_rows  # noqa: E402, F401
import scene_rows  # noqa: E402, F401
import texture_rows  # noqa: E402, F401
import world_rows  # noqa: E402, F401
from rows import ROWS, Stage  # noqa: E402

VERSION = '.'.join(map(str, bpy.app.version[:2]))


def set_up(scene):
    """Both engines: direct light of the lamps only, to convergence."""
    cycles = scene.cycles
    cycles.max_bounces, cycles.transparent_max_bounces = 0, 8
    cycles.samples = 256
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.light_sampling_threshold = 0.0
    scene.render.filter_size = cycles.filter_width
    options = scene.penumbra
    options.technique, options.light_samples, options.samples = 'REFERENCE', 6, 144
    # Texels are a quarter of a pixel; finer ones change no number here and take five times as long.
    options.shadow_map_size = 256


def build(row):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    set_up(scene)
    stage = Stage(scene, OUTPUT)
    row.build(stage)
    scene.frame_set(stage.frame)
    return stage


def render(stage, engine, path):
    scene = stage.scene
    hook = stage.for_cycles if engine == 'CYCLES' else stage.for_penumbra
    if hook:
        hook()
    scene.render.engine = engine
    start = time.perf_counter()
    picture = render_exr(scene, path)
    return picture, time.perf_counter() - start


def cycles_path(row, folder):
    with open(sys.modules[row.build.__module__].__file__, 'rb') as file:
        text = file.read()
    with open(os.path.join(HERE, 'rows.py'), 'rb') as file:
        text += file.read()
    start = text.index(f'def {row.name}('.encode())
    end = text.find(b'\n@row', start)
    stage = text[text.index(b'class Stage'):]
    return os.path.join(folder, f"{row.name}.{hashlib.sha1(text[start:end] + stage).hexdigest()[:12]}.exr")


def channels(picture, stage, name):
    """{letter: (width, height, floats)} of a pass."""
    prefix = f"{stage.layer}.{name}."
    view = stage.view + '.' if stage.view else ''
    found = {}
    for channel, content in picture.items():
        if channel.startswith(prefix):
            letter = channel[len(prefix):]
            if letter.startswith(view):
                found[letter[len(view):]] = content
    return found


def mean(values):
    return sum(values) / len(values)


def center(width, height, weights):
    total = sum(weights) or 1.0
    x = sum((index % width) * weight for index, weight in enumerate(weights)) / total
    y = sum((index // width) * weight for index, weight in enumerate(weights)) / total
    return x, y


def data_error(ours, theirs):
    """Of a pass that is not light: what four of five pixels stay below. Cycles smooths no outlines there, we do."""
    errors, sizes = [], []
    for letter, (_width, _height, values) in theirs.items():
        errors += [abs(a - b) for a, b in zip(ours[letter][2], values) if abs(a) < 1e9 and abs(b) < 1e9]
        sizes += [abs(b) for b in values if abs(b) < 1e9]
    return sorted(errors)[len(errors) * 4 // 5] / mean(sizes)


def measure(ours, theirs, row):
    """The three errors. What is not finite is wrong by 1."""
    letters = [letter for letter in theirs if letter != 'A']
    width, height, _values = theirs[letters[0]]
    if set(ours) != set(theirs) or any(ours[letter][:2] != (width, height) for letter in theirs):
        raise ValueError(f"channels or sizes differ: {sorted(ours)}, {sorted(theirs)}")
    if row.channel != 'Combined':
        return {'light': (data_error(ours, theirs), row.limits['light'])}
    squares, light = 0.0, 0.0
    for letter in letters:
        squares += mean([(a - b) ** 2 if math.isfinite(a) else 1.0
                         for a, b in zip(ours[letter][2], theirs[letter][2])])
        light += mean(theirs[letter][2])
    count = len(letters)
    errors = {'light': math.sqrt(squares / count) / max(light / count, 1e-3)}
    if 'A' in theirs:
        errors['coverage'] = mean([abs(a - b) for a, b in zip(ours['A'][2], theirs['A'][2])])
        sums = [[sum(abs(picture[letter][2][index]) for letter in letters) for index in range(width * height)]
                for picture in (ours, theirs)]
        (x0, y0), (x1, y1) = (center(width, height, weights) for weights in sums)
        errors['position'] = math.hypot(x0 - x1, y0 - y1)
    return {name: (value, row.limits[name]) for name, value in sorted(errors.items())}


def write_png(path, picture, difference=None):
    """A picture over grey; or four times the absolute difference of two."""
    letters = sorted((letter for letter in picture if letter != 'A'), key='RGBXYZ'.index)
    width, height, _values = picture[letters[0]]
    pixels = array('f', bytes(16 * width * height))
    for index in range(width * height):
        for number in range(3):
            letter = letters[min(number, len(letters) - 1)]
            value = picture[letter][2][index]
            if difference:
                value = 4.0 * abs(value - difference[letter][2][index])
            elif 'A' in picture:
                value += 0.12 * (1.0 - picture['A'][2][index])
            pixels[4 * index + number] = min(max(value, 0.0), 1.0) ** (1.0 / 2.2) if value == value else 1.0
        pixels[4 * index + 3] = 1.0
    image = bpy.data.images.new("picture", width, height, alpha=True)
    image.pixels.foreach_set(pixels)
    image.filepath_raw, image.file_format = path, 'PNG'
    image.save()
    bpy.data.images.remove(image)


def theirs(row, folder):
    path = cycles_path(row, folder)
    if not os.path.exists(path):
        stage = build(row)
        render(stage, 'CYCLES', path + '.partial.exr')
        os.replace(path + '.partial.exr', path)
    return read_exr(path)


def compare(row, folder):
    record = {'group': row.group, 'name': row.name, 'text': row.text, 'errors': {}, 'messages': []}
    try:
        expected = theirs(row, folder)
        stage = build(row)
        picture, record['seconds'] = render(stage, 'PENUMBRA', os.path.join(OUTPUT, 'penumbra.exr'))
        record['messages'] = list(sys.modules[ADDON].report.lines)
        both = [channels(each, stage, row.channel) for each in (picture, expected)]
        record['errors'] = measure(*both, row)
        for name, arguments in (('penumbra', both[:1]), ('cycles', both[1:]), ('difference', both)):
            write_png(os.path.join(folder, f"{row.name}-{name}.png"), *arguments)
    except Exception as error:
        traceback.print_exc()
        record['failure'] = f"{type(error).__name__}: {error}"
    record['passed'] = 'failure' not in record and all(value <= limit for value, limit in record['errors'].values())
    return record


def write_results(path, records):
    """Rows that were not rendered this time keep the results they have."""
    rows = {}
    if os.path.exists(path):
        with open(path, encoding='utf-8') as file:
            rows = {record['name']: record for record in json.load(file)['rows']}
    rows.update((record['name'], record) for record in records)
    order = [row.name for row in ROWS if row.fits(bpy.app.version) and row.name in rows]
    with open(path, 'w', encoding='utf-8') as file:
        json.dump({'version': bpy.app.version_string, 'rows': [rows[name] for name in order]}, file, indent=1)


def main():
    folder, *names = sys.argv[sys.argv.index('--') + 1:]
    unknown = set(names) - {row.name for row in ROWS}
    if unknown or addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit(f"unknown rows: {', '.join(unknown)}" if unknown else "the add-on cannot be enabled")
    folder = os.path.join(folder, VERSION)
    os.makedirs(folder, exist_ok=True)
    records = []
    for row in ROWS:
        if not row.fits(bpy.app.version) or names and row.name not in names:
            continue
        record = compare(row, folder)
        records.append(record)
        numbers = '  '.join(f"{name} {value:.4f}{'' if value <= limit else ' > ' + str(limit)}"
                            for name, (value, limit) in record['errors'].items())
        print('ROW', 'ok    ' if record['passed'] else 'FAILED', row.group, row.name, numbers,
              record.get('failure', ''), flush=True)
    write_results(os.path.join(folder, 'results.json'), records)
    failed = sum(not record['passed'] for record in records)
    print(f"{len(records) - failed} passed, {failed} failed", flush=True)
    sys.exit(failed > 0)


main()
