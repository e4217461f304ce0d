#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR RESULTS [ROW...]: compares the scenes of this folder, or those named, with Cycles in one Blender.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
results=$2
build=$1
shift 2
TEST_SCRIPT="$here/compare.py" exec sh "$here/../run.sh" "$build" "$results" "$@"
