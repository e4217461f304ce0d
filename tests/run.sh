#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail

help() {
    cat <<EOF
Usage: tests/run.sh [options]
Installs what is missing, builds Penumbra into build/ and runs all tests. The last line counts them; the exit status is
0 if none failed.

  --suite NAME   only this one; may be given several times
  --fast         all but sanitizers
  --help

Suites: checks      what the library exports, its header, its shaders, columns of sources
        library     test programs of the library: unit/, gl/, fault/, quality/
        tool        the command-line tool
        addon       the add-on inside Blender
        sanitizers  the library's test programs with AddressSanitizer and UndefinedBehaviorSanitizer
What one command says stays in build/tests/NAME.log. Measurements against other renderers are commands of their own:
tests/quality/*/run.sh.
EOF
}

fail() {
    echo "run.sh: $1" >&2
    exit 2
}

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
build=${PENUMBRA_BUILD:-$root/build}
all=(checks library tool addon sanitizers)
wanted=()
while [ $# -gt 0 ]; do
    case $1 in
    --help) help; exit 0 ;;
    --fast) wanted+=(checks library tool addon); shift ;;
    --suite)
        [ $# -ge 2 ] || fail "--suite needs a name"
        [[ " ${all[*]} " == *" $2 "* ]] || fail "unknown suite '$2'; there are: ${all[*]}"
        wanted+=("$2")
        shift 2 ;;
    *) fail "unknown option '$1'; see --help" ;;
    esac
done
[ ${#wanted[@]} -gt 0 ] || wanted=("${all[@]}")
unset DISPLAY WAYLAND_DISPLAY PENUMBRA_BACKEND PENUMBRA_SHADER_DIR
export LC_ALL=C.UTF-8

# ---- Suites: each prints a line `N passed, N failed` ----

# build_into FOLDER CMAKE_OPTION...
build_into() {
    local folder=$1
    shift
    cmake -G Ninja -S "$root" -B "$folder" -DPNB_WERROR=ON -DPNB_TESTS=ON "$@" >/dev/null && cmake --build "$folder"
}

# The test programs that CMake knows; each counts as one, however much it checks. As many at once as there are
# processors, with one thread of llvmpipe each: two threads of one program wait for each other a third of the time.
run_programs() {
    local report=$1/tests.xml status=0
    rm -f "$report"
    # Indented: what a program counts is not what the suite counts.
    LP_NUM_THREADS=1 ctest --test-dir "$1" -j "$(nproc)" --output-on-failure --no-tests=error \
        --output-junit "$report" | sed -u 's/^/    /' || status=$?
    count() { sed -n "s/.*\b$1=\"\([0-9]*\)\".*/\1/p" "$report" | head -n 1; }
    local tests failures skipped
    tests=$(count tests) failures=$(count failures) skipped=$(count skipped)
    echo "$((tests - failures - skipped)) passed, $failures failed, $skipped skipped"
    return "$status"
}

suite_checks() {
    local status=0
    bash "$root/tests/check_binary.sh" "$build" || status=1
    bash "$root/tests/check_headers.sh" || status=1
    bash "$root/tests/check_columns.sh" || status=1
    bash "$root/tests/check_shaders.sh" "$build" || status=1
    return "$status"
}

suite_library() {
    run_programs "$build"
}

suite_tool() {
    sh "$root/tests/tools/run.sh" "$build"
}

suite_addon() {
    sh "$root/tests/blender/run.sh" "$build"
}

suite_sanitizers() {
    build_into "$build-sanitize" -DPNB_SANITIZE=address,undefined -DPNB_TOOLS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo &&
        run_programs "$build-sanitize"
}

# ---- Running them and counting ----

passed=0 failed=0 skipped=0 summary=

# Adds up what the lines `N passed, N failed[, N skipped]` of the log at $1 say.
add_counts() {
    local line number
    while read -r line; do
        number=${line%% *}
        case $line in
        *passed) suite_passed=$((suite_passed + number)) ;;
        *failed) suite_failed=$((suite_failed + number)) ;;
        *skipped) suite_skipped=$((suite_skipped + number)) ;;
        esac
    done < <(grep -E '^[0-9]+ (passed, [0-9]+ failed|skipped)' "$1" | grep -Eo '[0-9]+ (passed|failed|skipped)')
}

run_suite() {
    local name=$1 log=$build/tests/$1.log status=0 start=$SECONDS
    local suite_passed=0 suite_failed=0 suite_skipped=0
    echo "---- $name"
    # A suite that ends early is a failure, whatever its last line says.
    "suite_$name" 2>&1 | tee "$log" || status=1
    add_counts "$log"
    if [ "$suite_failed" -eq 0 ] && { [ "$status" -ne 0 ] || [ "$suite_passed" -eq 0 ]; }; then
        suite_failed=1
    fi
    passed=$((passed + suite_passed)) failed=$((failed + suite_failed)) skipped=$((skipped + suite_skipped))
    summary+=$(printf '%-11s %4d s  %d passed, %d failed, %d skipped' "$name" $((SECONDS - start)) \
        "$suite_passed" "$suite_failed" "$suite_skipped")$'\n'
}

"$root/samples/setup.sh" run build test
if ! build_into "$build"; then
    echo "0 passed, 1 failed"
    exit 1
fi
mkdir -p "$build/tests"
for suite in "${wanted[@]}"; do
    run_suite "$suite"
done
echo "---- all, $SECONDS s"
printf '%s' "$summary"
if [ "$skipped" -gt 0 ]; then
    echo "$passed passed, $failed failed, $skipped skipped"
else
    echo "$passed passed, $failed failed"
fi
[ "$failed" -eq 0 ]
