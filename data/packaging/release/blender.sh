# The extension for Blender, with the wheel of this commit in it: that of this run, or one that is made for it. Read by release.sh.
set -eu
case " $begun " in
*' wheel '*) wheel=$out/ffd_mesh-$version-cp311-abi3-manylinux_2_28_x86_64.whl ;;
*)
    kept=$made
    made=$work/blender
    name=wheel
    mkdir "$made"
    . "$parts/wheel.sh"
    wheel=$made/ffd_mesh-$version-cp311-abi3-manylinux_2_28_x86_64.whl
    made=$kept
    ;;
esac
python3 "$source/data/blender/build_extension.py" --wheel "$wheel" --out "$made"
