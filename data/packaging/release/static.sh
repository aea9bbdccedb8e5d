# The program as one file, with its pages. Read by release.sh.
set -eu
build=$work/$name
case $name in
static)
    processor=x86_64
    strip=strip
    set --
    ;;
static-arm64)
    processor=arm64
    strip=aarch64-linux-gnu-strip
    printf "[constants]\ncache = [%s]\n" "${ccache:+'ccache'}" >"$work/cache.ini"
    set -- --cross-file "$source/data/packaging/arm64.ini" --cross-file "$work/cache.ini"
    ;;
esac
CC="${ccache}gcc" CXX="${ccache}g++" meson setup "$build" "$source" "$@" --prefix=/ --libdir=lib --buildtype=release -Dstatic=true \
    -Dtests=disabled -Dpython=false --wrap-mode=forcefallback
ninja -C "$build"
tree=$work/$name.packed/ffd-$version
DESTDIR=$tree meson install -C "$build" --no-rebuild
rm -r "$tree/include" "$tree/lib"
$strip "$tree/bin/ffd"
pack "$work/$name.packed" "ffd-$version" "ffd-$version-linux-$processor.tar.xz"
