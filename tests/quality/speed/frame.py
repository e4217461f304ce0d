# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame at one sample per pixel: PCSS beside a CPU ray tracer at equal error.

Both errors are RMSE of the Shadow pass against the ray tracer with TRUTH_RAYS shadow rays, over the pixels where an
error is one of the shadow: with geometry, reached by light, and away from geometry edges, where either method sees one
surface or the other by the last bit of a position."""
import array
import hashlib
import json
import math
import os
import statistics
import subprocess
import sys

THREADS = 2
TRUTH_RAYS = 576
RAYS = (1, 2, 4, 6, 9, 12, 16, 25)
# A pixel counts where the unshadowed irradiance of its 3 x 3 neighbourhood varies less than this.
EDGE_VARIATION = 0.15
# Rounds measured within one process for the processor time per frame, beyond the first.
EXTRA_FRAMES = 4


class Programs:
    """The programs of a build folder; `seconds` is the processor time the last one took."""

    def __init__(self, build):
        self.build = build
        self.seconds = 0

    def run(self, name, *arguments):
        command = [os.path.join(self.build, name), *map(str, arguments)]
        environment = {**os.environ, "LP_NUM_THREADS": str(THREADS)}
        with subprocess.Popen(command, stdout=subprocess.PIPE, env=environment, text=True) as process:
            output = process.stdout.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.seconds = usage.ru_utime + usage.ru_stime
        if process.returncode:
            raise SystemExit(f"{' '.join(command)} failed")
        return output

    def trace(self, scene, rays, *options):
        return json.loads(self.run("embree_baseline", scene, "--samples", rays, "-t", THREADS, "--json", *options))

    def bench(self, scene, runs, report):
        self.run("penumbra", "bench", scene, "-t", "PCSS", "--samples", 1, "-n", runs, "--json", report)
        with open(report, encoding="utf-8") as file:
            return json.load(file)["techniques"][0]

    def rmse(self, image, truth, mask):
        options = ("--pass", "Shadow", "--mask-from", mask, "--json")
        return json.loads(self.run("penumbra", "compare", image, truth, *options))["rmse"]


# ---- The pixels that count ----

def read_green(path):
    """(width, height, green) of a colour PFM."""
    with open(path, "rb") as file:
        if file.readline() != b"PF\n":
            raise SystemExit(f"{path} is not a colour PFM")
        width, height = map(int, file.readline().split())
        file.readline()
        values = array.array("f", file.read())
    if sys.byteorder == "big":
        values.byteswap()
    return width, height, values[1::3]


def extreme(function, values, width):
    """The least or greatest of each pixel's 3 x 3 neighbourhood; at the border what happens to lie there."""
    for step in (1, width):
        values = [*values[:step], *map(function, values, values[step:], values[2 * step:]), *values[-step:]]
    return values


def write_mask(path, unshadowed, ambient):
    """A PFM of 1 where pixels count; their share."""
    width, height, green = read_green(unshadowed)
    light = [max(0.0, value - ambient) for value in green]
    low, high = extreme(min, light, width), extreme(max, light, width)
    counted = array.array("f", (h - l < EDGE_VARIATION * h and v > 1e-4 for v, l, h in zip(light, low, high)))
    for y in range(height):
        counted[y * width] = counted[(y + 1) * width - 1] = 0
    counted[:width] = counted[-width:] = array.array("f", bytes(4 * width))
    with open(path, "wb") as file:
        file.write(b"Pf\n%d %d\n-1.0\n" % (width, height))
        counted.tofile(file)
    return sum(counted) / len(counted)


# ---- Error and time ----

def truth(programs, scene):
    """The ray tracer's image with TRUTH_RAYS, cached by the capture's content."""
    with open(scene, "rb") as file:
        key = hashlib.sha256(file.read()).hexdigest()[:16]
    path = f"truth-{key}-{TRUTH_RAYS}.pfm"
    if not os.path.exists(path):
        programs.trace(scene, TRUTH_RAYS, "-o", "unfinished.pfm")
        os.rename("unfinished.pfm", path)
    return path


def between(x, x0, y0, x1, y1):
    """y at x on the straight line through two points in logarithms."""
    return math.exp(math.log(y0) + math.log(x / x0) / math.log(x1 / x0) * math.log(y1 / y0))


def bracket(errors, wanted):
    """The two neighbouring numbers of rays whose errors enclose `wanted`, or the two nearest to it."""
    for few, many in zip(RAYS, RAYS[1:]):
        if errors[many] <= wanted:
            break
    return few, many


def processor_ms(programs, run):
    """Milliseconds of processor time that one more frame takes in the same process; run(count) starts one."""
    run(1)
    once = programs.seconds
    run(1 + EXTRA_FRAMES)
    return 1000 * (programs.seconds - once) / EXTRA_FRAMES


def trace_processor_ms(programs, scene, rays):
    return processor_ms(programs, lambda count: programs.trace(scene, rays, "--repeat", count))


def measure_rounds(programs, scene, pair, runs):
    """Median times of one frame, and of the ray tracer with both numbers of rays, by turns."""
    frames, traces = [], {rays: [] for rays in pair}
    for _ in range(runs):
        frames.append(programs.bench(scene, 1, "frame.json"))
        for rays in pair:
            traces[rays].append(programs.trace(scene, rays))
    median = statistics.median
    passes = [{p["name"]: p["gpu_ms"]["median"] for p in frame["passes"]} for frame in frames]
    return {"wall_ms": median(frame["wall_ms"]["median"] for frame in frames),
            "passes_ms": {name: median(times[name] for times in passes) for name in passes[0]},
            "processor_ms": processor_ms(programs, lambda count: programs.bench(scene, count, "frame.json")),
            "trace_ms": {rays: median(t["trace_ms"] for t in traces[rays]) for rays in pair},
            "trace_processor_ms": {rays: trace_processor_ms(programs, scene, rays) for rays in pair},
            "build_ms": median(t["build_ms"] + t["transform_ms"] for t in traces[pair[0]])}


def measure(programs, scene, ambient, runs):
    """All figures of one capture. `ambient` is the radiance that is no light's."""
    programs.run("penumbra", "render", scene, "--clay", "--unshadowed", "--samples", 1, "--pass", "Combined",
                 "-o", "unshadowed.pfm")
    result = {"counted": write_mask("mask.pfm", "unshadowed.pfm", ambient)}
    expected = truth(programs, scene)
    programs.run("penumbra", "render", scene, "-t", "PCSS", "--samples", 1, "--pass", "Shadow", "-o", "pcss.pfm")
    error = programs.rmse("pcss.pfm", expected, "mask.pfm")
    errors = {}
    for rays in RAYS:
        result["triangles"] = programs.trace(scene, rays, "-o", "rays.pfm")["triangles"]
        errors[rays] = programs.rmse("rays.pfm", expected, "mask.pfm")
    pair = few, many = bracket(errors, error)
    result.update(rmse=error, ray_rmse=errors, **measure_rounds(programs, scene, pair, runs))
    result["equal_rays"] = between(error, errors[few], few, errors[many], many)
    for name in ("trace_ms", "trace_processor_ms"):
        times = result[name]
        result["equal_" + name] = between(result["equal_rays"], few, times[few], many, times[many])
    result["ratio"] = result["equal_trace_ms"] / result["wall_ms"]
    result["ratio_with_build"] = (result["equal_trace_ms"] + result["build_ms"]) / result["wall_ms"]
    result["processor_ratio"] = result["equal_trace_processor_ms"] / result["processor_ms"]
    return result
