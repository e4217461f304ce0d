#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing of packages.txt. Arguments: groups (run, build, test); none: all of them.
# Needs root only if something is missing.
set -eu

folder=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
groups=${*:-run build test}
export DEBIAN_FRONTEND=noninteractive

wanted=$(awk -v groups=" $groups " '!/^#/ && NF == 2 && index(groups, " " $1 " ") { print $2 }' "$folder/packages.txt")
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | awk '$1 == "installed" { print $2 }')
missing=$(printf '%s\n' "$wanted" | grep -Fxv "$installed" || true)
[ -n "$missing" ] || exit 0

missing=${missing//$'\n'/ }
if [ "$(id -u)" -ne 0 ]; then
    echo "These Debian packages are missing; run as root: apt-get install $missing" >&2
    exit 1
fi
echo "Installing $missing"
apt-get -qq update
# shellcheck disable=SC2086
apt-get -qq install -y --no-install-recommends $missing >/dev/null
