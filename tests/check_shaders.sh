#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# check_shaders.sh BUILD_DIR: every shader the library hands to OpenGL, with its defines and includes, is valid for
# Khronos' reference compiler, which is stricter than drivers are; and every file of shaders/ is in one of them.
# Mesa writes the sources down while test_door renders with all techniques, lights and materials, and test_jobs several
# samples.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/report.sh
. "$here/report.sh"
sources=$(mktemp -d)
trap 'rm -rf "$sources"' EXIT

check "test_door renders" env MESA_SHADER_DUMP_PATH="$sources" "$1/test_door" bad_materials bad_lights parameter_ranges
check "test_jobs renders" env MESA_SHADER_DUMP_PATH="$sources" "$1/test_jobs"
for source in "$sources"/*.glsl; do
    case ${source##*/} in
    VS_*) stage=vert ;;
    FS_*) stage=frag ;;
    *) stage=comp ;;
    esac
    check "$stage shader ${source##*/}" glslangValidator -S "$stage" "$source"
done
check "every file of shaders/ is used" python3 "$here/shaders_used.py" "$here/../shaders" "$sources"
report
