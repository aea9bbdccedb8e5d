#!/bin/sh
# Makes compilers for another system by zig: `cc`, `c++`, `ar` and `ranlib` in a folder.
#     sh data/packaging/zig.sh ZIG TARGET FOLDER
# They take what Meson gives linkers and zig refuses. It asks by --fatal-warnings which arguments the linker knows, and finds that of
# macOS by what Apple's answers; there a bundle is a library for loaders only, and -force_load stands apart from its file.
set -eu
zig=$1
target=$2
folder=$3
mkdir -p "$folder"

cases='    -Wl,--fatal-warnings) continue ;;'
case $target in
*-macos*)
    cases="$cases
    -Wl,--version) echo 'ld: unknown option: --version' >&2 && exit 1 ;;
    -Wl,-v) echo '@(#)PROGRAM:ld PROJECT:ld64-0' >&2 && exit ;;
    -bundle) argument=-dynamiclib ;;
    -Wl,-force_load) prefix=-Wl,-force_load, && continue ;;"
    ;;
esac
for language in cc c++; do
    cat >"$folder/$language" <<EOF
#!/bin/sh
prefix=
for argument; do
    shift
    case \$argument in
$cases
    esac
    set -- "\$@" "\$prefix\$argument"
    prefix=
done
exec '$zig' $language -target $target "\$@"
EOF
done
for tool in ar ranlib; do
    printf "#!/bin/sh\nexec '%s' %s \"\$@\"\n" "$zig" "$tool" >"$folder/$tool"
done
chmod +x "$folder/cc" "$folder/c++" "$folder/ar" "$folder/ranlib"
