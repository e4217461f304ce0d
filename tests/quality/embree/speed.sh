#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# speed.sh BUILD_DIR [options]: time and error of techniques beside those of a CPU ray tracer, in one run.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8 exec python3 "$here/speed.py" "$@"
