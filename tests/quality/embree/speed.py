# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and error of techniques beside those of a CPU ray tracer.

One frame at one sample per pixel, all passes, against camera rays and N shadow rays per pixel, both on all processors.
Errors are those of the Shadow pass over the pixels with geometry, against many more samples of the same method: for a
technique REFERENCE, for the ray tracer itself; `traced` is the technique's error against the ray tracer as well. Rounds
are interleaved, so that both meet the same machine; the times are medians."""

import argparse
import json
import os
import statistics
import sys
import tempfile

from programs import Programs

RAYS = (1, 2, 4, 9, 16, 36, 64)


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build')
    parser.add_argument('--techniques', default='HARD,PCF,PCSS')
    parser.add_argument('--scene', default='benchmark', help='a scene of make_scene')
    parser.add_argument('--capture', help='a capture to take instead')
    parser.add_argument('--size', default='1280x720')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--truth', type=int, default=32, help='N for N x N light samples of the truth (default 32)')
    parser.add_argument('--json', help='also write the figures to this file')
    return parser.parse_args()


def technique_row(programs, scene, technique):
    programs.run('penumbra', 'render', scene, '-t', technique, '-o', 'technique.exr')
    return {'rmse': programs.compare('technique.exr', 'reference.exr')['rmse'],
            'traced': programs.compare('technique.exr', 'truth.pfm')['rmse']}


def ray_row(programs, scene, rays):
    programs.trace(scene, 'rays.pfm', rays)
    return {'rmse': programs.compare('rays.pfm', 'truth.pfm', '--mask-from', 'reference.exr')['rmse']}


def measure_times(programs, scene, techniques, rounds):
    """Milliseconds by technique and by number of rays. The passes of a frame are all written, as in a still."""
    times = {name: [] for name in (*techniques, *RAYS)}
    for _ in range(rounds):
        options = [option for name in techniques for option in ('-t', name)]
        programs.run('penumbra', 'bench', scene, *options, '-n', 1, '--json', 'bench.json')
        with open('bench.json') as file:
            for row in json.load(file)['techniques']:
                times[row['id']].append(row['wall_ms']['median'])
        for rays in RAYS:
            times[rays].append(programs.trace(scene, 'rays.pfm', rays)['trace_ms'])
    return {name: statistics.median(values) for name, values in times.items()}


def time_at(error, rows):
    """Milliseconds the ray tracer needs for this error, on the line through its neighbours; None if out of range."""
    points = sorted((row['rmse'], row['ms']) for row in rows)
    for (error_a, ms_a), (error_b, ms_b) in zip(points, points[1:]):
        if error_a <= error <= error_b:
            share = (error - error_a) / (error_b - error_a) if error_b > error_a else 0
            return ms_a + share * (ms_b - ms_a)
    return None


def print_table(techniques, traced):
    print(f"{'':12} {'ms':>9} {'RMSE':>8} {'traced':>8}   ray tracer at the same RMSE")
    for name, row in techniques.items():
        equal = time_at(row['rmse'], traced.values())
        text = f"{equal:9.1f} ms: {equal / row['ms']:.2f} times the time" if equal else 'outside the rays measured'
        print(f"{name:12} {row['ms']:9.1f} {row['rmse']:8.4f} {row['traced']:8.4f}  {text}")
    for rays, row in traced.items():
        print(f"{f'{rays} rays':12} {row['ms']:9.1f} {row['rmse']:8.4f}")


def main():
    options = parse()
    programs = Programs(options.build)
    techniques = options.techniques.split(',')
    capture = os.path.abspath(options.capture) if options.capture else None
    report = os.path.abspath(options.json) if options.json else None
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        scene = capture or 'scene.pnb'
        if not capture:
            programs.scene(options.scene, scene, '--size', options.size)
        programs.run('penumbra', 'render', scene, '-t', 'reference', '--light-samples', options.truth,
                     '-o', 'reference.exr')
        build = programs.trace(scene, 'truth.pfm', options.truth ** 2)
        by_technique = {name: technique_row(programs, scene, name) for name in techniques}
        by_rays = {rays: ray_row(programs, scene, rays) for rays in RAYS}
        times = measure_times(programs, scene, techniques, options.rounds)
        os.chdir('/')
    for name, row in (*by_technique.items(), *by_rays.items()):
        row['ms'] = times[name]
    print(f"{build['width']} x {build['height']} pixels, {build['triangles']} triangles, {build['threads']} threads; "
          f"the ray tracer's tree: {build['build_ms']:.0f} ms more")
    print_table(by_technique, by_rays)
    if report:
        with open(report, 'w') as file:
            json.dump({'techniques': by_technique, 'rays': by_rays, 'build': build}, file, indent=2)


main()
