#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [CAPTURE.pnb ...]: errors and times of ESM and ESSM beside PCSS, errors also on the captures, such as those
# of the samples. Takes minutes, on a machine that does nothing else.
set -eu
build=$1
shift
files=$(mktemp -d)
trap 'rm -rf "$files"' EXIT
scenes="half-plane ball hover slot discs slats perforated slanted-sheet sphere box fence stairs lantern tall-box cubes
benchmark all-lights"
grid15="-t pcss -p pattern=GRID -p blocker_samples=81 -p filter_samples=225"
grid32="-t pcss -p pattern=GRID -p blocker_samples=1024 -p filter_samples=1024"

rmse() { # options: error of the scene against its truth
    # shellcheck disable=SC2086
    "$build/penumbra" render "$files/scene.pnb" -s "$size" $1 -o "$files/image.exr" >"$files/log"
    "$build/penumbra" compare "$files/image.exr" "$files/truth.exr" | awk '$1 == "RMSE" { print $2 }'
}

echo "RMSE against REFERENCE of 16 x 16: ESM, ESSM, PCSS 15 x 15, PCSS 32 x 32"
for scene in $scenes "$@"; do
    case $scene in
    *.pnb) cp "$scene" "$files/scene.pnb" ;;
    *) "$build/make_scene" "$scene" "$files/scene.pnb" ;;
    esac
    case $scene in half-plane | ball | hover | slot | discs | slats | perforated | slanted-sheet) size=180x180 ;; *) size=320x180 ;; esac
    "$build/penumbra" render "$files/scene.pnb" -s $size -t reference --light-samples 16 -o "$files/truth.exr" >"$files/log"
    echo "$(basename "$scene" .pnb) $(rmse '-t esm') $(rmse '-t essm') $(rmse "$grid15") $(rmse "$grid32")"
done | awk '{ print; for (i = 2; i <= 5; i++) sum[i] += $i; n++ }
    END { printf "mean"; for (i = 2; i <= 5; i++) printf " %.4f", sum[i] / n; printf "\nESSM / PCSS 15 x 15: %.3f\n", sum[3] / sum[4] }'

visibility() { # options: milliseconds of the visibility pass
    # shellcheck disable=SC2086
    "$build/penumbra" bench "$files/scene.pnb" -n 5 $1 | awk '$1 == "Visibility" { print $3 }'
}

echo "Visibility pass at 1280 x 960, ms: ESSM, PCSS 32 x 32"
for scene in stairs benchmark; do
    "$build/make_scene" $scene "$files/scene.pnb"
    echo "$scene $(visibility '-s 1280x960 -t essm') $(visibility "-s 1280x960 $grid32")"
done | awk '{ printf "%s, ratio %.2f\n", $0, $3 / $2 }'

echo "Visibility pass by width of the light at 640 x 480, ms: ESSM; PCSS with samples in proportion to the area"
samples=4
for width in 0.1 0.4 1.6; do
    "$build/make_scene" --light-size $width box "$files/scene.pnb"
    echo "$width m $(visibility '-s 640x480 -t essm -p min_max=false')" \
        "$(visibility "-s 640x480 -t pcss -p min_max=false -p blocker_samples=$samples -p filter_samples=$samples") ($samples points)"
    samples=$((samples * 16))
done

echo "Tables"
"$build/bench_tables"
