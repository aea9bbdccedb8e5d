#!/bin/sh
# Builds ffd and runs its tests, in build folders of its own under .build-test/.
#     sh tests/run.sh                 the gcc build, every quick suite
#     sh tests/run.sh --suite NAME    the gcc build, one suite (unit property oracle fuzz golden cli rules bench slow)
#     sh tests/run.sh --all           and: slow suites, clang, release, sanitizers, valgrind, the demo, the wraps
#     --keep                          keeps the build folders of the stages that only --all has
# FFD_MODELS names a folder of sample models (default: shared/models beside the checkout); without it the tests
# that need it are skipped. One line a stage, then what failed; the last line: N passed, N failed[, N skipped].
set -u

usage() {
    echo "usage: sh tests/run.sh [--all | --suite NAME] [--keep]" >&2
    exit 2
}

all=
suite=
keep=
while [ $# -gt 0 ]; do
    case "$1" in
    --all) all=1 ;;
    --keep) keep=1 ;;
    --suite)
        [ $# -ge 2 ] || usage
        suite=$2
        shift
        ;;
    *) usage ;;
    esac
    shift
done
[ -z "$all" ] || [ -z "$suite" ] || usage

root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
work=$root/.build-test
logs=$work/logs
mkdir -p "$logs" || exit 1
sh "$root/.ci/setup" test || exit 1

if [ -z "${FFD_MODELS-}" ] && [ -d "$root/../shared/models" ]; then
    FFD_MODELS=$(cd "$root/../shared/models" && pwd)
fi
may_skip=
if [ -n "${FFD_MODELS-}" ]; then
    export FFD_MODELS
else
    unset FFD_MODELS
    may_skip=--may-skip
    echo "FFD_MODELS is not set: tests on the sample models are skipped"
fi

# A sanitizer's finding ends the program at once, with an exit code that no test expects.
export ASAN_OPTIONS="halt_on_error=1:exitcode=99:detect_leaks=1:allocator_may_return_null=1"
export UBSAN_OPTIONS="halt_on_error=1:exitcode=99:print_stacktrace=1"
export TSAN_OPTIONS="halt_on_error=1:exitcode=99"
export PYTHONDONTWRITEBYTECODE=1

passed=0
failed=0
skipped=0
started=$(date +%s)

# say STAGE TEXT...
say() {
    stage=$1
    shift
    printf '%-10s %s (%d s)\n' "$stage" "$*" "$(($(date +%s) - clock))"
}

# step STAGE WHAT COMMAND...: counts nothing where it succeeds; else its last lines, one failure, status 1
step() {
    stage=$1
    what=$2
    shift 2
    clock=$(date +%s)
    if "$@" >"$logs/$stage-$what.log" 2>&1 </dev/null; then
        return 0
    fi
    failed=$((failed + 1))
    say "$stage" "$what FAILED, see $logs/$stage-$what.log"
    # What a compiler says matters more than what ninja says of it.
    pattern='(: (fatal )?error:|undefined reference|ERROR:)'
    if grep -qE "$pattern" "$logs/$stage-$what.log"; then
        grep -hE -A 3 "$pattern" "$logs/$stage-$what.log" | head -n 40 | sed 's/^/    /'
    else
        tail -n 40 "$logs/$stage-$what.log" | sed 's/^/    /'
    fi
    return 1
}

# case_of STAGE WHAT COMMAND...: a stage that is one case
case_of() {
    if step "$@"; then
        passed=$((passed + 1))
        say "$1" "$2 passed"
    fi
}

# build STAGE C-COMPILER C++-COMPILER OPTIONS...
build() {
    stage=$1
    c=$2
    cxx=$3
    shift 3
    if [ ! -f "$work/$stage/build.ninja" ]; then
        rm -rf "${work:?}/$stage"
        step "$stage" setup env CC="$c" CXX="$cxx" meson setup -Dwerror=true -Dtests=enabled "$@" \
            "$work/$stage" "$root" || return 1
    fi
    step "$stage" build ninja -C "$work/$stage" || return 1
    say "$stage" built
}

# suites STAGE BUILD MESON-TEST-ARGUMENTS...: runs tests of a build and adds up their results
suites() {
    stage=$1
    folder=$work/$2
    shift 2
    clock=$(date +%s)
    rm -f "$folder/meson-logs/$stage"*.json
    meson test -C "$folder" --no-rebuild --logbase "$stage" "$@" >"$logs/$stage-test.log" 2>&1 </dev/null
    status=$?
    # shellcheck disable=SC2086 # an option or nothing. With --wrap the log's name has the wrapper's behind it.
    python3 "$root/tests/summary.py" "$folder/meson-logs/$stage"*.json $may_skip >"$logs/$stage-summary.log"
    counts=$(tail -n 1 "$logs/$stage-summary.log")
    # shellcheck disable=SC2086 # three numbers
    set -- $counts
    if [ $# -ne 3 ] || { [ $status -ne 0 ] && [ "$2" -eq 0 ]; }; then
        set -- 0 1 0
        tail -n 20 "$logs/$stage-test.log" >>"$logs/$stage-summary.log"
    fi
    passed=$((passed + $1))
    failed=$((failed + $2))
    skipped=$((skipped + $3))
    say "$stage" "tests: $1 passed, $2 failed, $3 skipped"
    sed '$d' "$logs/$stage-summary.log"
}

# drop STAGE: its build folder, where it is not to be kept
drop() {
    [ -n "$keep" ] || rm -rf "${work:?}/$1"
}

# The validator and independent readers of glTF come from npm, by the lock file, into the build folder.
install_node_packages() {
    mkdir -p "$work/node" || return 1
    cmp -s "$root/tests/golden/package-lock.json" "$work/node/package-lock.json" &&
        [ -d "$work/node/node_modules/gltf-validator" ] && return 0
    cp "$root/tests/golden/package.json" "$root/tests/golden/package-lock.json" "$work/node/" || return 1
    (cd "$work/node" && npm ci --ignore-scripts --no-audit --no-fund)
}

# Both libraries by their wraps, from sources that were downloaded before.
build_from_wraps() {
    rm -rf "$work/wraps"
    meson setup --wrap-mode=nodownload --force-fallback-for=openmesh,tinygltf -Dtests=disabled "$work/wraps" "$root" &&
        ninja -C "$work/wraps"
}

export FFD_NODE="$work/node"
step node npm install_node_packages

if build gcc gcc g++ -Dbuildtype=debugoptimized; then
    if [ -n "$suite" ]; then
        suites gcc gcc --suite "$suite"
    elif [ -n "$all" ]; then
        suites gcc gcc
    else
        suites gcc gcc --no-suite slow
    fi
fi

if [ -n "$all" ]; then
    # The program by its command line: with assertions by gcc above, with clang and its sanitizers below.
    if build clang clang clang++ -Dbuildtype=debugoptimized; then
        suites clang clang --suite unit --suite property --suite oracle --suite fuzz --suite golden --no-suite slow
    fi
    drop clang

    if build release gcc g++ -Dbuildtype=release; then
        suites release release --suite golden --suite rules --suite property --no-suite slow
    fi
    drop release

    # gcc needs minutes for this one.
    if build asan clang clang++ -Dbuildtype=debug -Doptimization=1 -Db_sanitize=address,undefined \
        -Db_lundef=false; then
        suites asan asan --no-suite rules --no-suite bench --no-suite slow --timeout-multiplier 6
    fi
    drop asan

    # The address space must not be shuffled more than the thread sanitizer of Debian 12 copes with.
    if build tsan gcc g++ -Dbuildtype=debugoptimized -Db_sanitize=thread -Db_lundef=false; then
        suites tsan tsan --suite unit --suite property --suite threads --no-suite slow --wrap "setarch -R" --timeout-multiplier 10
    fi
    drop tsan

    if [ -f "$work/gcc/build.ninja" ]; then
        suites valgrind gcc --suite unit --no-suite slow --timeout-multiplier 30 \
            --wrap "valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite"
    fi

    # The fuzz targets themselves, for a moment and always the same one: a search for what is new takes hours, and
    # is not what a change is judged by. Their corpus was replayed by every build above.
    for target in lattice manifest report obj gltf glb ply off stl; do
        case_of fuzz "$target" sh "$root/tests/fuzz/run.sh" -t "$target" -n 3000 15 "$work/fuzz"
    done
    drop fuzz

    case_of demo run sh "$root/data/demo.sh" "$work/demo"

    if [ -d "$root/subprojects/openmesh-9.0" ] && [ -d "$root/subprojects/tinygltf-2.7.0" ]; then
        case_of wraps build build_from_wraps
        drop wraps
    else
        # They come from their own hosts, which a machine need not reach.
        clock=$(date +%s)
        say wraps "not tried: no sources in subprojects/ (meson subprojects download)"
    fi
fi

printf 'logs in %s; %d s\n' "$logs" "$(($(date +%s) - started))"
if [ "$skipped" -gt 0 ]; then
    echo "$passed passed, $failed failed, $skipped skipped"
else
    echo "$passed passed, $failed failed"
fi
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
