#!/bin/sh
# Renders data/before-after.png anew from the program's real output: sh data/make_picture.sh FFD
# Needs f3d, xvfb and imagemagick (Debian packages).
set -eu
ffd=${1:?usage: make_picture.sh FFD}
data=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { # MESH PICTURE
    xvfb-run -a f3d "$1" --output "$2" --resolution 400,400 --up=+Y --camera-azimuth-angle=30 \
        --camera-elevation-angle=12 --bg-color=1,1,1 --color=0.55,0.65,0.8 -q
}

for pair in character.glb:twist spot.obj:bulge column.obj:bend-cylinder banner_red.glb:bend; do
    mesh=${pair%%:*}
    "$ffd" deform "$data/models/$mesh" "$work/$mesh" -l "$data/lattices/${pair##*:}.json" --quiet
    render "$data/models/$mesh" "$work/before-$mesh.png"
    render "$work/$mesh" "$work/after-$mesh.png"
done
cd "$work"
convert \( before-character.glb.png before-spot.obj.png before-column.obj.png before-banner_red.glb.png +append \) \
    \( after-character.glb.png after-spot.obj.png after-column.obj.png after-banner_red.glb.png +append \) \
    -append -resize 1200x -colors 128 "PNG8:$data/before-after.png"
