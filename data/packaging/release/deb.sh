# Debian's packages. Read by release.sh.
set -eu
mkdir "$work/deb"
cp -R "$source" "$work/deb/ffd-$version"
cd "$work/deb/ffd-$version"
cp -R data/packaging/debian debian
DEB_BUILD_OPTIONS="noautodbgsym nocheck" CC="${ccache}gcc" CXX="${ccache}g++" dpkg-buildpackage --build=binary --no-sign
mv ../*.deb "$made/"
