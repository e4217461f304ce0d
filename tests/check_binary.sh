#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# check_binary.sh BUILD_DIR: what libpenumbra.so shows to the programs that load it.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/report.sh
. "$here/report.sh"
library=$1/libpenumbra.so

exported=$(nm -D --defined-only "$library" | awk '{ print $3 }' | sort)
declared=$(sed -n 's/^PNB_API .*\b\(pnb_[a-z0-9_]*\)(.*/\1/p' "$here/../core/include/penumbra.h" | sort)
check "exactly the functions of penumbra.h are exported" diff <(echo "$declared") <(echo "$exported")

# pthread and dl are part of libc; the loader provides thread-local storage.
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
    grep -Ev '^(libc\.so\.6|libm\.so\.6|ld-linux.*)$' || true)
check "only libc and libm are needed${needed:+, not $needed}" test -z "$needed"

dynamic=$(readelf -d "$library")
no() { ! grep -q -- "$1" <<<"$2"; }
check "no text relocations" no TEXTREL "$dynamic"
check "no static thread-local storage, which loading at run time may lack" no STATIC_TLS "$dynamic"
check "no path to other libraries is built in" no 'RPATH\|RUNPATH' "$dynamic"
check "symbols are bound at load" grep -q BIND_NOW <<<"$dynamic"
segments=$(readelf -lW "$library")
check "tables are read-only after load" grep -q GNU_RELRO <<<"$segments"
check "the stack is not executable" no 'GNU_STACK.*RWE' "$segments"
report
