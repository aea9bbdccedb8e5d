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
ln -s "$data/models" "$data/lattices" "$data/blender" "$work/"
cd "$work"
awk '/^```(json|csv|prm) [^\/]*$/{name = $2; next} /^```/{name = ""} name != "" {print > name}' "$data/../README.md" "$data/tutorial.md"

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
awk '$1 == "v" {m = (1 + cos(6 * atan2($4, $2) + 9 * $3)) / 2; print $0, m, m, m; next} {print}' models/vase.obj >painted.obj
deform painted.obj ridges.obj -l wide.json --weight color:r
draw ridges painted.obj ridges.obj $pair $face --size 200x260
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
"$ffd" lattice convert spout.prm -o spout.json --quiet
deform models/vase.obj spout.obj -l spout.json
draw spout models/vase.obj spout.obj $pair --camera 0.4,0.5,2 --size 200x260
draw spout-cage models/vase.obj -l spout.json --color plain $face --frames 2 --size 200x260
deform models/vase.obj from-blender.obj -l blender/vase-Lattice.json --outside extend
draw from-blender models/vase.obj from-blender.obj $pair --camera 0.4,0.5,2 --size 200x260
python3 "$data/make_refitter.py"
"$ffd" lattice convert refit/stout.npz -o stout-blender.json --quiet
"$ffd" lattice set stout-blender.json -o stout.json --rotate x,-90 --quiet
deform refit/body.glb stout-body.glb -l stout.json --outside extend
deform refit/clothes/tunic.glb stout-tunic.glb -l stout.json --outside extend
draw body refit/body.glb stout-body.glb $pair --camera 1,0.2,2 --size 200x260
draw tunic refit/clothes/tunic.glb stout-tunic.glb $pair --camera 1,0.2,2 --size 200x260
draw leaning models/column.obj -l lean.json $pair --camera 1,0.4,2 --size 160x260
draw joined models/column.obj -l lean.json --seam C1 $pair --camera 1,0.4,2 --size 160x260
"$ffd" animate models/banner_red.glb bow.glb -l bow.json --force --quiet
draw bow bow.glb --animation bow --frames 5 --color plain --camera 1,0.4,1.5 --size 150x240
for seed in 2 3 4; do
    deform models/vase.obj vase-$seed.obj -l noise.json --set SEED=$seed
    draw noise-$seed models/vase.obj vase-$seed.obj $pair $face --size 150x200
done
deform models/cart.glb wobbling.glb -l drive.json --rig follow
deform models/cart.glb rolling.glb -l drive.json --rig follow --rigid node:front --rigid node:back --rigid node:sword
for one in wobbling rolling; do
    draw $one $one.glb --color plain --animation roll --frames 4 --camera 0.2,0.15,1 --size 220x170
done

# A lattice that was shaped by hand.
draw snout models/spot.obj -l lattices/snout.json $pair --camera -1,0.3,-1.2 --size 360x340

# Fits: what ffd fit finds carries clothes, coarser meshes, the rest of a mesh and a scan.
dress() { # OUT BODY TUNIC HAT, of OBJ: one mesh, each part in a colour
    awk 'FNR == 1 {base = count; split("0.8 0.6 0.5,0.2 0.4 0.6,0.5 0.1 0.1", colours, ","); ++part}
        $1 == "v" {++count; print $0, colours[part]}
        $1 == "vn"
        $1 == "f" {line = "f"; for (k = 2; k <= NF; ++k) line = line " " $k + base "//" $k + base; print line}' "$2" "$3" "$4" >"$1"
}
"$ffd" lattice set lattices/lean.json -o stoop.json --mesh refit/body.glb --strength 0.35 --quiet
deform refit/body.glb other-body.glb -l stoop.json -l lattices/bulge.json
"$ffd" fit refit/body.glb other-body.glb --cover refit/clothes/tunic.glb --cover refit/clothes/hat.glb --size 12,12,12 -o ab.json --quiet
for one in body clothes/tunic clothes/hat; do
    deform refit/$one.glb "$(basename $one).obj" -l cage.json
    deform refit/$one.glb "$(basename $one)-b.obj" -l ab.json
done
deform other-body.glb body-b.obj -l cage.json
dress dressed.obj body.obj tunic.obj hat.obj
dress dressed-b.obj body-b.obj tunic-b.obj hat-b.obj
draw other-body refit/body.glb other-body.glb $pair --camera 1,0.2,2 --size 200x260
draw dressed dressed.obj dressed-b.obj $pair --camera 1,0.2,2 --size 200x260
deform models/spot.obj posed.obj -l ears.json -l lattices/lean.json
"$ffd" fit models/spot.obj posed.obj --size 10,10,10 -o by-hand.json --quiet
draw posed models/spot.obj posed.obj $pair --camera -1,0.3,-2 --size 150x200
for level in 1:0.06 2:0.12; do
    python3 "$data/make_coarser.py" models/spot.obj "${level#*:}" >cow.obj
    deform cow.obj posed-cow.obj -l by-hand.json
    draw "lod-${level%:*}" cow.obj posed-cow.obj $pair --camera -1,0.3,-2 --size 150x200
done
for one in "pulled 0" "swayed 100"; do
    name=${one% *}
    "$ffd" fit $knight --pairs pull.csv --handles --knots clamped --smooth "${one#* }" -o "$name.json" --quiet
    deform $knight "$name.glb" -l "$name.json"
    draw "$name" $knight "$name.glb" $pair $face --size 200x260
done
deform models/spot.obj scan.obj -l scan.json
"$ffd" fit --pairs landmarks.csv --cover scan.obj --size 4,4,4 -o align.json --quiet
deform scan.obj aligned.obj -l align.json
draw scan scan.obj aligned.obj $pair --camera -1,0.3,-2 --size 260x220
python3 "$data/make_duct.py" >duct.su2
for one in bump fair-bump; do
    draw $one duct.su2 -l $one.json --seam C1 --color det --no-cage --frames 2 --up z --camera 0.1,-1,0.12 --size 320x130
done
python3 "$data/make_wing.py" >wing.obj
for one in wing-folds wing; do
    deform wing.obj moved-$one.obj -l lattices/$one.json
    draw $one wing.obj moved-$one.obj $pair --camera 0.35,0.25,-1.2 --size 300x220
done
for one in "0 1.063 1.364 54.8" "1 1.258 0.94 -44.3" "2 0.825 0.843 -32.9"; do
    set -- $one
    deform models/keg_decorated.obj keg.obj -l sweep.json --set HEIGHT="$2" --set GIRTH="$3" --set DEGREES="$4"
    draw "training-$1" models/keg_decorated.obj keg.obj $pair $face --size 150x180
done
draw scan-model models/spot.obj --color plain --camera -1,0.3,-2 --size 140x220
python3 "$data/make_greville.py" "$ffd" "$out/greville.svg"
