#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD_DIR [times|errors|layers...] [SCENE...]: times of MULTILAYER's passes and its errors by its parameters,
# in the shape of the paper's tables 1 to 4, and errors by number of layers. On a machine that does nothing else.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
python3 "$here/tables.py" "$@"
