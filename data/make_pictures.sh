#!/bin/sh
# Draws the pictures of README.md and tutorial.md with ffd view: sh data/make_pictures.sh FFD [FOLDER]
# They go to FOLDER; default: data/pictures. The lattices that these pages show are taken from their text.
set -eu

ffd=${1:?usage: make_pictures.sh FFD [FOLDER]}
case $ffd in /*) ;; *) ffd=$PWD/$ffd ;; esac
data=$(cd "$(dirname "$0")" && pwd)
out=${2:-$data/pictures}
out=$(cd "$out" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$data/models" "$data/lattices" "$work/"
cd "$work"
awk '/^```json [^\/]*$/{name = $2; next} /^```/{name = ""} name != "" {print > name}' "$data/../README.md" "$data/tutorial.md"

# draw NAME IN [OUT] [OPTION...]: a row of two, before and after
draw() {
    name=$1
    shift
    "$ffd" view "$@" -o "$out/$name.png" --force --quiet
}

deform() {
    "$ffd" deform "$@" --force --quiet
}

knight=models/knight.glb
pair="--frames 2 --color plain"
face="--camera 1,0.4,2"

# The first screen.
draw first $knight -l lattices/twist.json $pair $face --size 340x320
for one in taller fatter lean; do
    deform $knight $one.glb -l lattices/$one.json
    draw $one $knight $one.glb $pair $face --size 200x260
done

# Recipes and tutorial.
"$ffd" lattice new $knight -o cage.json --size 4,6,4 --quiet
draw cage $knight -l cage.json --color plain $face --frames 2 --size 300x320
draw moves $knight -l twist.json $pair $face --size 320x320
draw ears models/spot.obj -l ears.json $pair --camera -1,0.3,-2 --size 300x300
draw cape $knight -l lattices/wind.json --only node:Knight_Cape $pair --camera -2,0.4,-1 --size 320x320
mkdir parts
deform models/vase.obj models/column.obj --out-dir parts -l twist.json --shared-box
draw shared models/column.obj parts/column.obj $pair $face --size 200x320
draw banner models/banner_red.glb -l lattices/wind.json --frames 5 --color plain --camera 1,0.4,1.5 --size 150x240
deform models/column.obj column.stl -l twist.json
draw stl column.stl --color plain $face --size 200x320
mkdir many
deform models/column.obj models/vase.obj --out-dir many -l lattices/bulge.json
draw many models/vase.obj many/vase.obj $pair $face --size 200x260
draw several models/column.obj -l lattices/taper.json -l lattices/twist.json $pair $face --size 240x360
draw blocks models/plank.obj -l left.json -l right.json --blocks $pair --camera 0.6,0.4,2 --size 400x240
draw torn $knight -l head.json $pair $face --size 320x320
draw head $knight -l head.json --outside extend --falloff 0.3 $pair $face --size 320x320
draw row $knight -l twist.json --frames 5 --color plain $face --size 140x200
variant() { # NAME HEIGHT GIRTH DEGREES, as in sweep.csv
    deform $knight "$1.glb" -l sweep.json --set "HEIGHT=$2" --set "GIRTH=$3" --set "DEGREES=$4"
    draw "$1" $knight "$1.glb" $pair $face --size 150x220
}
variant stout 0.8 1.3 0
variant tall 1.3 0.9 0
variant turned 1 1 60
# A walk with a rig that stays and with one that follows: three poses at rest, below them deformed.
for rig in keep follow; do
    draw "rig-$rig" models/character.glb -l lattices/taller.json --rig $rig --animation walk --frames 3 --color plain $face \
        --size 150x200
done
draw corner models/column.obj -l lattices/corner.json --frames 2 --color det --camera front --size 320x320
"$ffd" lattice refine lattices/bend.json -o fine.json --mesh models/column.obj --size 6,14,6 --quiet
draw coarse models/column.obj -l lattices/bend.json $pair --camera 2,0.4,1 --size 160x260
draw fine models/column.obj -l fine.json $pair --camera 2,0.4,1 --size 160x260
"$ffd" lattice set lattices/bend.json -o half.json --mesh models/column.obj --strength 0.5 --quiet
"$ffd" lattice set lattices/bend.json -o other.json --mesh models/column.obj --mirror w --quiet
draw half models/column.obj -l half.json $pair --camera 2,0.4,1 --size 160x260
draw other models/column.obj -l other.json $pair --camera 2,0.4,1 --size 160x260
"$ffd" lattice set lean.json -o joined.json --seam C1:v- --quiet
draw leaning models/column.obj -l lean.json $pair --camera 1,0.4,2 --size 160x260
draw joined models/column.obj -l joined.json $pair --camera 1,0.4,2 --size 160x260
for seed in 2 3 4; do
    deform models/vase.obj vase-$seed.obj -l noise.json --set SEED=$seed
    draw noise-$seed models/vase.obj vase-$seed.obj $pair $face --size 150x200
done
python3 "$data/make_greville.py" "$ffd" "$out/greville.svg"
