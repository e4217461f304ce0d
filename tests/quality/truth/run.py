# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures REFERENCE and EEVEE against Cycles on the truth scenes; see run.sh --help."""
import argparse
import array
import hashlib
import json
import math
import os
import subprocess
import sys

import images

FOLDER = os.path.dirname(os.path.abspath(__file__))
# Thresholds of the project, not of this machine: errors are absolute, times are ratios within one run.
MAX_ERROR = 0.015        # RMSE of visibility, REFERENCE with 32 x 32 light samples
MIN_SPEED_RATIO = 10.0   # EEVEE's time over that of REFERENCE with 8 x 8
EEVEE_SAMPLES = 64
LIGHT_SAMPLES = (8, 32)
# A pixel on a geometry edge sees either surface, by the last bit of its position: such pixels say nothing of shadows.
EDGE_VARIATION = 0.15


def blender(arguments, log, display=False):
    command = (["xvfb-run", "-a"] if display else []) + ["blender", "-b"] + arguments
    with open(log, "w", encoding="utf-8") as file:
        if subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode:
            raise SystemExit(f"Blender failed, see {log}")


def render(out, scene, engine, samples, prefix):
    script = os.path.join(FOLDER, "render.py")
    blender([os.path.join(out, scene + ".blend"), "--python-exit-code", "1", "--python", script,
             "--", engine, str(samples), prefix], prefix + ".log", engine == "EEVEE")
    with open(prefix + ".json", encoding="ascii") as file:
        return json.load(file)["seconds"]


def truth(out, cache, scene, samples):
    """Prefix of Cycles' images, rendered only if scene or settings have changed."""
    with open(os.path.join(FOLDER, "cycles_settings.py"), "rb") as file:
        settings = hashlib.sha256(file.read()).hexdigest()[:8]
    with open(os.path.join(out, scene + ".key"), encoding="ascii") as file:
        prefix = os.path.join(cache, f"{scene}-{file.read()}-{settings}-{samples}")
    if not os.path.exists(prefix + ".json"):
        render(out, scene, "CYCLES", samples, prefix)
    return prefix


def visibility(prefix):
    """(width, height, visibility, unshadowed): shadowed over unshadowed green, 1 where no light arrives."""
    width, height, shadowed = images.read_exr(prefix + ".shadowed.exr")
    unshadowed = images.read_exr(prefix + ".unshadowed.exr")[2]["G"]
    ratio = array.array("f", (s / u if u > 1e-6 else 1.0 for s, u in zip(shadowed["G"], unshadowed)))
    return width, height, ratio, unshadowed


def shadow_pass(prefix):
    channels = images.read_exr(prefix + ".passes.exr")[2]
    names = [name for name in channels if name.endswith(".Shadow.G")]
    if len(names) != 1:
        raise SystemExit(f"{prefix}.passes.exr has no Shadow pass: {', '.join(channels)}")
    return channels[names[0]]


def counted_pixels(width, height, unshadowed):
    """Indices of lit pixels whose 3 x 3 neighbourhood, unshadowed, varies little."""
    counted = []
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            i = y * width + x
            near = [unshadowed[j + k] for j in (i - width, i, i + width) for k in (-1, 0, 1)]
            high = max(near)
            if unshadowed[i] > 0 and high - min(near) < EDGE_VARIATION * high:
                counted.append(i)
    return counted


def rmse(a, b, pixels):
    return math.sqrt(sum((a[i] - b[i]) ** 2 for i in pixels) / len(pixels))


def grey(values):
    return b"".join(bytes((min(255, max(0, round(255 * min(1, max(0, v)) ** (1 / 2.2)))),)) * 3 for v in values)


def heat(a, b, pixels):
    """|a - b| from black over red and yellow to white at 0.1; blue where not counted."""
    result = bytearray(b"\x18\x20\x50" * len(a))
    for i in pixels:
        t = min(1.0, abs(a[i] - b[i]) / 0.1)
        result[3 * i:3 * i + 3] = (round(255 * max(0, min(1, 3 * t - channel))) for channel in range(3))
    return bytes(result)


def side_by_side(left, right, width, height):
    row = 3 * width
    return b"".join(left[y * row:(y + 1) * row] + right[y * row:(y + 1) * row] for y in range(height))


def measure(out, cache, scene, options):
    """One row of the table, as a dictionary."""
    width, height, expected, unshadowed = visibility(truth(out, cache, scene, options.cycles_samples))
    pixels = counted_pixels(width, height, unshadowed)
    eevee_prefix = os.path.join(out, scene + ".eevee")
    row = {"scene": scene, "share": len(pixels) / (width * height),
           "eevee_seconds": render(out, scene, "EEVEE", EEVEE_SAMPLES, eevee_prefix)}
    eevee = visibility(eevee_prefix)[2]
    row["eevee"] = rmse(eevee, expected, pixels)
    for n in LIGHT_SAMPLES:
        prefix = os.path.join(out, f"{scene}.reference{n}")
        row[f"seconds{n}"] = render(out, scene, "PENUMBRA", n, prefix)
        reference = shadow_pass(prefix)
        row[f"reference{n}"] = rmse(reference, expected, pixels)
    top = side_by_side(grey(expected), grey(reference), width, height)
    bottom = side_by_side(heat(eevee, expected, pixels), heat(reference, expected, pixels), width, height)
    images.write_png(os.path.join(out, scene + ".png"), 2 * width, 2 * height, top + bottom)
    return row


def faults(row):
    """What the row misses, as text."""
    small, large = LIGHT_SAMPLES
    if row[f"reference{large}"] > MAX_ERROR:
        yield f"REFERENCE {large}x{large} errs by {row[f'reference{large}']:.4f}, more than {MAX_ERROR}"
    if row[f"reference{small}"] >= row["eevee"]:
        yield f"REFERENCE {small}x{small} errs by {row[f'reference{small}']:.4f}, EEVEE only by {row['eevee']:.4f}"
    if row["eevee_seconds"] < MIN_SPEED_RATIO * row[f"seconds{small}"]:
        ratio = row["eevee_seconds"] / row[f"seconds{small}"]
        yield f"REFERENCE {small}x{small} is only {ratio:.1f} times as fast as EEVEE"


def parse():
    parser = argparse.ArgumentParser(prog="run.sh", description=(
        "Renders small scenes with Cycles (cached in the build folder, minutes per scene the first time), EEVEE and "
        "Penumbra's REFERENCE, and prints the RMSE of their visibility against Cycles, and times. Fails if a threshold "
        "is missed. NAME.png in the output folder shows Cycles and REFERENCE above the errors of EEVEE and REFERENCE, "
        "white at 0.1."))
    parser.add_argument("--cycles-samples", type=int, default=1024, metavar="N")
    parser.add_argument("--scenes", nargs="+", default=[], metavar="NAME", help="default: all")
    parser.add_argument("--cycles-only", action="store_true", help="only fill the cache")
    parser.add_argument("--build", default=os.path.join(FOLDER, *[os.pardir] * 3, "build"), metavar="FOLDER")
    return parser.parse_args()


def main():
    options = parse()
    out = os.path.join(os.path.abspath(options.build), "truth")
    cache = os.path.join(out, "cycles")
    os.makedirs(cache, exist_ok=True)
    for old in os.listdir(out):
        if old.endswith(".key"):
            os.remove(os.path.join(out, old))
    blender(["--factory-startup", "--python-exit-code", "1", "--python", os.path.join(FOLDER, "scenes.py"), "--", out,
             *options.scenes], os.path.join(out, "scenes.log"))
    scenes = sorted(name[:-4] for name in os.listdir(out) if name.endswith(".key"))
    missing = set(options.scenes) - set(scenes)
    if missing:
        raise SystemExit(f"no such scene: {', '.join(sorted(missing))}")
    if options.cycles_only:
        for scene in scenes:
            truth(out, cache, scene, options.cycles_samples)
        return 0
    small, large = LIGHT_SAMPLES
    print(f"RMSE of visibility against Cycles ({options.cycles_samples} samples); EEVEE with {EEVEE_SAMPLES} samples; "
          "REFERENCE N x N")
    print(f"{'scene':16}{'counted':>8}{f'REF {small}':>9}{f'REF {large}':>9}{'EEVEE':>9}"
          f"{f'REF {small} s':>10}{f'REF {large} s':>10}{'EEVEE s':>9}{'ratio':>8}")
    failed = []
    for scene in scenes:
        row = measure(out, cache, scene, options)
        print(f"{scene:16}{100 * row['share']:7.1f}%"
              f"{row[f'reference{small}']:9.4f}{row[f'reference{large}']:9.4f}{row['eevee']:9.4f}"
              f"{row[f'seconds{small}']:10.3f}{row[f'seconds{large}']:10.3f}{row['eevee_seconds']:9.2f}"
              f"{row['eevee_seconds'] / row[f'seconds{small}']:8.1f}", flush=True)
        failed += [f"{scene}: {fault}" for fault in faults(row)]
    for line in failed:
        print(f"FAILED {line}")
    count = len({line.split(":")[0] for line in failed})
    print(f"{count} of {len(scenes)} scenes failed; images: {os.path.relpath(out)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
