#!/bin/sh
# Builds ffd and runs its tests, in build folders of its own under .build-test/.
#     sh tests/run.sh                 the gcc build, every quick suite (all but slow, soak, npm, windows, python and packages)
#     sh tests/run.sh --suite NAME    the gcc build, one suite (unit property oracle fuzz golden cli rules python packages bench
#                                     slow npm arm64 windows)
#                                     or one tag (threads compilers text blender), or peers (other packages; fetches 280 MB)
#     sh tests/run.sh --all           in a bare root of Debian 12: data/demo.sh, then this script, then its other stages (tests/install/all.sh)
#     sh tests/run.sh --stages        the stages that only --all has: slow suites, release, clang with sanitizers, valgrind, fuzzing, npm, arm64, the wraps
#     sh tests/run.sh --release       every artefact of data/packaging/release.sh, made twice: the same bytes, and the whole job list;
#                                     as root also in bare roots, by the lines of the README
#     sh tests/run.sh --soak          the gcc build, what takes hours, with other random numbers every time
#     --keep                          keeps the build folders of the stages that only --all has, and its root
# FFD_MODELS names a folder of sample models (default: shared/models beside the checkout); without it the tests
# that need it are skipped. One line a stage, then what failed; the last line: N passed, N failed[, N skipped].
set -u

usage() {
    echo "usage: sh tests/run.sh [--all | --stages | --release | --soak | --suite NAME] [--keep]" >&2
    exit 2
}

mode=
suite=
keep=
while [ $# -gt 0 ]; do
    case "$1" in
    --all | --stages | --release | --soak) mode=$mode$1 ;;
    --keep) keep=--keep ;;
    --suite)
        [ $# -ge 2 ] || usage
        mode=$mode$1
        suite=$2
        shift
        ;;
    *) usage ;;
    esac
    shift
done
all=
soak=
case "$mode$suite" in
'' | --suite?*) ;;
--all | --stages) all=1 ;;
--soak) soak=1 ;;
--release) ;;
*) usage ;;
esac
[ "$suite" != soak ] || usage

root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
if [ -z "${FFD_MODELS-}" ] && [ -d "$root/../shared/models" ]; then
    FFD_MODELS=$(cd "$root/../shared/models" && pwd)
fi
if [ -n "${FFD_MODELS-}" ]; then
    export FFD_MODELS
else
    unset FFD_MODELS
    echo "FFD_MODELS is not set: tests on the sample models are skipped"
fi
# shellcheck disable=SC2086 # an option or nothing
[ "$mode" != --all ] || exec sh "$root/tests/install/all.sh" $keep
. "$root/.ci/progress.sh"
work=$root/.build-test
logs=$work/logs
mkdir -p "$logs" || exit 1
case "$mode$suite" in
--suitepeers | --soak) needs=peers ;;
--suiteslow | --suitepython | --suitepackages | --suitenpm | --suitearm64 | --suitewindows | --suiteblender | --stages | --release) needs=stages ;;
*) needs=test ;;
esac
sh "$root/.ci/setup" $needs || exit 1

# The suite python builds a wheel, optimized: it follows the stage of --all that has compiled the same, and the quick run, which
# has not, leaves it out. Its tools come from a package index, which a machine need not reach (.ci/setup).
python='--suite python'
skipped=0
if { [ -n "$all$soak" ] || [ "$suite" = python ]; } && ! cmp -s "$root/tests/python/requirements.txt" "$work/wheels/requirements.txt"; then
    python=
    skipped=1
    echo "the wheels of tests/python are not there: the suite python is skipped"
fi

# A sanitizer's finding ends the program at once, with an exit code that no test expects.
# It names the line of a bad access, but not the calls that led to an allocation: to keep these takes a quarter of all page
# faults of the tests. For one test by hand, ASAN_OPTIONS=malloc_context_size=30 brings them back.
export ASAN_OPTIONS="halt_on_error=1:exitcode=99:detect_leaks=1:allocator_may_return_null=1:malloc_context_size=1"
export UBSAN_OPTIONS="halt_on_error=1:exitcode=99:print_stacktrace=1"
export TSAN_OPTIONS="halt_on_error=1:exitcode=99:suppressions=$root/tests/support/tsan.supp"
export PYTHONDONTWRITEBYTECODE=1

# Builds share what they compile, those that tests make included (meson finds ccache by itself); so does the next run.
ccache=
if command -v ccache >/dev/null 2>&1; then
    ccache='ccache '
    export CCACHE_DIR="${CCACHE_DIR-$work/ccache}"
    # Every call names the headers that it read (-MD): ccache needs no preprocessor of its own to know them.
    # The wheel, the packages and the demo compile what the stage `release` has compiled before, with warnings as errors. In
    # Debian's flags -O3 stands at the end: that a build type brings it once more makes no difference.
    export CCACHE_DEPEND=1 CCACHE_IGNOREOPTIONS="-Werror -O3" CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS:+$CCACHE_SLOPPINESS,}locale"
fi
delivered=$(python3 "$root/tests/install/flags.py")

# Large pages for what compilers and linkers allocate spare them nearly half of their page faults (glibc 2.35, where the system
# gives them on demand).
pages=GLIBC_TUNABLES=glibc.malloc.hugetlb=1

passed=0
failed=0
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

# build STAGE "SUITES" C-COMPILER C++-COMPILER OPTIONS...: builds what these suites need, everything for none. What ahead
# has begun is ended first; what failed there fails again, and is told of.
lower=
builder=
build() {
    stage=$1
    chosen=$2
    c=$3
    cxx=$4
    shift 4
    began=$(date +%s)
    [ -n "$lower" ] || [ -z "$builder" ] || wait "$builder"
    builder=
    if [ ! -f "$work/$stage/build.ninja" ]; then
        rm -rf "${work:?}/$stage"
        # shellcheck disable=SC2086 # words
        step "$stage" setup $lower env CC="$ccache$c" CXX="$ccache$cxx" meson setup -Dwerror=true -Dtests=enabled "$@" \
            "$work/$stage" "$root" || return 1
    fi
    # shellcheck disable=SC2086 # words
    step "$stage" build $lower env $pages sh -c 'targets=$(python3 "$1/tests/targets.py" "$2" $3) && ninja -C "$2" $targets' sh \
        "$root" "$work/$stage" "$chosen" || return 1
    clock=$began
    say "$stage" built
}

# build_stage STAGE: a build that only --all has. Programs with sanitizers are linked to a fixed address: one that may be loaded
# anywhere sets half a million pointers right before it begins, which touches thousands of pages each time. A finding
# ends the program in any case: that no code goes on after one (no recover) spares a third of compiling.
lines=-gline-tables-only
coverage="-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp,pc-table -fno-sanitize-recover=all $lines"
build_stage() {
    case "$1" in
    release)
        build release 'golden rules property compilers python packages' gcc g++ -Dbuildtype=release \
            -Dc_args="$delivered" -Dcpp_args="$delivered"
        ;;
    asan)
        clang -O1 -c "$root/tests/support/leak_check_pages.c" -o "$work/leak_check_pages.o" || return 1
        build asan 'unit property fuzz golden cli' clang clang++ -Dbuildtype=debug -Doptimization=1 -Db_pie=false \
            -Db_sanitize=address,undefined -Db_lundef=false -Dfuzzers=true -Dc_args="$coverage" -Dcpp_args="$coverage" \
            -Dc_link_args="-no-pie $work/leak_check_pages.o" -Dcpp_link_args="-no-pie $work/leak_check_pages.o"
        ;;
    clang)
        build clang 'threads compilers property' clang clang++ -Dbuildtype=debugoptimized -Db_pie=false \
            -Db_sanitize=thread -Db_lundef=false -Dc_args="$lines" -Dcpp_args="$lines" -Dc_link_args=-no-pie \
            -Dcpp_link_args=-no-pie
        ;;
    esac
}

# ahead STAGE: begins the build of the next stage, which takes what the tests beside it leave of the processors.
ahead() {
    { lower='nice -n 19'; build_stage "$1"; } >/dev/null 2>&1 </dev/null &
    builder=$!
}

# suites STAGE BUILD MESON-TEST-ARGUMENTS...: runs tests of a build and adds up their results
suites() {
    stage=$1
    folder=$work/$2
    shift 2
    clock=$(date +%s)
    rm -f "$folder/meson-logs/$stage"*.json
    status=0
    progress "$logs/$stage-test.log" testing meson test -C "$folder" --no-rebuild --logbase "$stage" "$@" || status=$?
    # With --wrap the log's name has the wrapper's behind it.
    python3 "$root/tests/summary.py" "$folder/meson-logs/$stage"*.json >"$logs/$stage-summary.log"
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

# The validator, independent readers of glTF, three.js and what drives a browser come from npm, by the lock file, into the build folder.
install_node_packages() {
    mkdir -p "$work/node" || return 1
    cmp -s "$root/tests/golden/package-lock.json" "$work/node/package-lock.json" &&
        [ -d "$work/node/node_modules/gltf-validator" ] && return 0
    cp "$root/tests/golden/package.json" "$root/tests/golden/package-lock.json" "$work/node/" || return 1
    (cd "$work/node" && npm ci --ignore-scripts --no-audit --no-fund)
}

# The pages of the release build are those that a browser has judged, of the gcc build.
compare_pages() {
    for model in spot.obj knight.glb; do
        for made in gcc release; do
            "$work/$made/src/cli/ffd" view "$root/data/models/$model" -l "$root/data/lattices/twist.json" \
                -o "$work/$made/$model.html" --force || return 1
        done
        cmp "$work/gcc/$model.html" "$work/release/$model.html" || return 1
    done
}

# can_cross STAGE TOOL...: whether this machine has these tools and the sources of the wraps. A machine may not reach the sources.
can_cross() {
    stage=$1
    shift
    clock=$(date +%s)
    for tool; do
        command -v "$tool" >/dev/null 2>&1 && continue
        skipped=$((skipped + 1))
        say "$stage" "skipped: no $tool (.ci/setup stages)"
        return 1
    done
    sh "$root/.ci/wraps" >"$logs/$stage-sources.log" 2>&1 </dev/null && return 0
    skipped=$((skipped + 1))
    say "$stage" "skipped: $(tail -n 1 "$logs/$stage-sources.log")"
    return 1
}

# The package for npm, made by emscripten from the sources that .ci/wraps gets, beside the program of the gcc build.
test_npm() {
    can_cross npm emcc || return
    rm -rf "$work/npm-out"
    if step npm build sh "$root/data/packaging/npm.sh" "$work/npm-out" "$work/npm"; then
        say npm built
        FFD_NPM=$(echo "$work/npm-out"/*.tgz)
        export FFD_NPM
        suites npm gcc --suite npm
    fi
}

# The program for Windows, under wine, beside the program of the gcc build.
test_windows() {
    can_cross windows x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix || return
    printf '[constants]\ncache = [%s]\n' "${ccache:+'ccache'}" >"$work/cache.ini"
    [ -f "$work/windows/build.ninja" ] || step windows setup meson setup "$work/windows" "$root" \
        --cross-file "$root/data/packaging/windows.ini" --cross-file "$work/cache.ini" --wrap-mode=forcefallback \
        -Dwerror=true -Dbuildtype=release -Dstatic=true -Ddefault_library=static -Dpython=true -Dtests=disabled || return
    if step windows build ninja -C "$work/windows" ffd_mesh src/cli/ffd.exe tests/windows/ffd_fault.exe tests/windows/hold.exe \
        tests/windows/library.exe; then
        say windows built
        FFD_WINDOWS=$work/windows
        export FFD_WINDOWS
        suites windows gcc --suite windows
    fi
}

# setup_arm64 FOLDER OPTIONS...: a build folder for arm64, of one static file. Meson reads its cross files again where a build file has
# changed.
setup_arm64() {
    cat >"$work/arm64.ini" <<EOF
[constants]
cache = [${ccache:+'ccache'}]
[binaries]
pkgconfig = 'pkg-config'
[properties]
pkg_config_libdir = '/usr/lib/aarch64-linux-gnu/pkgconfig'
EOF
    folder=$work/$1
    shift
    [ -f "$folder/build.ninja" ] || meson setup "$folder" "$root" --cross-file "$root/data/packaging/arm64.ini" --cross-file "$work/arm64.ini" \
        -Dwerror=true -Dbuildtype=release -Dstatic=true "$@"
}

# The program for arm64 does the job list in qemu: its own kernels give the bytes of x86-64. The processes of a batch would begin
# without qemu.
test_arm64() {
    can_cross arm64 aarch64-linux-gnu-g++ qemu-aarch64 || return
    step arm64 setup setup_arm64 arm64 --wrap-mode=forcefallback -Dtests=disabled || return
    if step arm64 build ninja -C "$work/arm64" src/cli/ffd; then
        say arm64 built
        case_of arm64 jobs python3 "$root/tests/release/run_jobs.py" --every 7 --without batch qemu-aarch64 "$work/arm64/src/cli/ffd"
    fi
}

# A machine with the other byte order does the whole job list in qemu. All libraries are compiled by their wraps.
test_big_endian() {
    can_cross big-endian s390x-linux-gnu-g++ qemu-s390x || return
    sed 's/aarch64/s390x/g; s/little/big/' "$root/data/packaging/arm64.ini" >"$work/s390x.ini"
    [ -f "$work/s390x/build.ninja" ] || step big-endian setup meson setup "$work/s390x" "$root" --cross-file "$work/s390x.ini" \
        --wrap-mode=forcefallback -Dwerror=true -Dbuildtype=release -Dstatic=true -Dtests=disabled || return
    if step big-endian build ninja -C "$work/s390x" src/cli/ffd; then
        case_of big-endian jobs python3 "$root/tests/release/run_jobs.py" --other-order --without batch qemu-s390x "$work/s390x/src/cli/ffd"
    fi
}

# The unit tests in qemu. All libraries but cmocka are compiled by their wraps. Debian's cmocka for arm64 is a shared library, and
# brings a C library, whose own loader is to load it: with that of the cross compiler, threads wait for ever.
test_arm64_units() {
    can_cross arm64-unit aarch64-linux-gnu-g++ qemu-aarch64 || return
    cat >"$work/arm64-unit.ini" <<EOF
[binaries]
exe_wrapper = ['qemu-aarch64', '-E', 'LD_LIBRARY_PATH=/usr/lib/aarch64-linux-gnu:/usr/aarch64-linux-gnu/lib', '-E', 'FFD_EMULATED=1']
EOF
    libraries=$(cd "$root/subprojects" && echo *.wrap | sed 's/\.wrap//g; s/ /,/g')
    step arm64-unit setup setup_arm64 arm64-unit --cross-file "$work/arm64-unit.ini" --wrap-mode=nodownload --force-fallback-for="$libraries" -Dtests=enabled || return
    # shellcheck disable=SC2016 # the inner shell's
    if step arm64-unit build sh -c 'ninja -C "$2" $(python3 "$1/tests/targets.py" "$2" unit)' sh "$root" "$work/arm64-unit"; then
        suites arm64-unit arm64-unit --suite unit --no-suite slow --no-suite soak --timeout-multiplier 0
    fi
}

# The libraries that a system may lack, each compiled by its wrap, from sources that .ci/wraps gets: every module links, and the
# program, with modules and as one static file, gives the bytes that the golden suite remembers.
wraps='--wrap-mode=nodownload --force-fallback-for=draco,meshoptimizer,openmesh,tinygltf'
test_wraps() {
    can_cross wraps || return
    for kind in both static; do
        options=-Ddefault_library=both
        [ "$kind" = both ] || options=-Dstatic=true
        # shellcheck disable=SC2086 # options
        if build "wraps-$kind" golden gcc g++ -Dbuildtype=release -Dc_args="$delivered" -Dcpp_args="$delivered" \
            $options $wraps; then
            chosen='--suite golden --no-suite node --no-suite part_of_corpus --no-suite slow'
            [ "$kind" = both ] || chosen=golden
            # shellcheck disable=SC2086 # words
            suites "wraps-$kind" "wraps-$kind" $chosen
        fi
        drop "wraps-$kind"
    done
}

# What is delivered, from the last commit, by two runs in folders of their own. The second one compiles all anew, as somebody else
# elsewhere would.
release_all() {
    sh "$root/data/packaging/release.sh" "$1" && sh "$root/data/packaging/release.sh" "$1" macos
}
release_twice() {
    release_all "$work/artefacts" &&
        (umask 077 && TZ=Asia/Tokyo CCACHE_RECACHE=1 && export TZ CCACHE_RECACHE && release_all "$work/artefacts-again") &&
        cmp "$work/artefacts/SHA256SUMS" "$work/artefacts-again/SHA256SUMS"
}
test_release() {
    rm -rf "$work/artefacts" "$work/artefacts-again"
    step release setup sh "$root/.ci/setup" release || return
    case_of release twice release_twice || return
    for name in sums sbom wheel wheel-arm64 wheel-musl wheel-windows static static-arm64 windows macos npm blender source deb; do
        case_of release "$name" python3 "$root/tests/release/test_artefacts.py" "$work/artefacts" "$name"
    done
    clock=$(date +%s)
    if [ "$(id -u)" -eq 0 ]; then
        case_of release roots python3 "$root/tests/release/test_roots.py" "$work/artefacts"
        grep 'skipped: ' "$logs/release-roots.log" && skipped=$((skipped + 1))
    else
        skipped=$((skipped + 1))
        say release 'skipped: only root can make bare roots'
    fi
    sed 's/^/    /' "$work/artefacts/SHA256SUMS"
}

export FFD_NODE="$work/node"
[ "$mode" != --release ] || test_release
step node npm install_node_packages

# Debug information tells lines only: a trace needs no more.
if [ "$mode" != --release ] && build gcc '' gcc g++ -Dbuildtype=debugoptimized -Dc_args=-g1 -Dcpp_args=-g1; then
    if [ "$suite" = peers ]; then
        suites gcc gcc --suite peers
    elif [ "$suite" = npm ] || [ "$suite" = arm64 ] || [ "$suite" = windows ]; then
        "test_$suite"
    elif [ -n "$suite" ]; then
        suites gcc gcc --suite "$suite" --no-suite soak
    elif [ -n "$all" ]; then
        ahead release
        suites slow gcc --suite slow --no-suite python --no-suite packages --no-suite soak
        test_npm
        drop npm
        test_arm64
        drop arm64
        test_windows
        drop windows
    elif [ -n "$soak" ]; then
        FFD_SEED=${FFD_SEED-$started}
        export FFD_SEED
        echo "FFD_SEED=$FFD_SEED"
        suites soak gcc --suite soak --timeout-multiplier 0
        test_arm64_units
        drop arm64-unit
        test_big_endian
        drop s390x
        case_of bare roots sh "$root/tests/install/bare.sh"
        # The Python package in an interpreter with the address sanitizer: the hours of soak have the time for that build.
        if [ -n "$python" ] && build_stage asan; then
            suites sanitized asan --suite sanitized --timeout-multiplier 6
            drop asan
        fi
    else
        suites gcc gcc --no-suite python --no-suite packages --no-suite npm --no-suite windows --no-suite slow --no-suite soak
    fi
fi

if [ -n "$all" ]; then
    # As it is delivered: without assertions, with every optimization, with Debian's flags. A rule on the text of the sources says nothing new,
    # nor do the validator and the browser, where the files and pages are byte for byte those of the gcc build.
    if build_stage release; then
        ahead asan
        # shellcheck disable=SC2086 # words, or nothing
        suites release release --suite golden --suite rules --suite property --suite compilers --suite packages $python \
            --no-suite text --no-suite node --no-suite slow --no-suite soak
        [ ! -x "$work/gcc/src/cli/ffd" ] || case_of release pages compare_pages
    fi
    drop release

    # The address and undefined-behaviour sanitizers find something wherever a pointer goes: all suites but those that
    # measure, look at what is installed, or ask for numbers only: the oracle's lattices are as random as those of the
    # fuzz targets, which go through the same parts of the library. The validator in node judges files, not memory.
    # Tests repeat themselves less there (tests/support/repetitions.h, repetitions() of tests/cli/harness.py). clang,
    # for gcc needs minutes to build this. The fuzz targets come from the same build.
    fuzzed='lattice table weights pairs manifest report clip obj gltf glb ply off stl png jpeg webp'
    if build_stage asan; then
        ahead clang
        suites asan asan --no-suite oracle --no-suite rules --no-suite bench --no-suite node --no-suite slow \
            --no-suite packages --no-suite npm --no-suite windows --no-suite soak --timeout-multiplier 6

        # The fuzz targets themselves, for a moment and always the same one: a search for what is new takes hours, and
        # is not what a change is judged by. Their corpus was replayed by every suite `fuzz` above.
        # shellcheck disable=SC2086 # words
        printf '%s\n' $fuzzed | xargs -P "$(nproc)" -I '{}' sh -c '
            sh "$1/tests/fuzz/run.sh" -t {} -n 2000 8 "$2" >"$3/fuzz-{}.out" 2>&1
            echo $? >"$3/fuzz-{}.status"' sh "$root" "$work/asan" "$logs"
        for target in $fuzzed; do
            case_of fuzz "$target" sh -c 'cat "$1.out"; exit "$(cat "$1.status")"' sh "$logs/fuzz-$target"
        done
    fi
    drop asan

    # What is only to be found with clang and optimization: other code for the kernels and what is around them (suite
    # compilers; the same bytes are promised). The thread sanitizer adds its checks after the optimizer, so that one build
    # serves for both. It finds something only where there are threads. All else of clang is in the build above.
    # The address space must not be shuffled more than the thread sanitizer of Debian 12 copes with.
    if build_stage clang; then
        suites clang clang --suite threads --suite compilers --suite property --no-suite slow --no-suite soak \
            --wrap "setarch -R" --timeout-multiplier 10
    fi
    drop clang

    # What the sanitizers do not see: memory that is read before it is written. The unit tests reach all of the library.
    if [ -f "$work/gcc/build.ninja" ]; then
        suites valgrind gcc --suite unit --no-suite slow --no-suite soak --timeout-multiplier 30 \
            --wrap "valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite"
    fi

    test_wraps
fi

printf 'logs in %s; %d s\n' "$logs" "$(($(date +%s) - started))"
if [ "$skipped" -gt 0 ]; then
    echo "$passed passed, $failed failed, $skipped skipped"
else
    echo "$passed passed, $failed failed"
fi
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
