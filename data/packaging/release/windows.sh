# The program for Windows as one file, with the notices. Read by release.sh.
set -eu
build=$work/windows
printf '[constants]\ncache = [%s]\n' "${ccache:+'ccache'}" >"$work/cache.ini"
meson setup "$build" "$source" --cross-file "$source/data/packaging/windows.ini" --cross-file "$work/cache.ini" --buildtype=release \
    -Dstatic=true -Ddefault_library=static -Dtests=disabled -Dpython=false --wrap-mode=forcefallback
ninja -C "$build" src/cli/ffd.exe
folder=$work/zip/ffd-$version
mkdir -p "$folder"
x86_64-w64-mingw32-strip -o "$folder/ffd.exe" "$build/src/cli/ffd.exe"
cp -R "$source/LICENSE" "$source/data/packaging/THIRD-PARTY.md" "$source/data/packaging/licenses" "$folder/"
python3 - "$work/zip" "$made/ffd-$version-windows-x86_64.zip" <<'EOF'
import os, sys, time, zipfile
folder, target = sys.argv[1:]
date = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
paths = sorted(os.path.join(base, name) for base, _, names in os.walk(folder) for name in names)
with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
    for path in paths:
        entry = zipfile.ZipInfo(os.path.relpath(path, folder), date)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = 0o644 << 16
        with open(path, "rb") as file:
            archive.writestr(entry, file.read())
EOF
