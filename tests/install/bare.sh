#!/bin/sh
# The README's commands on new machines: each in a bare root of Debian of its own (bare_root.sh), which is removed again.
#     sh tests/install/bare.sh [NAME...]     what is named, without a name all; --list prints the names
# A line each; at the end the same lines as a table, and N passed, N failed. Takes root, and some ten minutes for each of the sixteen
# that run the tests. Logs are in .build-test/logs/bare.
set -u

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=$root/.build-test
logs=$work/logs/bare
models=${FFD_MODELS-}
passed=0
failed=0

# The two commands: on a release, as root or as a user with sudo, with sample models or without, where a process may mount and
# make namespaces or not, as in a container (closed).
two_commands() {
    for release in bookworm trixie; do
        for who in root user; do
            for beside in models alone; do
                for rooms in open closed; do
                    echo "$release-$who-$beside-$rooms"
                done
            done
        done
    done
}
others='no-rights elsewhere pip meson deb container'

# make FOLDER-ARGUMENTS...: the root of the present line
make() {
    sh "$here/bare_root.sh" make "$folder" "$@" >>"$log" 2>&1
}

# enter ARGUMENTS... COMMAND: in it; what it prints is in the log and in $log.out
enter() {
    sh "$here/bare_root.sh" run "$folder" "$@" >"$log.out" 2>&1 </dev/null
    code=$?
    cat "$log.out" >>"$log"
    return $code
}

# timed NAME ARGUMENTS... COMMAND: enters, and adds to `found` its exit code, its last line and its seconds
timed() {
    what=$1
    shift
    clock=$(date +%s)
    enter "$@"
    code=$?
    found="$found | $what: exit $code, $(tail -n 1 "$log.out" | cut -c 1-100) ($(($(date +%s) - clock)) s)"
    return $code
}

run_two_commands() {
    # shellcheck disable=SC2046 # words
    set -- $(echo "$1" | tr - ' ')
    release=$1
    user=
    [ "$2" = root ] || user=--user
    closed=
    [ "$4" = open ] || closed=--closed
    # shellcheck disable=SC2046,SC2086 # options, or nothing
    make --release "$release" $user $([ "$3" = alone ] || echo --models "$models") &&
        timed demo $user $closed 'sh data/demo.sh' && timed tests $user $closed 'sh tests/run.sh' &&
        tail -n 1 "$log.out" | grep -q '^[1-9][0-9]* passed, 0 failed' && skips_are_due "$3" "$4"
}

# skips_are_due models|alone open|closed: without models something is skipped, and in a closed room; else nothing is
skips_are_due() {
    kinds=$(sed -n 's|^  skipped: .* / [^:]*: \([^:]*\):.*|\1|p' "$log.out" | sort -u | grep -v 'Debian 12' | tr '\n' ' ')
    found="$found | skipped: ${kinds:-nothing}"
    case $1-$2-$user in
    models-open-) due= ;;
    models-*) due='mounts ' ;;
    alone-open-) due='models ' ;;
    *) due='models mounts ' ;;
    esac
    [ "$kinds" = "$due" ]
}

# One line says what is missing, soon, and nothing is built.
ends_at_once() {
    clock=$(date +%s)
    ! enter "$@" && [ $(($(date +%s) - clock)) -le 5 ] && [ "$(wc -l <"$log.out")" -eq 1 ] && found="$found | $(cat "$log.out")"
}

# Nobody may install anything: a user without sudo, and one whom sudo asks for a password.
run_no_rights() {
    make --user && rm "$folder/etc/sudoers.d/somebody" && ends_at_once --user 'sh data/demo.sh' &&
        rm "$folder/usr/bin/sudo" && ends_at_once --user 'sh data/demo.sh'
}

# A system with neither apt nor dpkg.
run_elsewhere() {
    make && rm "$folder/usr/bin/apt-get" "$folder/usr/bin/dpkg-query" && ends_at_once 'sh data/demo.sh'
}

# The package of Python, with what data/python.md names.
run_pip() {
    make -- python3-dev python3-venv python3-pip && timed pip 'sh .ci/setup && python3 -m venv /env && /env/bin/pip install . &&
        cd / && /env/bin/python -c "import ffd_mesh; print(ffd_mesh.Lattice.around([[0.0, 0, 0], [1, 1, 1]]).size)"'
}

# The block ```sh build of the README, and what it installed.
run_meson() {
    build=$(sed -n '/^```sh build$/,/^```$/p' "$root/README.md" | sed '1d;$d' | tr '\n' ';')
    make && timed meson "set -e; sh .ci/setup; $build ldconfig; cd data; ffd deform models/spot.obj /out.obj -l lattices/twist.json; ffd --version"
}

# The block ```sh package, with what the package itself says that it is built with, and no more.
run_deb() {
    package=$(sed -n '/^```sh package$/,/^```$/p' "$root/README.md" | sed '1d;$d' | tr '\n' ';')
    make -- dpkg-dev && timed deb "set -e; apt-get -qq update; $(echo "$package" | sed 's/dpkg-buildpackage/apt-get -qq build-dep .\/; &/') ls ../*.deb"
}

# The commands of the Containerfile, and what they made in a root that is empty.
run_container() {
    commands=$(sed -n 's/^RUN //p' "$root/data/packaging/Containerfile" | tr '\n' ';')
    make && timed container "set -e; $commands mkdir /empty; cp /build/src/cli/ffd data/models/spot.obj data/lattices/twist.json /empty;
        env -i /usr/sbin/chroot /empty /ffd deform spot.obj out.obj -l twist.json; ls /empty/out.obj"
}

[ "${1-}" != --list ] || { two_commands && echo "$others" | tr ' ' '\n' && exit 0; }
[ "$(id -u)" -eq 0 ] || { echo "bare: root is needed to make the roots" >&2 && exit 1; }
sh "$root/.ci/setup" root || exit 1
rm -rf "$logs"
mkdir -p "$logs" || exit 1
folder=$work/bare
trap 'rm -rf --one-file-system "$folder"' EXIT
trap 'exit 1' HUP INT TERM

# shellcheck disable=SC2046 # words
[ $# -gt 0 ] || set -- $(two_commands) $others
case "$*" in
*-models-*) [ -d "$models" ] || { echo "bare: FFD_MODELS names no folder of sample models: '$models'" >&2 && exit 1; } ;;
esac
for name; do
    rm -rf --one-file-system "$folder"
    log=$logs/$name.log
    found=
    case " $others " in
    *" $name "*) command=run_$(echo "$name" | tr - _) ;;
    *) two_commands | grep -qx "$name" || { echo "bare: unknown name '$name' (--list)" >&2 && exit 2; }
        command=run_two_commands ;;
    esac
    clock=$(date +%s)
    if $command "$name"; then
        passed=$((passed + 1))
        verdict=ok
    else
        failed=$((failed + 1))
        verdict="FAILED, see $log"
    fi
    echo "$name | $verdict$found" | tee -a "$logs/table"
done
echo
cat "$logs/table"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
