# The Python package with all that it needs, for CPython 3.11 and later; by zig, which compiles for older systems, and for Windows by
# mingw-w64. Read by release.sh.
set -eu
# make_wheel PLATFORM OPTION,...: what is installed is told by this name of the system.
make_wheel() {
    cd "$source"
    _PYTHON_HOST_PLATFORM=$1 PATH=$tools/bin:$PATH "$tools/bin/python3" -c "
import sys, mesonpy
mesonpy.build_wheel(sys.argv[1], {'setup-args': [$2]})" "$made"
}

if [ "$name" = wheel-windows ]; then
    printf "[constants]\ncache = [%s]\nsymbols = ['-s']\n" "${ccache:+'ccache'}" >"$work/wheel-windows.ini"
    # In it are libraries of gcc in place of those of LLVM.
    cp -p "$source/pyproject.toml" "$work/pyproject.toml"
    sed -i "s/^license = .*/license = \"$(python3 "$parts/spdx.py" "$root" "$name")\"/" "$source/pyproject.toml"
    make_wheel win_amd64 "'--wrap-mode=forcefallback', '--cross-file=$source/data/packaging/windows.ini', \
        '--cross-file=$work/wheel-windows.ini', '-Dstatic=true', '-Ddefault_library=static'"
    cp -p "$work/pyproject.toml" "$source/pyproject.toml"
    return
fi

cross=
case $name in
wheel)
    target=x86_64-linux-gnu.2.28
    platform=manylinux_2_28_x86_64
    ;;
wheel-arm64)
    target=aarch64-linux-gnu.2.28
    platform=manylinux_2_28_aarch64
    cross=arm64
    ;;
wheel-musl)
    target=x86_64-linux-musl
    platform=musllinux_1_2_x86_64
    ;;
wheel-macos-*)
    target=${name#wheel-macos-}-macos.11.0
    platform=macosx-11.0-$processor
    cross=macos
    export MACOSX_DEPLOYMENT_TARGET=11.0
    ;;
esac
zig=$("$tools/bin/python3" -c 'import os, ziglang; print(os.path.join(os.path.dirname(ziglang.__file__), "zig"))')
sh "$source/data/packaging/zig.sh" "$zig" "$target" "$work/zig/$target"
export CCACHE_COMPILERTYPE=clang CCACHE_COMPILERCHECK="string:$("$zig" version) $target"
export ZIG_GLOBAL_CACHE_DIR="$root/.build-release/zig" ZIG_LOCAL_CACHE_DIR="$root/.build-release/zig"
# Debian's Python.h includes a header of the processor's folder, which zig does not search. Those of the systems of Linux that wheels
# are made for say the same; for macOS it is not read.
mkdir -p "$work/python"
for machine in x86_64 aarch64; do
    ln -sfn /usr/include/x86_64-linux-gnu "$work/python/$machine-linux-gnu"
done
options="'--wrap-mode=forcefallback', '-Dc_link_args=-s', '-Dcpp_link_args=-s'"
[ "$cross" = macos ] || options="$options, '-Dc_args=-I$work/python'"
if [ -n "$cross" ]; then
    cat >"$work/$name.ini" <<EOF
[constants]
cache = [${ccache:+'ccache'}]
zig = '$work/zig/$target'
machine = '${target%%-*}'
[binaries]
c = cache + [zig / 'cc']
cpp = cache + [zig / 'c++']
EOF
    options="$options, '--cross-file=$source/data/packaging/$cross.ini', '--cross-file=$work/$name.ini'"
fi
CC="$ccache$work/zig/$target/cc" CXX="$ccache$work/zig/$target/c++" make_wheel "$platform" "$options"
