#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# check_headers.sh: penumbra.h compiles alone and without a warning in every version of C and C++ in use.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/report.sh
. "$here/report.sh"

# What a host writes first; GCC 12 and newer know what PNB_INIT leaves out to be zero.
program='#include <penumbra.h>
int main(void) {
    pnb_scene scene = PNB_INIT(pnb_scene);
    pnb_settings settings = PNB_INIT(pnb_settings);
    scene.camera.struct_size = sizeof scene.camera;
    return scene.light_count + settings.width == 0 ? 0 : 1;
}'

compile() {
    "$1" -x "$2" "-std=$3" -pedantic-errors -Wall -Wextra -Wconversion -Wshadow -Wno-missing-field-initializers \
        -Werror -fsyntax-only -I "$here/../core/include" - <<<"$program"
}

for standard in c99 c11 c17 c++11 c++17 c++20; do
    case $standard in
    c++*) language=c++ compilers="g++ clang++" ;;
    *) language=c compilers="gcc clang" ;;
    esac
    for compiler in $compilers; do
        if command -v "$compiler" >/dev/null; then
            check "penumbra.h as $standard with $compiler" compile "$compiler" "$language" "$standard"
        fi
    done
done
report
