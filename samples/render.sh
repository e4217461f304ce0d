#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
set -eu

help() {
    cat <<EOF
Usage: samples/render.sh [options]
Installs what is missing, builds Penumbra into build/, installs the add-on into a Blender user folder inside build/,
renders a sample scene through Blender without a display, and prints where the picture is.

  --scene NAME        one of $scenes (default: still_life)
  --technique ID      HARD, PCF, PCSS, REFERENCE, ... (default: PCSS)
  --size WxH          pixels (default: 1280x720)
  --samples N         anti-aliasing samples per pixel (default: 8)
  --output FILE.png   (default: build/samples/NAME-ID.png)
  --help
EOF
}

fail() {
    echo "render.sh: $1" >&2
    exit 1
}

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
build=${PENUMBRA_BUILD:-$root/build}
scenes=$(sed -n 's/^SCENES = (\(.*\))$/\1/p' "$root/samples/scenes/build.py" | tr -d '",')
scene=still_life technique=PCSS size=1280x720 samples=8 output=
while [ $# -gt 0 ]; do
    case $1 in
    --help) help; exit 0 ;;
    --scene | --technique | --size | --samples | --output)
        [ $# -ge 2 ] || fail "$1 needs a value"
        eval "${1#--}=\$2"
        shift 2 ;;
    *) fail "unknown option '$1'; see --help" ;;
    esac
done
case " $scenes " in *" $scene "*) ;; *) fail "unknown scene '$scene'; there are: $scenes" ;; esac
echo "$size" | grep -Eqx '[1-9][0-9]*x[1-9][0-9]*' || fail "--size takes WIDTHxHEIGHT, not '$size'"
echo "$samples" | grep -Eqx '[1-9][0-9]*' || fail "--samples takes a number, not '$samples'"

"$root/samples/setup.sh" run build
[ -f "$build/build.ninja" ] || cmake -G Ninja -S "$root" -B "$build" >/dev/null
cmake --build "$build" --target all addon
# shellcheck source=samples/addon_env.sh
. "$root/samples/addon_env.sh"

mkdir -p "$build/samples"
blend=$build/samples/$scene.blend
if [ ! -f "$blend" ] || [ -n "$(find "$root/samples/scenes" -name '*.py' -newer "$blend")" ]; then
    blender -b --factory-startup --python-exit-code 1 --python "$root/samples/scenes/build.py" -- \
        "$scene" "$blend" >"$blend.log" 2>&1 || { cat "$blend.log" >&2; exit 1; }
fi
case ${output:=$build/samples/$scene-$technique.png} in /*) ;; *) output=$PWD/$output ;; esac
rm -f "$output"
log=$build/samples/$scene.log
if ! blender -b "$blend" --python-exit-code 1 --python "$root/samples/render.py" -- \
    "$technique" "${size%x*}" "${size#*x}" "$samples" "$output" >"$log" 2>&1 || [ ! -s "$output" ]; then
    cat "$log" >&2
    fail "the render failed"
fi
grep -i "warning" "$log" || true
echo "$output"
