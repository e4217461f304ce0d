# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures speed beside other renderers; see run.sh --help."""
import argparse
import json
import os
import statistics
import subprocess
import sys

import frame

FOLDER = os.path.dirname(os.path.abspath(__file__))
SAMPLE_SCENES = os.path.join(FOLDER, *[os.pardir] * 3, "samples", "scenes")
# The project's requirements. Times of two machines, or of two runs, say nothing beside each other: all are ratios.
REQUIRED_STILL = {"EEVEE": 50.0, "CYCLES": 15.0}
REQUIRED_FRAME = 3.0
SAMPLES = {"PENUMBRA": "PCSS, 4 samples", "EEVEE": "64 samples", "CYCLES": "16 samples"}

HELP = """Times a whole still at 1280 x 720 in Blender (40,000 triangles, one area light, a shadow map of 1024 x 1024)
with Penumbra, EEVEE and Cycles by turns, and one frame of Penumbra's library beside a CPU ray tracer of equal error.
All figures are medians of one run. Prints tables, writes speed/speed.json into the build folder, and fails if a
required ratio is missed. Takes a quarter of an hour; nothing else should run."""


def blender(log, *arguments, display=False):
    """Runs Blender in the background on absolute paths: relative ones it looks for where the shell is."""
    command = [*(["xvfb-run", "-a"] if display else []), "blender", "-b", *arguments]
    with open(log, "w", encoding="utf-8") as file:
        if subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode:
            raise SystemExit(f"Blender failed, see {os.path.abspath(log)}")


# ---- Whole stills in Blender ----

def run_script(log, script, *arguments, file="--factory-startup", display=False):
    blender(log, file, "--python-exit-code", "1", "--python", script, "--", *arguments, display=display)


def time_still(engine):
    run_script(engine + ".log", os.path.join(FOLDER, "still.py"), engine, os.path.abspath("still.json"),
               file=os.path.abspath("still.blend"), display=engine == "EEVEE")
    with open("still.json", encoding="ascii") as file:
        return json.load(file)


def median_of(runs, *keys):
    def value(run):
        for key in keys:
            run = run[key]
        return run
    return statistics.median(map(value, runs))


def measure_stills(runs):
    run_script("scene.log", os.path.join(FOLDER, "scene.py"), os.path.abspath("still.blend"))
    engines = ("PENUMBRA", "CYCLES", "EEVEE")
    results = {engine: [] for engine in engines}
    for number in range(runs):
        for engine in engines:
            print(f"still {number + 1} of {runs}: {engine}", file=sys.stderr)
            results[engine].append(time_still(engine))
    ours = results["PENUMBRA"]
    stills = {engine: {clock: median_of(results[engine], "second", clock) for clock in ("wall", "processor")}
              for engine in engines}
    for still in stills.values():
        still["ratio"] = still["wall"] / stills["PENUMBRA"]["wall"]
        still["processor_ratio"] = still["processor"] / stills["PENUMBRA"]["processor"]
    stills["PENUMBRA"]["first"] = median_of(ours, "first", "wall")
    stills["PENUMBRA"]["stages"] = {stage: median_of(ours, "stages", stage) for stage in ours[0]["stages"]}
    return stills


def print_stills(stills):
    print(f"{'Whole still':28}{'wall s':>10}{'CPU s':>10}{'ratio':>9}{'CPU':>8}{'required':>10}")
    for engine, still in stills.items():
        required = f"{REQUIRED_STILL[engine]:10.0f}" if engine in REQUIRED_STILL else ""
        print(f"{f'{engine}, {SAMPLES[engine]}':28}{still['wall']:10.3f}{still['processor']:10.2f}{still['ratio']:9.1f}"
              f"{still['processor_ratio']:8.1f}{required}")
    ours = stills["PENUMBRA"]
    print(f"{'PENUMBRA, first in process':28}{ours['first']:10.3f}")
    for stage, seconds in ours["stages"].items():
        print(f"  {stage:26}{seconds:10.3f}")
    print(f"  {'Blender itself':26}{ours['wall'] - sum(ours['stages'].values()):10.3f}")


# ---- One frame of the library ----

def write_captures(programs):
    """(name, capture, ambient radiance)."""
    programs.run("make_scene", "--size", "1280x720", "benchmark", "benchmark.pnb")
    yield "benchmark", "benchmark.pnb", 0.05
    file, capture = os.path.abspath("still_life.blend"), os.path.abspath("still_life.pnb")
    run_script("still_life.log", os.path.join(SAMPLE_SCENES, "build.py"), "still_life", file)
    run_script("capture.log", os.path.join(FOLDER, "capture.py"), capture, file=file)
    yield "still life", "still_life.pnb", 0.0


def print_frame(name, row):
    print(f"\nOne frame, {name}: {row['triangles']} triangles, RMSE over {100 * row['counted']:.0f} % of the pixels")
    print(f"{'':28}{'wall ms':>10}{'CPU ms':>10}{'RMSE':>9}")
    print(f"{'PCSS, all passes':28}{row['wall_ms']:10.1f}{row['processor_ms']:10.1f}{row['rmse']:9.4f}")
    for stage, milliseconds in row["passes_ms"].items():
        print(f"  {stage:26}{milliseconds:10.1f}")
    for rays, error in row["ray_rmse"].items():
        measured = [row[clock][rays] for clock in ("trace_ms", "trace_processor_ms") if rays in row[clock]]
        times = "".join(f"{milliseconds:10.1f}" for milliseconds in measured)
        print(f"{f'Ray tracer, {rays} rays':28}{times:20}{error:9.4f}")
    print(f"{'Ray tracer, equal RMSE':28}{row['equal_trace_ms']:10.1f}{row['equal_trace_processor_ms']:10.1f}"
          f"{row['rmse']:9.4f}   ({row['equal_rays']:.1f} rays)")
    print(f"{'  building its tree':28}{row['build_ms']:10.1f}")
    print(f"Ratio {row['ratio']:.2f} (required: {REQUIRED_FRAME:.0f}), with the tree {row['ratio_with_build']:.2f}, "
          f"of processor time {row['processor_ratio']:.2f}")


# ---- All ----

def faults(results):
    """What is missed, as text."""
    for engine, required in REQUIRED_STILL.items():
        ratio = results.get("stills", {}).get(engine, {"ratio": required})["ratio"]
        if ratio < required:
            yield f"a still takes 1/{ratio:.1f} of {engine}'s time, not 1/{required:.0f}"
    for name, row in results.get("frames", {}).items():
        if row["ratio"] < REQUIRED_FRAME:
            yield f"{name}: a frame takes 1/{row['ratio']:.2f} of the ray tracer's time, not 1/{REQUIRED_FRAME:.0f}"


def parse():
    parser = argparse.ArgumentParser(prog="run.sh", description=HELP)
    parser.add_argument("--runs", type=int, default=5, help="rounds of frames (default 5); of stills at most 3")
    parser.add_argument("--only", choices=("stills", "frames"))
    parser.add_argument("--report-only", action="store_true", help="exit status 0 even if a ratio is missed")
    parser.add_argument("--build", default=os.path.join(FOLDER, *[os.pardir] * 3, "build"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.runs < 1:
        parser.error("--runs must be 1 or more")
    return options


def main():
    options = parse()
    build = os.path.abspath(options.build)
    for program in ("penumbra", "make_scene", "embree_baseline"):
        if not os.path.exists(os.path.join(build, program)):
            raise SystemExit(f"{build} has no {program}: run tests/run.sh, with the package libembree-dev installed")
    out = os.path.join(build, "speed")
    os.makedirs(out, exist_ok=True)
    os.chdir(out)
    results = {"processors": os.cpu_count()}
    if options.only != "frames":
        results["stills"] = measure_stills(min(options.runs, 3))
        print_stills(results["stills"])
    if options.only != "stills":
        programs = frame.Programs(build)
        results["frames"] = {}
        for name, capture, ambient in write_captures(programs):
            results["frames"][name] = frame.measure(programs, capture, ambient, options.runs)
            print_frame(name, results["frames"][name])
    missed = results["missed"] = list(faults(results))
    with open("speed.json", "w", encoding="ascii") as file:
        json.dump(results, file, indent=2)
    print("\n" + "\n".join(["MISSED " + line for line in missed] or ["all required ratios are kept"]))
    return 1 if missed and not options.report_only else 0


if __name__ == "__main__":
    sys.exit(main())
