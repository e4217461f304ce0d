#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# check_columns.sh: no line of a source file has more than 120 columns. Characters count, not bytes.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/report.sh
. "$here/report.sh"
cd "$here/.."
export LC_ALL=C.UTF-8

mapfile -d '' -t sources < <(git ls-files -z -- '*.c' '*.h' '*.cc' '*.py' '*.sh' '*.glsl' '*.comp' '*.frag' '*.vert' \
    '*.cmake' '*CMakeLists.txt')

no_long_line() {
    local status=0
    grep -EHn '.{121}' "${sources[@]}" </dev/null || status=$?
    [ "$status" -eq 1 ] # none found; 2: a file could not be read
}

check "git lists the source files" test "${#sources[@]}" -gt 0
check "no line has more than 120 columns" no_long_line
report
