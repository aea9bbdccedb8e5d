#!/usr/bin/env python3
"""C++ libraries are loaded when a file needs them, and not before; where what loads them is not there or is another's,
one line says so. Argument: the program packed_glb."""

import os
import re
import resource
import shutil
import subprocess
import sys

from harness import (CUBE, CUBE_CORNERS, FFD, LIMIT, MODULE_FOLDER, OK, SANITIZED, SECONDS, UNSUPPORTED, case, check, copy_program, equal,
                     glb, gltf_json, lattice, main)
from messages import anything

PACKED_GLB = os.path.abspath(sys.argv.pop(1))
MOVED = lattice(moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}])
NEEDED = {"cube.obj": set(), "plain.glb": {"tinygltf"}, "draco.glb": {"draco", "tinygltf"},
          "meshopt.glb": {"meshopt", "tinygltf"}}


def write_inputs(run):
    run.write("l.json", MOVED)
    run.write("cube.obj", CUBE)
    run.write("normals.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
    run.write("plain.glb", glb(*gltf_json(CUBE_CORNERS)))
    for kind in ("draco", "meshopt"):
        subprocess.run([PACKED_GLB, kind, "4", run.path(f"{kind}.glb")], check=True,
                       env={**os.environ, "ASAN_OPTIONS": "detect_leaks=0"})  # it frees nothing


def loaded(run, *arguments):
    """Names of the libraries that a run loads, without endings, as the C library tells them."""
    done = subprocess.run([FFD, *arguments], cwd=run.folder, env={**os.environ, "LD_DEBUG": "files"}, check=False,
                          capture_output=True, text=True, timeout=SECONDS)
    equal(done.returncode, OK, f"ffd {' '.join(arguments)}")
    found = re.findall(r"calling init: \S*?([^/\s]+)\.so", done.stderr)
    check(any(name.startswith("libc") for name in found), "LD_DEBUG tells", found)
    return found


@case
def a_library_is_loaded_when_a_file_needs_it(run):
    write_inputs(run)
    runs = {("--version",): set(), ("help",): set(), ("info", "l.json"): set(), ("info", "cube.obj"): {"openmesh"},
            ("compare", "cube.obj", "cube.obj"): set(),
            ("deform", "normals.obj", "faces.obj", "-l", "l.json", "--normals", "recompute"): {"openmesh"}}
    for name, needed in NEEDED.items():
        runs["deform", name, "out-" + name, "-l", "l.json"] = needed
    for arguments, needed in runs.items():
        found = loaded(run, *arguments)
        shown = f"ffd {' '.join(arguments)} loads"
        equal({name[len("ffd-"):] for name in found if name.startswith("ffd-")}, needed, shown)
        # The module of tinygltf has the C++ runtime in it. A sanitizer's is C++.
        check(SANITIZED or found.count("libstdc++") == bool(needed - {"tinygltf"}), shown, found)


@case
def a_module_that_is_not_there_is_named(run):
    write_inputs(run)
    for name, needed in NEEDED.items():
        for missing in sorted(needed - {"meshopt"}):
            folder = f"without-{missing}-{name}"
            program = copy_program(run.path(folder))
            os.remove(os.path.join(run.path(folder), MODULE_FOLDER, f"ffd-{missing}.so"))
            run.ffd("deform", name, "out.glb", "-l", "l.json", code=UNSUPPORTED, program=program,
                    err=re.compile(rf"^{name}:.* cannot be loaded: /.*/{MODULE_FOLDER}/ffd-{missing}\.so: .*No such file or directory$"))
            check(not run.exists("out.glb"), "an output was left")
            shutil.rmtree(run.path(folder))


@case
def without_the_module_of_meshopt_its_files_are_read(run):
    """Our own decoder reads them, more slowly, to the same bytes; but for indices in a version older than the extensions."""
    write_inputs(run)
    subprocess.run([PACKED_GLB, "meshopt-0", "4", run.path("older.glb")], check=True, env={**os.environ, "ASAN_OPTIONS": "detect_leaks=0"})
    program = copy_program(run.path("p"))
    os.remove(os.path.join(run.path("p"), MODULE_FOLDER, "ffd-meshopt.so"))
    run.ffd("deform", "meshopt.glb", "with.obj", "-l", "l.json", err=anything)
    run.ffd("deform", "meshopt.glb", "without.obj", "-l", "l.json", program=program, err=anything)
    equal(run.read("without.obj"), run.read("with.obj"))
    run.ffd("deform", "older.glb", "out.obj", "-l", "l.json", err=anything)
    equal(run.read("out.obj"), run.read("with.obj"))
    why = run.ffd("info", "older.glb", "--json", program=program).json["topology_unknown"]
    check(re.match(rf"the module for meshopt cannot be loaded: /.*/{MODULE_FOLDER}/ffd-meshopt\.so: .*No such file or directory$", why), why)


@case
def without_any_module_what_needs_none_works(run):
    write_inputs(run)
    program = copy_program(run.path("alone"))
    shutil.rmtree(run.path(f"alone/{MODULE_FOLDER}"))
    run.ffd("deform", "cube.obj", "out.obj", "-l", "l.json", program=program)
    done = run.ffd("info", "cube.obj", "--json", program=program)
    equal(done.json["topology"], None)
    check("ffd-openmesh.so" in done.json["topology_unknown"], done.json["topology_unknown"])


@case
def what_is_another_version_or_no_module_is_refused(run):
    write_inputs(run)
    program = copy_program(run.path("p"))
    path = run.path(f"p/{MODULE_FOLDER}/ffd-tinygltf.so")
    version = subprocess.run([FFD, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    with open(path, "rb") as file:
        module = file.read()
    older = module.replace(version.encode() + b"\0", b"0.0.9\0".rjust(len(version) + 1, b"0"))
    check(older != module, "the module does not say its version")
    with open(path.replace("tinygltf", "draco"), "rb") as file:
        other = file.read()
    with open(os.path.join(os.path.dirname(os.path.dirname(FFD)), "libffd.so"), "rb") as file:
        library = file.read()
    for content, said in ((older, r"ffd-tinygltf\.so is ffd-tinygltf\.so 0\.0\.9 \(\d+\), and not ffd-tinygltf\.so [\d.]+ \(\d+\), which is needed for glTF$"),
                          (other, r"ffd-tinygltf\.so is ffd-draco\.so .*, and not ffd-tinygltf\.so"),
                          (b"not a library", r"cannot be loaded: .*ffd-tinygltf\.so: "),
                          (b"", r"cannot be loaded: .*ffd-tinygltf\.so: "),
                          (library, r"ffd-tinygltf\.so is no module of ffd, and not ffd-tinygltf\.so"),
                          (module[:60], r"cannot be loaded: .*ffd-tinygltf\.so: ")):
        os.remove(path)  # a file that is mapped somewhere must not be written to
        with open(path, "wb") as file:
            file.write(content)
        run.ffd("deform", "plain.glb", "out.glb", "-l", "l.json", code=UNSUPPORTED, program=program, err=re.compile(said))
        check(not run.exists("out.glb"), "an output was left")


@case
def modules_are_found_from_wherever_the_program_is_called(run):
    write_inputs(run)
    program = copy_program(run.path("p"))
    os.symlink(program, run.path("linked"))
    run.folder_of("elsewhere")
    inputs = ("info", "../plain.glb")
    for words, environment in (([run.path("linked")], {}), (["../p/ffd"], {}), (["../linked"], {}),
                               (["ffd"], {"PATH": run.path("p") + ":" + os.environ["PATH"]})):
        done = subprocess.run([*words, *inputs], cwd=run.path("elsewhere"), env={**os.environ, **environment},
                              capture_output=True, text=True, check=False, timeout=SECONDS)
        equal((done.returncode, done.stderr), (OK, ""), words[0])


@case
def a_module_of_another_user_is_not_loaded(run):
    """A copy of the program may stand in a folder where everybody puts files."""
    if os.geteuid() != 0:
        return
    write_inputs(run)
    for name, change in (("another's", lambda path: os.chown(path, 65534, 65534)),
                         ("everybody's", lambda path: os.chmod(path, 0o777))):
        folder = "p-" + name[0]
        program = copy_program(run.path(folder))
        path = run.path(f"{folder}/{MODULE_FOLDER}/ffd-tinygltf.so")
        run.ffd("info", "plain.glb", program=program)
        change(path)
        run.ffd("info", "plain.glb", code=UNSUPPORTED, program=program,
                err=re.compile(r"cannot be loaded: /.*/ffd-tinygltf\.so: is no file, or one of another user, or one that everybody"))
        os.chown(run.path(folder + "/ffd"), 65534, 65534)  # that of the program's own owner is
        own = name == "another's"
        run.ffd("info", "plain.glb", program=program, code=OK if own else UNSUPPORTED, err=None if own else re.compile("cannot be loaded"))


@case
def what_is_no_file_is_not_loaded(run):
    """The loader would wait for a pipe."""
    write_inputs(run)
    program = copy_program(run.path("p"))
    path = run.path(f"p/{MODULE_FOLDER}/ffd-tinygltf.so")
    os.remove(path)
    for make, remove in ((os.mkfifo, os.remove), (os.mkdir, os.rmdir), (lambda path: os.symlink("/dev/zero", path), os.remove)):
        make(path)
        run.ffd("info", "plain.glb", code=UNSUPPORTED, program=program,
                err=re.compile(rf"cannot be loaded: /.*/p/{MODULE_FOLDER}/ffd-tinygltf\.so: is no file, or "))
        remove(path)


@case
def where_memory_is_short_a_run_says_so(run):
    if SANITIZED:
        return
    write_inputs(run)
    for name in ("plain.glb", "draco.glb", "meshopt.glb"):
        codes = set()
        for kilobytes in range(6000, 40000, 350):
            limit = kilobytes * 1024
            done = subprocess.run([FFD, "info", name], cwd=run.folder, capture_output=True, text=True, check=False, timeout=SECONDS,
                                  preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            # 127: the C library cannot start the program, and says so in its own words.
            check(done.returncode in (OK, LIMIT) or (done.returncode == 127 and done.stderr), name, kilobytes, done.returncode, done.stderr)
            check(done.returncode != LIMIT or re.fullmatch(r"ffd: .*out of memory\b.*\n", done.stderr), done.stderr)
            codes.add(done.returncode)
        check({OK, LIMIT} <= codes, name, codes)


main()
