#!/bin/sh
# Fuzzes lattice files, manifests, reports, clips, a reader of meshes or of images with clang's libFuzzer under the address and undefined-behaviour
# sanitizers.
#     sh tests/fuzz/run.sh [-t TARGET] [-n RUNS] SECONDS [FOLDER]
# TARGET: lattice (default), table, weights, pairs, manifest, report, clip, obj, gltf, glb, ply, off, stl, vtk, su2, vtu, vtp, vts, msh, foam, png, jpeg, webp. With -n it ends after so many runs, the same ones every
# time as far as the machine allows, or after the seconds. Builds in FOLDER (default .build-test/fuzz). What is found new
# goes to FOLDER/TARGET/corpus, which the next run goes on with; inputs that end in a finding go to
# FOLDER/TARGET/findings. Meshes start from the small ones of the folder FFD_MODELS too, where that is set. Ends
# with 0 when there was no finding.
set -eu

usage() {
    echo "usage: sh tests/fuzz/run.sh [-t lattice|table|weights|pairs|manifest|report|clip|obj|gltf|glb|ply|off|stl|vtk|su2|vtu|vtp|vts|msh|foam|png|jpeg|webp] [-n RUNS] SECONDS [FOLDER]" >&2
    exit 2
}

target=lattice
if [ "${1-}" = -t ]; then
    [ $# -ge 2 ] || usage
    target=$2
    shift 2
fi
same=
if [ "${1-}" = -n ]; then
    [ $# -ge 2 ] || usage
    same="-runs=$2 -seed=1"
    shift 2
fi
[ $# -ge 1 ] && [ $# -le 2 ] || usage
seconds=$1
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=${2-$root/.build-test/fuzz}

case $target in
lattice | table | weights | pairs | manifest | report | clip | png | jpeg | webp) length=8192 dictionary=$target.dict ;;
gltf | glb) length=16384 dictionary=gltf.dict ;;
obj | ply | off | stl | vtk | su2 | msh | foam) length=8192 dictionary=$target.dict ;;
vtu | vtp | vts) length=8192 dictionary=vtkxml.dict ;;
*) usage ;;
esac

if [ ! -f "$work/build.ninja" ]; then
    # Watching every comparison of numbers would take most of the time.
    coverage='-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp'
    CC=clang CXX=clang++ meson setup -Dtests=enabled -Dfuzzers=true -Dbuildtype=debug -Doptimization=2 \
        -Db_sanitize=address,undefined -Db_lundef=false -Dc_args="$coverage" -Dcpp_args="$coverage" \
        "$work" "$root"
fi
ninja -C "$work" "tests/fuzz/fuzz_$target"

mkdir -p "$work/$target/corpus" "$work/$target/findings"
seeds=
case $target in
obj | gltf | glb | ply | off | stl | vtk | su2 | vtu | vtp | vts | msh | foam) has_models=${FFD_MODELS-} ;;
*) has_models= ;;
esac
if [ -n "$has_models" ]; then
    # A folder of its own: several targets may run at a time.
    python3 "$here/make_corpus.py" "$work/$target/seeds" "$FFD_MODELS"
    [ ! -d "$work/$target/seeds/$target" ] || seeds=$work/$target/seeds/$target
fi
# Outputs are written for every input: in memory, where there is such a folder.
if [ -z "${TMPDIR-}" ] && [ -w /dev/shm ]; then
    export TMPDIR=/dev/shm
fi
export ASAN_OPTIONS="halt_on_error=1:detect_leaks=1:allocator_may_return_null=1"
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1"
# shellcheck disable=SC2086 # two options or nothing
exec "$work/tests/fuzz/fuzz_$target" $same -max_total_time="$seconds" -max_len="$length" -timeout=20 -rss_limit_mb=2048 \
    -dict="$here/$dictionary" -artifact_prefix="$work/$target/findings/" -print_final_stats=1 \
    "$work/$target/corpus" "$here/corpus/$target" ${seeds:+"$seeds"}
