#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [TEST...]: tests the command-line tool. TEST is a part of the names of the tests to run.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8 exec python3 "$here/run_tests.py" "$@"
