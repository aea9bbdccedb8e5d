# The program for macOS as one file, with the notices, and the Python package, each for both processors; compiled, never run. Read by
# release.sh.
set -eu
for processor in arm64 x86_64; do
    machine=$(echo $processor | sed 's/arm64/aarch64/')
    name=wheel-macos-$machine
    . "$parts/wheel.sh"
    # Where the wheel's was: ccache has what that one has compiled.
    build=$source/.build-$processor
    meson setup "$build" "$source" --cross-file "$source/data/packaging/macos.ini" --cross-file "$work/$name.ini" --buildtype=release \
        -Dstatic=true -Ddefault_library=static -Dtests=disabled -Dpython=false --wrap-mode=forcefallback -Dc_link_args=-s -Dcpp_link_args=-s
    ninja -C "$build" src/cli/ffd
    folder=$work/packed-$processor/ffd-$version
    mkdir -p "$folder/bin"
    cp "$build/src/cli/ffd" "$folder/bin/"
    cp -R "$source/LICENSE" "$source/data/packaging/NOT-RUN" "$source/data/packaging/THIRD-PARTY.md" "$source/data/packaging/licenses" "$folder/"
    pack "$work/packed-$processor" "ffd-$version" "ffd-$version-macos-$processor.tar.xz"
done
