#!/usr/bin/env python3
"""What others build the program from, in one folder, so that what is compiled once need not be compiled again:

  - `meson dist` makes a tarball that holds every file of the project and no other;
  - from it ffd is built and installed as README.md says, and runs, and so does README.md's C example;
  - Debian packages are built from it as README.md says, lintian finds no error in them, and in a bare root
    (bare_root.sh) they are installed with what they depend on, run, and are removed again.

    test_packages.py FFD CC CXX

All is compiled as Debian's packages are. With ccache, the second build takes what the first has compiled, and both take what
tests/run.sh has compiled for its stage `release`.
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

import flags
import stage

LIBRARY = f"libffd{stage.ABI}"
PACKAGES = ["ffd", LIBRARY, "libffd-dev"]
MESH, LATTICE = "models/spot.obj", "lattices/twist.json"
NEEDS_MODULES = "models/character.glb"

# What is done in the clean root.
CHECK = """set -eu
cd /check
apt-get -qq update
apt-get install --yes --no-install-recommends ./ffd_*.deb ./LIBRARY_*.deb
ldconfig -p | grep -q 'libffd\\.so\\.0'
ffd --version >version
ffd deform spot.obj out.obj -l twist.json --report report.json
ffd info character.glb >info
apt-get purge --yes ffd LIBRARY
find / -xdev -path /check -prune -o -path /src -prune -o -path /proc -prune -o -path /var/lib -prune -o -path /var/log -prune -o \\
    -name '*ffd*' -print >left
""".replace("LIBRARY", LIBRARY)


def pack(folder, findings):
    """Makes the tarball of a release, and unpacks it; returns the folder of the source."""
    # A repository of its own: `meson dist` takes what is committed, and a test shall see what is there.
    copy = stage.copy_source(os.path.join(folder, "copy"))
    names = {os.path.relpath(os.path.join(base, name), copy) for base, _, files in os.walk(copy) for name in files}
    git = ["git", "-C", copy, "-c", "user.name=test", "-c", "user.email=test@localhost"]
    stage.run([*git, "init", "--quiet"])
    stage.run([*git, "add", "--all", "--force"])
    stage.run([*git, "commit", "--quiet", "--message", "all"])
    build = os.path.join(folder, "build")
    stage.run(["meson", "setup", "-Dtests=disabled", build, copy])
    stage.run(["meson", "dist", "-C", build, "--no-tests", "--formats", "gztar"])
    (tarball,) = glob.glob(os.path.join(build, "meson-dist", "*.tar.gz"))
    top = os.path.basename(tarball).removesuffix(".tar.gz")
    with tarfile.open(tarball) as archive:
        packed = {os.path.relpath(member.name, top) for member in archive if not member.isdir()}
        archive.extractall(folder)
    findings += [f"not in the tarball: {name}" for name in sorted(names - packed)]
    findings += [f"in the tarball, and not expected: {name}" for name in sorted(packed - names)]
    shutil.rmtree(copy)
    shutil.rmtree(build)
    return os.path.join(folder, top)


def compiler_environment(source, compilers):
    """The compilers, Debian's own flags for a source, as data/packaging/debian asks for them, and a ccache for all sources."""
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("CFLAGS", "CXXFLAGS", "LDFLAGS", "DESTDIR")}
    # -O3 stands in all flags, at the end: that a build type brings another makes no difference. Nor does it that
    # debhelper has a locale of its own, nor -Werror.
    environment.update(CCACHE_BASEDIR=source, CCACHE_IGNOREOPTIONS="-Werror -O3", CCACHE_NOHASHDIR="1",
                       CCACHE_SLOPPINESS=",".join(filter(None, [environment.get("CCACHE_SLOPPINESS"), "locale"])))
    environment.setdefault("CCACHE_DIR", os.path.join(os.path.dirname(source), "ccache"))
    # ccache tells compilers by their names.
    environment.update(flags.stripped(source), CC=compilers[0], CXX=compilers[1])
    return environment, flags.of(source)


def readme_build(source, environment, findings):
    """The commands of README.md's block ```sh build, and its C example."""
    folder = os.path.dirname(source)
    root = os.path.join(folder, "root")
    environment = dict(environment, DESTDIR=root)
    # As deep below the source as all builds of tests/run.sh: the compiler is told ../../src.
    setup, *others = stage.readme("build").replace(" build\n", " build/readme\n").splitlines(keepends=True)
    stage.run(setup, cwd=source, env=environment)
    # A machine with cmocka builds the tests too; they are what this is a part of.
    stage.run(["meson", "configure", "build/readme", "-Dtests=disabled"], cwd=source, env=environment)
    stage.run("".join(others), cwd=source, env=environment)
    ffd, pc, library = (next(os.path.join(path, os.path.basename(name)) for path, _, names in os.walk(root)
                             if os.path.basename(name) in names and path.endswith(os.path.dirname(name)))
                        for name in ("bin/ffd", "ffd.pc", "libffd.so"))
    environment = dict(os.environ, PKG_CONFIG_PATH=os.path.dirname(pc), LD_LIBRARY_PATH=os.path.dirname(library))
    version = stage.run([ffd, "--version"], env=environment).strip()
    if os.path.basename(source) != version.replace(" ", "-"):
        findings.append(f"{os.path.basename(source)} holds {version}")
    vase = os.path.join(folder, "vase.obj")
    stage.run([ffd, "deform", "data/models/vase.obj", vase, "-l", "data/lattices/bend.json"], cwd=source, env=environment)
    if subprocess.run([ffd, "compare", "data/models/vase.obj", vase], cwd=source, env=environment,
                      stdout=subprocess.DEVNULL, check=False).returncode != 1:
        findings.append("the vase was not deformed")
    c_example(folder, environment, findings)
    shutil.rmtree(os.path.join(source, "build"))


def c_example(folder, environment, findings):
    with open(os.path.join(folder, "example.c"), "w", encoding="utf-8") as file:
        file.write(next(content for _, name, content in stage.blocks(stage.read("README.md")) if name == "example.c"))
    stage.run("cc example.c $(pkg-config --cflags --libs ffd)", cwd=folder, env=environment)
    with open(os.path.join(folder, "box.json"), "w", encoding="utf-8") as file:
        file.write('{"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [-1, -1, -1], '
                   '"max": [1, 3, 1]}}, "moves": [{"by": [0.5, 0, 0]}]}')
    output = stage.run("./a.out box.json", cwd=folder, env=environment)
    if output != "0.5 2 0.2, 0.6 2.2 0.2\n":
        findings.append(f"the C example printed {output!r}")


def build(source, environment):
    """Builds the packages beside the source; returns their files by name."""
    # Without the packages of debug symbols, which take long.
    environment = dict(environment, DEB_BUILD_OPTIONS=f"noautodbgsym parallel={os.cpu_count()}")
    stage.run(stage.readme("package"), cwd=source, env=environment)
    return {os.path.basename(path).split("_")[0]: path
            for path in glob.glob(os.path.join(os.path.dirname(source), "*.deb"))}


def needs_of_pkg_config(packages, findings):
    """What ffd.pc requires must come with the package that has it."""
    depends = stage.run(["dpkg-deb", "-f", packages["libffd-dev"], "Depends"])
    content = stage.run(f"dpkg-deb --fsys-tarfile '{packages['libffd-dev']}' | tar -xO --wildcards '*/ffd.pc'")
    for name in re.findall(r"([\w-]+)(?:\s*[<>=]+\s*[\d.]+)?", re.search(r"^Requires.private: (.*)$", content, re.M)[1]):
        owner = stage.run(["dpkg", "-S", f"*/pkgconfig/{name}.pc"]).split(":")[0]
        if owner not in re.split(r"[ ,]+", depends.strip()):
            findings.append(f"libffd-dev does not depend on {owner}, whose {name}.pc it needs")


def notices_of_libraries(packages, findings):
    """Each package has code of others in it."""
    for name, path in packages.items():
        content = stage.run(["dpkg-deb", "--contents", path])
        findings += [f"{name} lacks the notice {text} of what is compiled into it" for text in ("draco", "tinygltf", "nlohmann_json", "libxxhash")
                     if not re.search(rf" \./usr/share/doc/{re.escape(name)}/licenses/{text}\.txt(\.gz)?$", content, re.M)]


def run_in_clean_root(folder, packages):
    """Returns the folder with what the check left."""
    tool = ["sh", os.path.join(stage.ROOT, "tests", "install", "bare_root.sh")]
    root = os.path.join(folder, "bare")
    stage.run([*tool, "make", root])
    data = os.path.join(stage.ROOT, "data")
    result = os.path.join(root, "check")
    os.mkdir(result)
    for path in (packages["ffd"], packages[LIBRARY], os.path.join(data, MESH), os.path.join(data, LATTICE),
                 os.path.join(data, NEEDS_MODULES)):
        shutil.copy(path, result)
    stage.run([*tool, "run", root, CHECK])
    return result


def check_result(folder, ffd, findings):
    # It is built from an archive, which knows no commit.
    with open(os.path.join(folder, "version"), encoding="ascii") as file:
        if file.read().split() != stage.run([ffd, "--version"]).split()[:2]:
            findings.append("the installed ffd says another version")
    expected = os.path.join(folder, "expected.obj")
    data = os.path.join(stage.ROOT, "data")
    stage.run([ffd, "deform", os.path.join(data, MESH), expected, "-l", os.path.join(data, LATTICE)])
    if stage.run("cmp -s out.obj expected.obj || echo differ", cwd=folder):
        findings.append("the installed ffd deforms otherwise than the one that was built here")
    with open(os.path.join(folder, "left"), encoding="utf-8") as file:
        findings += [f"left behind when it was removed: {line.strip()}" for line in file]


def check_packages(folder, source, environment, ffd, findings):
    packages = build(source, environment)
    if sorted(packages) != sorted(PACKAGES):
        findings.append(f"built {sorted(packages)} instead of {PACKAGES}")
    version = stage.run([ffd, "--version"]).split()[1]
    findings += [f"{path} is not of version {version}" for path in packages.values() if f"_{version}-" not in path]
    needs_of_pkg_config(packages, findings)
    notices_of_libraries(packages, findings)
    (changes,) = glob.glob(os.path.join(folder, "*.changes"))
    linted = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", changes], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    print(linted.stdout)
    if linted.returncode != 0:
        findings.append("lintian finds errors")
    check_result(run_in_clean_root(folder, packages), ffd, findings)


def main():
    ffd = os.path.abspath(sys.argv[1])
    stage.need("git", "meson")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        # Readable for the user that apt downloads as.
        os.chmod(folder, 0o755)
        source = pack(folder, findings)
        debian = shutil.which("dpkg-buildflags") is not None
        environment, flags_of_debian = compiler_environment(source, sys.argv[2:4]) if debian else (dict(os.environ), {})
        readme_build(source, {**environment, **flags_of_debian}, findings)
        if not findings:
            stage.need("dpkg-buildpackage", "dh", "lintian", "mmdebstrap")
        check_packages(folder, source, environment, ffd, findings)
    stage.finish(len(PACKAGES), "packages", findings)


main()
