# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# To be sourced by scripts that check something. A script ends with `report`.
passed=0 failed=0

# check WHAT COMMAND...: passes if the command does; what it prints is shown only if it fails.
check() {
    local what=$1 output
    shift
    if output=$("$@" 2>&1); then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf 'FAILED: %s\n%s\n' "$what" "$output"
    fi
}

report() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
}
