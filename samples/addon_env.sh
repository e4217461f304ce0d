# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# To be sourced with `root` and `build` set to the source and build folder, after building the target `addon`. Gives
# Blender a user folder of its own in there, so that the user's settings are neither read nor changed, and installs the
# add-on in it if it is new.

# shellcheck disable=SC2154
export BLENDER_USER_RESOURCES="$build/blender" # 4.2 and newer
export BLENDER_USER_CONFIG="$build/blender/config"
export BLENDER_USER_SCRIPTS="$build/blender/scripts"
export BLENDER_USER_DATAFILES="$build/blender/datafiles"

version=$(sed -n 's/^#define PNB_VERSION "\(.*\)"/\1/p' "$root/core/include/penumbra.h")
zip=$build/penumbra-$version.zip
if [[ ! -f $zip ]]; then
    echo "There is no $zip; build the target 'addon' first." >&2
    exit 1
fi
if [[ ! $build/blender/installed -nt $zip ]]; then
    mkdir -p "$BLENDER_USER_CONFIG" "$BLENDER_USER_SCRIPTS/addons" "$BLENDER_USER_DATAFILES"
    blender -b --factory-startup --python-exit-code 1 --python "$root/samples/install_addon.py" -- "$zip" \
        >"$build/blender/install.log" 2>&1 || {
        cat "$build/blender/install.log" >&2
        exit 1
    }
    touch "$build/blender/installed"
fi
