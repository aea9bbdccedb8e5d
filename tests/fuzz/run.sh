#!/bin/sh
# Fuzzes lattice files and points with clang's libFuzzer under the address and undefined-behaviour sanitizers.
#     sh tests/fuzz/run.sh SECONDS [FOLDER]
# Builds in FOLDER (default .build-test/fuzz). What is found new goes to FOLDER/corpus, which the next run goes
# on with; inputs that end in a finding go to FOLDER/findings. Ends with 0 when there was none.
set -eu

if [ $# -lt 1 ] || [ $# -gt 2 ]; then
    echo "usage: sh tests/fuzz/run.sh SECONDS [FOLDER]" >&2
    exit 2
fi
seconds=$1
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=${2-$root/.build-test/fuzz}

if [ ! -f "$work/build.ninja" ]; then
    # Watching every comparison of numbers would take most of the time.
    coverage='-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp'
    CC=clang CXX=clang++ meson setup -Dtests=enabled -Dfuzzers=true -Dbuildtype=debug -Doptimization=2 \
        -Db_sanitize=address,undefined -Db_lundef=false -Dc_args="$coverage" -Dcpp_args="$coverage" \
        "$work" "$root"
fi
ninja -C "$work" tests/fuzz/fuzz_lattice

mkdir -p "$work/corpus" "$work/findings"
export ASAN_OPTIONS="halt_on_error=1:detect_leaks=1:allocator_may_return_null=1"
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1"
exec "$work/tests/fuzz/fuzz_lattice" -max_total_time="$seconds" -max_len=8192 -timeout=20 -rss_limit_mb=2048 \
    -dict="$here/lattice.dict" -artifact_prefix="$work/findings/" -print_final_stats=1 \
    "$work/corpus" "$here/corpus/lattice"
