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

. "$root/.ci/progress.sh"
sh "$root/.ci/setup" || exit 1

mkdir -p "$build" "$out" || fail "cannot make the folder $out"

# quietly WHAT COMMAND...: how far it is, and its output only where it fails
quietly() {
    progress "$build/demo.log" "$@" || { tail -n 40 "$build/demo.log" >&2 && fail "$1 failed"; }
}

if [ ! -f "$build/release/build.ninja" ]; then
    echo "Configuring the build in $build/release"
    quietly "meson setup" meson setup -Dbuildtype=release -Dtests=disabled "$build/release" "$root"
fi
echo "Building ffd (the first time, a few minutes)"
quietly building ninja -C "$build/release"
ffd=$build/release/src/cli/ffd
[ -x "$ffd" ] || fail "the build made no program at $ffd"

written=0
camera=1,0.4,2

# deform MESH OUT-NAME WHAT-TO-LOOK-AT LATTICE...: the mesh, and a picture of it before and after
deform() {
    mesh=$root/data/models/$1
    target=$out/$2
    look=$3
    shift 3
    names=
    for lattice; do
        names="$names${names:+, }$lattice"
        set -- "$@" -l "$root/data/lattices/$lattice"
        shift
    done
    "$ffd" deform "$mesh" "$target" "$@" --force --quiet || fail "ffd could not deform $mesh with $names"
    "$ffd" view "$mesh" "$@" -o "${target%.*}.png" --size 1000x500 --color plain --camera "$camera" --force --quiet ||
        fail "ffd could not draw $mesh with $names"
    before=$(wc -c <"$mesh")
    after=$(wc -c <"$target")
    printf '\n%s  (%d bytes; %s, %d bytes, through %s)\n    %s\n' \
        "$target" "$after" "data/models/$(basename "$mesh")" "$before" "$names" "$look"
    written=$((written + 1))
}

echo "Deforming"
deform knight.glb knight-twisted.glb \
    'The knight looks over his shoulder. Eight meshes, some on a skeleton, one lattice.' \
    twist.json
camera=-1,0.4,-2 # the cow looks the other way
deform spot.obj spot-fatter.obj \
    'The cow has eaten well. The file grew: it had one normal a face, and bent faces need one a corner.' \
    fatter.json
camera=1,0.4,2
deform banner_red.glb banner-lifted.glb \
    'The wind lifts the banner, its texture with it; its top stays where it hangs.' \
    wind.json
deform column.obj column-corner.obj \
    'The shaft is a quarter of a true circle; the flutes stay even and run round the corner.' \
    corner.json
deform column.obj column-spire.obj \
    'Two lattices one after the other: narrowed to the top, then twisted.' \
    taper.json twist.json
deform plank.obj plank-waved.obj \
    'The checkered plank waves; its squares show how the space between the control points is carried along.' \
    wave.json

page=$out/knight-twisted.html
"$ffd" view "$root/data/models/knight.glb" -l "$root/data/lattices/twist.json" -o "$page" --force --quiet ||
    fail "ffd could not make the page $page"

printf '\nWrote %d meshes to %s, beside each its picture, before and after. Look at:\n' "$written" "$out"
printf '    %s    a picture\n    %s   a page for any browser, with a slider from before to after\n' \
    "$out/knight-twisted.png" "$page"
printf 'The program is %s. README.md goes on with a model of your own.\n' "$ffd"
