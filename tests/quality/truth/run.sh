#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Measures REFERENCE and EEVEE against Cycles; arguments: see --help of run.py. Needs the target `addon` built.
set -eu

root=$(CDPATH='' cd -- "$(dirname -- "$0")/../../.." && pwd)
build=${PENUMBRA_BUILD:-$root/build}
# shellcheck source=samples/addon_env.sh
. "$root/samples/addon_env.sh"
exec python3 "$root/tests/quality/truth/run.py" --build "$build" "$@"
