#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [errors|times|widths|tables...] [SCENE|CAPTURE.pnb...]: errors and times of ESM and ESSM beside
# PCSS. Without parts all of them, without scenes those listed here; widths and tables have scenes of their own. Times
# need a machine that does nothing else; a part takes half a minute to three minutes.
set -eu
build=$1
shift
files=$(mktemp -d)
trap 'rm -rf "$files"' EXIT
parts="" scenes=""
for argument in "$@"; do
    case $argument in
    errors | times | widths | tables) parts="$parts $argument" ;;
    *) scenes="$scenes $argument" ;;
    esac
done
grid15="-t pcss -p pattern=GRID -p blocker_samples=81 -p filter_samples=225"
grid32="-t pcss -p pattern=GRID -p blocker_samples=1024 -p filter_samples=1024"

make_scene() { # scene or capture, options
    scene=$1
    shift
    case $scene in
    *.pnb) cp "$scene" "$files/scene.pnb" ;;
    *) "$build/make_scene" "$@" "$scene" "$files/scene.pnb" ;;
    esac
    case $scene in
    half-plane | ball | hover | slot | discs | slats | perforated | slanted-sheet | plane | terraces) size=180x180 ;;
    *) size=320x180 ;;
    esac
}

truth() { # REFERENCE's points on each side of the light
    "$build/penumbra" render "$files/scene.pnb" -s "$size" -t reference --light-samples "$1" \
        -o "$files/truth.exr" >"$files/log"
}

rmse() { # options: error of the scene against its truth
    # shellcheck disable=SC2086
    "$build/penumbra" render "$files/scene.pnb" -s "$size" $1 -o "$files/image.exr" >"$files/log"
    "$build/penumbra" compare "$files/image.exr" "$files/truth.exr" | awk '$1 == "RMSE" { print $2 }'
}

part_errors() {
    echo "RMSE against REFERENCE of 16 x 16: ESM, ESSM, PCSS 15 x 15, PCSS 32 x 32"
    for scene in ${scenes:-half-plane ball hover slot discs slats perforated slanted-sheet plane sphere box fence \
        stairs lantern tall-box cubes benchmark terraces grazing-fence all-lights}; do
        make_scene "$scene"
        truth 16
        echo "$(basename "$scene" .pnb) $(rmse '-t esm') $(rmse '-t essm') $(rmse "$grid15") $(rmse "$grid32")" |
            tee -a "$files/rows"
    done
    awk '{ for (i = 2; i <= 5; i++) sum[i] += $i }
        END { printf "mean"; for (i = 2; i <= 5; i++) printf " %.4f", sum[i] / NR
              printf "\nESSM / PCSS 15 x 15: %.3f\n", sum[3] / sum[4] }' "$files/rows"
}

visibility() { # options: milliseconds of the visibility pass
    # shellcheck disable=SC2086
    "$build/penumbra" bench "$files/scene.pnb" -n "$runs" $1 | awk '$1 == "Visibility" { print $3 }'
}

part_times() {
    runs=5
    echo "Visibility pass at 1280 x 960, ms: ESSM, PCSS 32 x 32"
    for scene in ${scenes:-stairs benchmark}; do
        make_scene "$scene"
        echo "$scene $(visibility '-s 1280x960 -t essm') $(visibility "-s 1280x960 $grid32")" |
            awk '{ printf "%s, ratio %.2f\n", $0, $3 / $2 }'
    done
}

part_widths() {
    runs=3
    echo "Visibility pass by width of the light at 640 x 480, ms: ESSM; PCSS with samples in proportion to the area"
    samples=4
    for width in 0.1 0.4 1.6; do
        make_scene box --light-size $width
        pcss="-t pcss -p min_max=false -p blocker_samples=$samples -p filter_samples=$samples"
        echo "$width m $(visibility '-s 640x480 -t essm -p min_max=false')" \
            "$(visibility "-s 640x480 $pcss") ($samples points)"
        samples=$((samples * 16))
    done
}

part_tables() {
    "$build/bench_tables"
}

for part in ${parts:-errors times widths tables}; do
    "part_$part"
done
