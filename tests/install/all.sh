#!/bin/sh
# What a change must pass, as a new machine sees it: in a bare root of Debian 12 (bare_root.sh) with a clone of the last commit, the
# README's two commands as they stand there, and after them the other stages of tests/run.sh. This is tests/run.sh --all.
#     sh tests/install/all.sh [--keep]     --keep: the root stays, in .build-test/bare
# Each command's own output, then a line on it; the last line: N passed, N failed[, N skipped].
set -u

root=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
work=$root/.build-test
folder=$work/bare
logs=$work/logs
started=$(date +%s)
passed=0
failed=0
skipped=0

sudo=
if [ "$(id -u)" -ne 0 ]; then
    sudo -n true 2>/dev/null || { echo "all: to make a bare root takes root, or sudo that asks for no password" >&2 && exit 1; }
    sudo='sudo -E'
fi
sh "$root/.ci/setup" root || exit 1
mkdir -p "$logs" || exit 1
changed=$(git -C "$root" status --porcelain | wc -l)
[ "$changed" -eq 0 ] || echo "all: $changed files are not committed, and are not tested"
models=${FFD_MODELS-}

remove() {
    $sudo rm -rf --one-file-system "$folder"
}
[ "${1-}" = --keep ] || trap remove EXIT
trap 'exit 1' HUP INT TERM

# say TEXT...: with the time since `clock`
say() {
    printf '%-10s %s (%d s)\n' bare "$*" "$(($(date +%s) - clock))"
}

# enter COMMAND: runs it in the root, with its output here and in the file $log; sets `status`
enter() {
    clock=$(date +%s)
    {
        $sudo sh "$root/tests/install/bare_root.sh" run "$folder" "$1" 2>&1 </dev/null
        echo $? >"$log.status"
    } | tee "$log"
    status=$(cat "$log.status")
}

# count: adds up the last line of a run of tests
count() {
    counts=$(sed -n '$s/^\([0-9]*\) passed, \([0-9]*\) failed\(, \([0-9]*\) skipped\)*$/\1 \2 0\4/p' "$log")
    # shellcheck disable=SC2086 # three numbers
    set -- $counts
    if [ $# -ne 3 ] || { [ "$status" -ne 0 ] && [ "$2" -eq 0 ]; }; then
        set -- 0 1 0
    fi
    passed=$((passed + $1))
    failed=$((failed + $2))
    skipped=$((skipped + $3))
}

remove
clock=$started
# shellcheck disable=SC2086 # sudo or nothing; an option or nothing
$sudo sh "$root/tests/install/bare_root.sh" make "$folder" ${models:+--models "$models"} || exit 1
say "a root of Debian 12 with $(chroot "$folder" dpkg-query -W | wc -l) packages, and a clone"

log=$logs/bare-demo.log
enter 'sh data/demo.sh'
if [ "$status" -eq 0 ]; then
    passed=$((passed + 1))
else
    failed=$((failed + 1))
fi
say "sh data/demo.sh: exit $status"

log=$logs/bare-run.log
enter 'sh tests/run.sh'
count
say "sh tests/run.sh: $(tail -n 1 "$log")"

log=$logs/bare-stages.log
enter 'sh tests/run.sh --stages'
count
say "sh tests/run.sh --stages: $(tail -n 1 "$log")"
cp -R "$folder/src/ffd/.build-test/logs/." "$logs/" 2>/dev/null

printf 'logs in %s; %d s\n' "$logs" "$(($(date +%s) - started))"
line="$passed passed, $failed failed"
[ "$skipped" -eq 0 ] || line="$line, $skipped skipped"
echo "$line"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
