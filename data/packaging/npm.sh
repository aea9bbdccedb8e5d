#!/bin/sh
# Makes the package for npm, ffd-mesh-VERSION.tgz, with Debian's emscripten and the sources of .ci/wraps: the same bytes from the
# same commit, without a network.
#     sh data/packaging/npm.sh OUT [BUILD]      BUILD: a folder that is kept, for the next run
set -eu

root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:?OUT is missing}
mkdir -p "$out"
out=$(cd "$out" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build=${2-$work/build}

fail() {
    echo "npm.sh: $1" >&2
    exit 1
}

missing=
for tool in emcc meson ninja python3 tar gzip; do
    command -v "$tool" >/dev/null 2>&1 || missing="$missing $tool"
done
[ -z "$missing" ] || fail "not installed:$missing"
for wrap in "$root"/subprojects/*.wrap; do
    folder=$(sed -n 's/^directory = //p' "$wrap")
    [ -d "$root/subprojects/$folder" ] || missing="$missing $folder"
done
[ -z "$missing" ] || fail "subprojects/ lacks$missing (sh .ci/wraps gets them)"

version=$(sed -n 's/^#define FFD_VERSION "\(.*\)"$/\1/p' "$root/include/ffd/version.h")
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH-$(git -C "$root" log -1 --format=%ct)}
export SOURCE_DATE_EPOCH
# Debian's libraries of emscripten are complete, and their folder is not ours to write to.
export EM_FROZEN_CACHE=1
# Where Debian has what emscripten's own scripts need: another node does not look there.
export NODE_PATH="/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}"
if command -v ccache >/dev/null 2>&1; then
    export EM_COMPILER_WRAPPER=ccache CCACHE_DEPEND=1
fi

if [ ! -f "$build/build.ninja" ]; then
    # Meson reads it again where a build file has changed.
    mkdir -p "$(dirname "$build")"
    printf "[constants]\nroot = '%s'\n" "$root" >"$build.ini"
    meson setup "$build" "$root" --cross-file "$root/data/packaging/npm/emscripten.ini" --cross-file "$build.ini" \
        --wrap-mode=forcefallback -Dbuildtype=release -Doptimization=2 -Dstatic=true -Ddefault_library=static -Dtests=disabled >&2
fi
ninja -C "$build" src/wasm/core.js src/wasm/program.js >&2

python3 "$root/data/packaging/npm/pack.py" "$root" "$build" "$version" "$work/package"
find "$work/package" -type d -exec chmod 755 {} + -o -exec chmod 644 {} +
chmod 755 "$work/package/bin/ffd-mesh.mjs"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --format=ustar --mtime="@$SOURCE_DATE_EPOCH" -cf "$work/package.tar" package
gzip -9n <"$work/package.tar" >"$work/package.tgz"
mv "$work/package.tgz" "$out/ffd-mesh-$version.tgz"
