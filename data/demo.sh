#!/bin/sh
# Builds ffd in a build folder of its own and deforms real meshes with the lattices of data/lattices.
#     sh data/demo.sh [FOLDER]      where the deformed meshes go; default: build-demo/out
# Can be run again: what it wrote before is replaced.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-demo
out=${1:-$build/out}

fail() {
    echo "demo: $1" >&2
    exit 1
}

# quietly WHAT COMMAND...: its output only where it fails
quietly() {
    what=$1
    shift
    if ! "$@" >"$build/demo.log" 2>&1; then
        tail -n 40 "$build/demo.log" >&2
        fail "$what failed"
    fi
}

sh "$root/.ci/setup" || fail "the packages that the build needs could not be installed"

mkdir -p "$build" "$out" || fail "cannot make the folder $out"
if [ ! -f "$build/release/build.ninja" ]; then
    echo "Configuring the build in $build/release"
    quietly "meson setup" meson setup -Dbuildtype=release -Dtests=disabled "$build/release" "$root"
fi
echo "Building ffd"
quietly "the build" ninja -C "$build/release"
ffd=$build/release/src/cli/ffd
[ -x "$ffd" ] || fail "the build made no program at $ffd"

written=0

# deform MESH OUT-NAME WHAT-TO-LOOK-AT LATTICE...
deform() {
    mesh=$root/data/models/$1
    target=$out/$2
    look=$3
    shift 3
    names=
    options=
    for lattice; do
        names="$names${names:+, }$lattice"
        set -- "$@" -l "$root/data/lattices/$lattice"
        shift
    done
    "$ffd" deform "$mesh" "$target" "$@" --force --quiet || fail "ffd could not deform $mesh with $names"
    before=$(wc -c <"$mesh")
    after=$(wc -c <"$target")
    printf '\n%s  (%d bytes; %s, %d bytes, through %s)\n    %s\n' \
        "$target" "$after" "data/models/$(basename "$mesh")" "$before" "$names" "$look"
    written=$((written + 1))
}

echo "Deforming"
# ffd takes a glTF file's images along; an OBJ file's materials it never opens.
cp "$root/data/models/plank.mtl" "$out/"

deform character.glb character-twisted.glb \
    'The robot is wrung out: its face runs slantwise round the body. Six meshes under their own nodes, one lattice.' \
    twist.json
deform spot.obj spot-twisted.obj \
    'The cow looks over its shoulder. The file grew: it had one normal a face, and bent faces need one a corner.' \
    twist.json
deform banner_red.glb banner-bent.glb \
    'The banner bows forward along an arc, its texture with it.' \
    bend.json
deform column.obj column-bent.obj \
    'The shaft is laid along an arc of 120 degrees by a cylinder lattice; the flutes stay even and run round the bend.' \
    bend-cylinder.json
deform vase.obj vase-bowed.obj \
    'Two lattices one after the other: narrowed to the top, then bowed.' \
    taper.json bend.json
deform plank.obj plank-waved.obj \
    'The checkered plank waves; its squares show how the space between the control points is carried along.' \
    wave.json

printf '\nWrote %d meshes to %s. Any viewer shows them beside data/models, for example: f3d --up=+Y FILE\n' \
    "$written" "$out"
