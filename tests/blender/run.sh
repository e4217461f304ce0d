#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [TEST...]: installs the add-on's zip into an empty Blender profile and runs the tests inside
# Blender. TEST is a module, class or method such as test_render.Border. BLENDER names the program.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
build=$(CDPATH= cd -- "$1" && pwd)
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/scripts/addons" "$work/config" "$work/output"
zip=$(ls "$build"/penumbra-*.zip)
(cd "$work/scripts/addons" && cmake -E tar xf "$zip")
export BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config" TEST_OUTPUT="$work/output"
export PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8
unset DISPLAY WAYLAND_DISPLAY PENUMBRA_LIBRARY PENUMBRA_CAPTURE
"${BLENDER:-blender}" -b --factory-startup --python-exit-code 1 --python "$here/run_tests.py" -- "$@"
