#!/bin/sh
# Makes what is delivered, from what is committed; nothing is fetched, and nothing is uploaded.
#     sh data/packaging/release.sh OUT [NAME...]     without a name all but macos
# `sh .ci/setup release` gets the tools and the sources of the libraries before. The same commit gives the same bytes, in
# whatever folder. In OUT each artefact has its SBOM beside it (FILE.spdx.json), and SHA256SUMS lists them.
set -eu

names='wheel wheel-arm64 wheel-musl wheel-windows static static-arm64 windows npm blender source deb'
known="$names macos"

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
parts=$here/release
tools=$root/.build-release/venv

fail() {
    echo "release: $1" >&2
    exit 1
}

is_one_of() {
    case " $2 " in
    *" $1 "*) return 0 ;;
    esac
    return 1
}

# The tools of an artefact, beside git, python3 and xz; @ before what is in the venv.
tools_of() {
    case $1 in
    wheel | wheel-musl | blender) echo 'ninja @mesonpy @pycparser @ziglang' ;;
    wheel-arm64) echo 'ninja qemu-aarch64 aarch64-linux-gnu-gcc @mesonpy @pycparser @ziglang' ;;
    wheel-windows)
        echo 'ninja x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix x86_64-w64-mingw32-dlltool @mesonpy @pycparser'
        ;;
    static) echo 'meson ninja pkg-config gcc g++ strip' ;;
    static-arm64) echo 'meson ninja qemu-aarch64 aarch64-linux-gnu-g++ aarch64-linux-gnu-strip' ;;
    macos) echo 'meson ninja @mesonpy @pycparser @ziglang' ;;
    windows) echo 'meson ninja x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix x86_64-w64-mingw32-strip' ;;
    npm) echo 'meson ninja emcc node' ;;
    source) ;;
    deb) echo 'dpkg-buildpackage dh meson ninja' ;;
    esac
}

has_tool() {
    case $1 in
    @*) "$tools/bin/python3" -c "import importlib.util, sys; sys.exit(not importlib.util.find_spec('${1#@}'))" 2>/dev/null ;;
    *) command -v "$1" >/dev/null 2>&1 ;;
    esac
}

# value WRAP KEY: in the wrap file
value() {
    sed -n "s/^$2 = //p" "$1"
}

# Prints what is missing for the artefacts, a word each.
missing() {
    for tool in git python3 xz sha256sum $(for name; do tools_of "$name"; done); do
        has_tool "$tool" || echo "${tool#@}"
    done
    [ "$*" != deb ] || return 0
    for wrap in "$root"/subprojects/*.wrap; do
        folder=subprojects/$(value "$wrap" directory)
        [ -f "$root/$folder/meson.build" ] || echo "$folder"
    done
}

# export_source FOLDER: the committed files
export_source() {
    mkdir "$1"
    git -C "$root" archive HEAD | tar -x -C "$1"
    git -C "$root" rev-parse --short=12 HEAD >"$1/COMMIT"
}
# add_libraries FOLDER: the sources of the libraries, which Debian's packages take from the system
add_libraries() {
    for wrap in "$root"/subprojects/*.wrap; do
        folder=$(value "$wrap" directory)
        cp -R "$root/subprojects/$folder" "$1/subprojects/"
        cp -R "$1/subprojects/packagefiles/$(value "$wrap" patch_directory)/." "$1/subprojects/$folder/"
    done
}

# pack WHERE FOLDER FILE: the folder WHERE/FOLDER as an archive
pack() {
    tar -C "$1" --format=gnu --sort=name --owner=0 --group=0 --numeric-owner --mode=u+rwX,go+rX,go-w \
        --mtime="@$SOURCE_DATE_EPOCH" -cf - "$2" | xz -9 -T1 >"$made/$3"
}

[ $# -ge 1 ] && [ -n "$1" ] || { echo "usage: sh data/packaging/release.sh OUT [NAME...], NAME one of: $known" >&2 && exit 2; }
out=$1
shift
for name; do
    is_one_of "$name" "$known" || { echo "release: unknown name '$name' (known: $known)" >&2 && exit 2; }
done
# shellcheck disable=SC2086 # words
[ $# -gt 0 ] || set -- $names
commit=$(git -C "$root" rev-parse HEAD 2>/dev/null) || fail "not a clone of the repository: what is made is made from a commit"
git -C "$root" diff --quiet HEAD -- || fail "the clone has changes that are not committed: $(git -C "$root" diff --name-only HEAD -- | head -n 1)"
lacking=$(missing "$@" | sort -u | tr '\n' ' ')
[ -z "$lacking" ] || fail "sh .ci/setup release comes first; missing: $lacking"
mkdir -p "$out" || exit 1
out=$(cd "$out" && pwd)

umask 022
unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS DESTDIR PYTHONPATH MAKEFLAGS
export LC_ALL=C.UTF-8 TZ=UTC PYTHONDONTWRITEBYTECODE=1 PYTHONHASHSEED=0
SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct "$commit")
export SOURCE_DATE_EPOCH
work=$(mktemp -d "${TMPDIR:-/tmp}/ffd-release.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
made=$work/made
version=$(sed -n 's/^#define FFD_VERSION "\(.*\)"$/\1/p' "$root/include/ffd/version.h")
source=$work/ffd-$version
mkdir "$made"
export_source "$source"
# What one run has compiled the next one takes, in whatever folder.
ccache=
if command -v ccache >/dev/null 2>&1; then
    ccache='ccache '
    export CCACHE_BASEDIR="$work" CCACHE_NOHASHDIR=1 CCACHE_DIR="${CCACHE_DIR-$root/.build-release/ccache}"
fi

# Debian's package is built before the libraries are added.
begun=
for name in deb $known; do
    is_one_of "$name" "$*" && ! is_one_of "$name" "$begun" || continue
    begun="$begun $name"
    [ "$name" = deb ] || [ -n "${added-}" ] || { add_libraries "$source" && added=1; }
    clock=$(date +%s)
    log=$work/$name.log
    if ! (. "$parts/${name%-*}.sh") >"$log" 2>&1 </dev/null; then
        tail -n 40 "$log" >&2
        fail "$name: failed"
    fi
    for file in "$made"/*; do
        case $file in
        *.spdx.json) continue ;;
        esac
        python3 "$parts/spdx.py" "$root" "$name" "$file" "$commit" >"$file.spdx.json"
        echo "${file##*/} $(wc -c <"$file") bytes ($(($(date +%s) - clock)) s)"
    done
    mv "$made"/* "$out/"
done

# Of all that OUT holds, also from earlier runs.
cd "$out"
rm -f SHA256SUMS
for file in *.spdx.json; do
    sha256sum "${file%.spdx.json}"
done >"$work/sums"
cp "$work/sums" SHA256SUMS
