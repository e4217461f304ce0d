#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR: measures REFERENCE against ray tracing, for every kind of light.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8 exec python3 "$here/reference.py" "$@"
