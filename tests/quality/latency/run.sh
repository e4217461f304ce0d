#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
set -eu

help() {
    cat <<EOF
Usage: tests/quality/latency/run.sh [BUILD_DIR] [--latency MS] [ENGINE...]
How fast a viewport of 960 x 540 follows input: 100,000 triangles, an area light, PCSS, on a display of its own. Per
engine the time from a moved lamp to the changed display, pictures per second while the view orbits, the longest time
that Blender's event loop did not run, and what share of the region's width the first picture has. Times are only
comparable within one run.

Engines (default: all but CYCLES): PENUMBRA with first pictures of all pixels; TARGET, as small as the latency asks for;
EEVEE; CYCLES; NOTHING, which draws one colour: what Blender itself takes.

  --latency MS   Performance > Latency of TARGET (default 150)
EOF
}

root=$(CDPATH='' cd -- "$(dirname -- "$0")/../../.." && pwd)
build=${PENUMBRA_BUILD:-$root/build}
case ${1:-} in
--help) help; exit 0 ;;
'' | -* | [A-Z]*) ;;
*) build=$(CDPATH='' cd -- "$1" && pwd); shift ;;
esac
# shellcheck source=samples/addon_env.sh
. "$root/samples/addon_env.sh"
unset DISPLAY WAYLAND_DISPLAY PENUMBRA_CAPTURE
TEST_DISPLAY=$(mktemp -d)
export TEST_DISPLAY PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8
trap 'rm -rf "$TEST_DISPLAY"' EXIT
xvfb-run -a -s "-screen 0 960x540x24 -nocursor -fbdir $TEST_DISPLAY" \
    "${BLENDER:-blender}" --factory-startup -p 0 0 960 540 --python "$root/tests/quality/latency/latency.py" -- "$@"
