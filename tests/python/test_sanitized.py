#!/usr/bin/env python3
"""Runs cases of the Python package in an interpreter that has the address sanitizer, with the library of a build that has it.

    test_sanitized.py SOURCE BUILD-FOLDER ABI CC [CASE...]       CASE: as unittest names it, "case_results.Bits"

The package is put together here: its library is linked of what the build folder has, with the options of the sanitizers. Leaks are not looked for: what an interpreter leaves at its end is no leak of ours. The wheels are those of
test_package.py, and without them it is skipped.
"""

import glob
import os
import shutil
import sys
import sysconfig
import tempfile

import test_package

FLAGS = ["-fsanitize=address,undefined", "-fno-omit-frame-pointer", "-g1", "-O1", "-fPIC"]
LIBRARIES = ["libffd_core.a", "libffd_loading.a"]
# Those that count calls, look at memory or time, or run for long.
CASES = ["case_arrays", "case_results", "case_files", "case_meshes", "case_running.Running.test_threads_share_an_embedding",
         "case_running.Running.test_progress_rises_and_cancels", "case_running.Running.test_an_interrupt_ends_a_call"]


def build_package(folder, source, build, abi, compiler, python):
    """The package ffd_mesh in folder."""
    package = os.path.join(folder, "ffd_mesh")
    shutil.copytree(os.path.join(source, "src", "python", "ffd_mesh"), package)
    layout = os.path.join(folder, "layout.c")
    test_package.run(python, os.path.join(source, "src", "python", "declare.py"), os.path.join(source, "include", "ffd"),
                     os.path.join(package, "_declarations.py"), layout, *compiler)
    archives = [os.path.join(build, "src", name) for name in LIBRARIES]
    archives += glob.glob(os.path.join(build, "src", "libffd_kernels_*.a"))
    test_package.run(*compiler, *FLAGS, "-shared", "-shared-libasan", "-DPy_LIMITED_API=0x030B0000",
                     "-I", os.path.join(source, "include"), "-I", sysconfig.get_paths()["include"],
                     os.path.join(source, "src", "python", "native.c"), layout, "-o", os.path.join(package, "_native.abi3.so"))
    test_package.run(*compiler, *FLAGS, "-shared", "-shared-libasan", "-Wl,--whole-archive", *archives, "-Wl,--no-whole-archive",
                     "-lm", "-lpthread", "-ldl", "-o", os.path.join(package, "libffd.so"))
    modules = os.path.join(package, f"ffd-{abi}")
    os.mkdir(modules)
    for module in glob.glob(os.path.join(build, "src", "ffd-*.so")):
        shutil.copy(module, modules)


def main():
    source, build, abi, compiler, *chosen = sys.argv[1:]
    compiler = compiler.split()
    lists = {"requirements.txt": test_package.fetched(source, "FFD_WHEELS", "wheels")}
    runtime = test_package.run(*compiler, "-print-file-name=libclang_rt.asan-x86_64.so").strip()
    if not os.path.isabs(runtime):
        test_package.skip("the compiler has no shared library of the address sanitizer")
    with tempfile.TemporaryDirectory() as folder:
        python, _ = test_package.make_environment(os.path.join(folder, "venv"), lists)
        build_package(folder, source, build, abi, compiler, python)
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        environment |= {"FFD_SOURCE": source, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": f"{folder}:{test_package.HERE}",
                        "TMPDIR": folder, "LD_PRELOAD": runtime, "PYTHONMALLOC": "malloc",
                        "ASAN_OPTIONS": "halt_on_error=1:exitcode=99:detect_leaks=0:allocator_may_return_null=1"}
        code = test_package.run_cases(python, chosen or CASES, folder, environment)
    sys.exit(1 if code else 0)


main()
