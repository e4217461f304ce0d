#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [--window | --vulkan] [TEST...]: installs the add-on's zip into an empty Blender profile and runs the
# tests inside Blender, without a window and then, those of window/, in one on a display of its own. TEST is a module,
# class or method such as test_render.Border; after --window one of window/, such as test_viewport.Edits. --vulkan is
# --window with Blender's Vulkan back end, from Blender 4.3 on. BLENDER names the program, TEST_SCRIPT another script to
# run with the arguments.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
build=$(CDPATH= cd -- "$1" && pwd)
shift
window=no backend=
case ${1-} in
--window) window=only; shift ;;
--vulkan) window=only backend=VULKAN; shift ;;
esac
[ $# -gt 0 ] || [ $window = only ] || window=too
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
blender=${BLENDER:-blender}
mkdir -p "$work/scripts/addons" "$work/config" "$work/output"
export BLENDER_USER_RESOURCES="$work" BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config"
export TEST_OUTPUT="$work/output" PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8
unset DISPLAY WAYLAND_DISPLAY PENUMBRA_LIBRARY PENUMBRA_CAPTURE
zip=$(ls "$build"/penumbra-*.zip)
export TEST_ZIP="$zip"
case $("$blender" --version) in
"Blender 3."* | "Blender 4.0"* | "Blender 4.1"*)
    export TEST_ADDON=penumbra
    python3 -m zipfile -e "$zip" "$work/scripts/addons"
    ;;
*)
    export TEST_ADDON=bl_ext.user_default.penumbra
    "$blender" -b --factory-startup --command extension validate "$zip"
    "$blender" -b --factory-startup --command extension install-file --repo user_default "$zip"
    ;;
esac
if [ -n "${TEST_SCRIPT-}" ]; then
    "$blender" -b --factory-startup --python-exit-code 1 --python "$TEST_SCRIPT" -- "$@"
    exit
fi
status=0
if [ $window != only ]; then
    "$blender" -b --factory-startup --python-exit-code 1 --python "$here/run_tests.py" -- "$@" || status=1
fi
if [ $window != no ]; then
    # Blender with a window always ends with 0: the tests write what they found.
    mkdir "$work/display"
    width=640 height=480
    [ "${1-}" != latency ] || { width=960; height=540; }
    export TEST_DISPLAY="$work/display" TEST_BACKEND=$backend
    xvfb-run -a -s "-screen 0 ${width}x${height}x24 -nocursor -fbdir $work/display" "$blender" \
        --factory-startup ${backend:+--gpu-backend vulkan} \
        -p 0 0 $width $height --python "$here/window/run_tests.py" -- "$@"
    [ "$(cat "$work/output/window-status")" = 0 ] || status=1
fi
exit $status
