# The program as one file, with its pages. Read by release.sh.
set -eu
build=$work/static
CC="${ccache}gcc" CXX="${ccache}g++" meson setup "$build" "$source" --prefix=/ --libdir=lib --buildtype=release -Dstatic=true \
    -Dtests=disabled -Dpython=false --wrap-mode=forcefallback
ninja -C "$build"
DESTDIR=$work/tree meson install -C "$build" --no-rebuild
rm -r "$work/tree/include" "$work/tree/lib"
strip "$work/tree/bin/ffd"
mkdir "$work/packed"
mv "$work/tree" "$work/packed/ffd-$version"
pack "$work/packed" "ffd-$version" "ffd-$version-linux-x86_64.tar.xz"
