#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail

help() {
    cat <<EOT
Usage: tests/blender/matrix.sh [--only VERSION] [--scenes | --script NAME] BUILD_DIR [--window | --vulkan]
       [TEST...]
Runs the tests of this folder in three Blenders: the system's, and those of Debian trixie (4.3) and sid (5.2) in roots
of their own, made with debootstrap from the mirror that apt uses and kept in BUILD_DIR/matrix, or in the folder that
PENUMBRA_CACHE names. A root takes about 2 GB; delete it to make it anew. Needs root. The last line counts all tests.

  --only VERSION   system, trixie or sid; may be given several times
  --scenes         instead of the tests, compares the scenes of scenes/ with Cycles, or those named, and writes
                   BUILD_DIR/scenes/report.html; takes about ten minutes a version
  --script NAME    instead of the tests, runs soak or scale
  TEST             a module, class or method such as test_render.Sizes
  --window         only tests that need a window; TEST then is one of them
  --vulkan         as --window, with Blender's Vulkan back end; not in Blender 3.4
EOT
}

fail() {
    echo "matrix.sh: $1" >&2
    exit 2
}

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
source=$(CDPATH='' cd -- "$here/../.." && pwd)
versions=()
scenes= script=
while [ $# -gt 0 ]; do
    case $1 in
    --help) help; exit 0 ;;
    --only)
        [[ ${2-} =~ ^(system|trixie|sid)$ ]] || fail "--only needs system, trixie or sid"
        versions+=("$2")
        shift 2 ;;
    --scenes) scenes=1; shift ;;
    --script)
        [[ ${2-} =~ ^(soak|scale)$ ]] || fail "--script needs soak or scale"
        script=$2
        shift 2 ;;
    -*) fail "unknown option '$1'; see --help" ;;
    *) break ;;
    esac
done
[ $# -gt 0 ] || { help >&2; exit 2; }
[ -d "$1" ] || fail "there is no build folder '$1'"
build=$(CDPATH='' cd -- "$1" && pwd)
shift
[ ${#versions[@]} -gt 0 ] || versions=(system trixie sid)
cache=${PENUMBRA_CACHE:-$build/matrix}
logs=$build/tests
results=$build/scenes
mkdir -p "$cache" "$logs" "$results"
cache=$(CDPATH='' cd -- "$cache" && pwd)

# ---- Roots ----

# The mirror of the Debian release this machine runs, as apt knows it.
mirror() {
    local codename
    codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $codename" | head -n 1
}

# in_root ROOT COMMAND...: with its own mounts, which end with the command.
in_root() {
    # shellcheck disable=SC2016
    unshare --mount sh -c '
        root=$1 source=$2 build=$3 results=$4
        shift 4
        mkdir -p "$root/penumbra/source" "$root/penumbra/build" "$root/penumbra/results"
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        mount -t tmpfs tmpfs "$root/tmp"
        mount --bind -o ro "$source" "$root/penumbra/source"
        mount --bind -o ro "$build" "$root/penumbra/build"
        mount --bind "$results" "$root/penumbra/results"
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
            chroot "$root" "$@"' sh "$1" "$source" "$build" "$results" "${@:2}"
}

check_room() {
    local free
    command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
    free=$(df --output=avail -B 1M "$cache" | tail -n 1)
    [ "$free" -ge 4000 ] || fail "$cache has $free MB left; making a root takes 4000"
}

# Chained, because `set -e` does not hold where a failure is looked at.
make_root() {
    local suite=$1 root=$cache/$1.partial
    rm -rf --one-file-system "$root" &&
        debootstrap --variant=minbase "$suite" "$root" "$(mirror)" &&
        printf '%s\n' force-unsafe-io 'path-exclude=/usr/share/doc/*' 'path-exclude=/usr/share/locale/*' \
            >"$root/etc/dpkg/dpkg.cfg.d/small" &&
        printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" &&
        chmod +x "$root/usr/sbin/policy-rc.d" &&
        ln -sf ../proc/self/mounts "$root/etc/mtab" &&
        in_root "$root" apt-get -q install -y --no-install-recommends blender python3 python3-cattr python3-requests \
            libgl1 libegl1 libegl-mesa0 libgl1-mesa-dri mesa-vulkan-drivers xvfb xauth &&
        in_root "$root" apt-get clean &&
        mv "$root" "$cache/$suite"
}

# ---- Running and counting ----

passed=0 failed=0 summary=

# run_inside VERSION SOURCE BUILD RESULTS [TEST...]: with the folders as that Blender sees them.
run_inside() {
    local version=$1 source_there=$2 build_there=$3 results_there=$4 command=()
    shift 4
    if [ -n "$scenes" ]; then
        command=(sh "$source_there/tests/blender/scenes/run.sh" "$build_there" "$results_there" "$@")
    else
        command=(sh "$source_there/tests/blender/run.sh" "$build_there" "$@")
        [ -z "$script" ] || command=(env "TEST_SCRIPT=$source_there/tests/blender/$script.py" "${command[@]}")
    fi
    if [ "$version" = system ]; then
        "${command[@]}"
    else
        in_root "$cache/$version" "${command[@]}"
    fi
}

run_version() {
    local version=$1 log=$logs/matrix-$1.log status=0 start counts name
    shift
    if [ "$version" != system ] && [ ! -d "$cache/$version" ]; then
        check_room
        echo "Making the root of $version in $cache"
        make_root "$version" >"$logs/matrix-root-$version.log" 2>&1 ||
            fail "the root of $version could not be made; see $logs/matrix-root-$version.log"
    fi
    echo "---- $version"
    start=$SECONDS
    if [ "$version" = system ]; then
        run_inside system "$source" "$build" "$results" "$@"
    else
        run_inside "$version" /penumbra/source /penumbra/build /penumbra/results "$@"
    fi 2>&1 | tee "$log" || status=1
    # Without and with a window.
    counts=$(awk '/^[0-9]+ passed, [0-9]+ failed$/ { passed += $1; failed += $3; n++ }
        END { if (n) print passed " passed, " failed " failed" }' "$log")
    # A run that ends early is a failure, whatever it counted.
    [ -n "$counts" ] || counts="0 passed, 1 failed"
    [ "$status" -eq 0 ] || [[ $counts != *" 0 failed" ]] || counts="${counts%0 failed}1 failed"
    name=$(grep -E '^Blender [0-9.]+' "$log" | tail -n 1 || true)
    summary+=$(printf '%-7s %4d s  %s; %s' "$version" $((SECONDS - start)) "$counts" "${name:-no Blender}")$'\n'
    passed=$((passed + ${counts%% *}))
    counts=${counts#*, }
    failed=$((failed + ${counts%% *}))
}

for version in "${versions[@]}"; do
    [ "$version" = system ] || [ "$(id -u)" -eq 0 ] || fail "$version runs in a root of its own, which needs root"
done
for version in "${versions[@]}"; do
    run_version "$version" "$@"
done
echo "---- all, $SECONDS s"
printf '%s' "$summary"
[ -z "$scenes" ] || python3 "$here/scenes/report.py" "$results"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
