#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh [BUILD_DIR] [options]: speed beside EEVEE, Cycles and a CPU ray tracer; see --help. The build folder (default:
# build/) is one that tests/run.sh has filled.
set -eu

root=$(CDPATH='' cd -- "$(dirname -- "$0")/../../.." && pwd)
build=${PENUMBRA_BUILD:-$root/build}
case ${1:-} in
'' | -*) ;;
*) build=$(CDPATH='' cd -- "$1" && pwd); shift ;;
esac
# shellcheck source=samples/addon_env.sh
. "$root/samples/addon_env.sh"
unset DISPLAY WAYLAND_DISPLAY PENUMBRA_CAPTURE
export PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8
exec python3 "$root/tests/quality/speed/run.py" --build "$build" "$@"
