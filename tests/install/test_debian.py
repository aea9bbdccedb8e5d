#!/usr/bin/env python3
"""Debian packages are built as README.md says, lintian finds no error in them, and in a clean root, of nothing but
Debian's essential packages and apt, they are installed with what they depend on, run, and are removed again.

    test_debian.py FFD
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import stage

PACKAGES = ["ffd", "libffd0", "libffd-dev"]
MESH, LATTICE = "models/spot.obj", "lattices/twist.json"

# What is done in the clean root.
CHECK = """set -eu
cd /check
apt-get install --yes --no-install-recommends ./ffd_*.deb ./libffd0_*.deb
ldconfig -p | grep -q 'libffd\\.so\\.0'
ffd --version >version
ffd deform spot.obj out.obj -l twist.json --report report.json
apt-get purge --yes ffd libffd0
find / -xdev -path /check -prune -o -path /proc -prune -o -path /var/lib -prune -o -path /var/log -prune -o \\
    -name '*ffd*' -print >left
"""


def build(folder):
    """Builds the packages into folder; returns their files by name."""
    source = stage.copy_source(os.path.join(folder, "ffd"))
    # Without the packages of debug symbols, which take long.
    environment = dict(os.environ, DEB_BUILD_OPTIONS=f"noautodbgsym parallel={os.cpu_count()}")
    for name in ("CFLAGS", "CXXFLAGS", "LDFLAGS", "DESTDIR"):
        environment.pop(name, None)
    stage.run(stage.readme("package"), cwd=source, env=environment)
    return {os.path.basename(path).split("_")[0]: path for path in glob.glob(os.path.join(folder, "*.deb"))}


def needs_of_pkg_config(packages, findings):
    """What ffd.pc requires must come with the package that has it."""
    depends = stage.run(["dpkg-deb", "-f", packages["libffd-dev"], "Depends"])
    content = stage.run(f"dpkg-deb --fsys-tarfile '{packages['libffd-dev']}' | tar -xO --wildcards '*/ffd.pc'")
    for name in re.findall(r"([\w-]+)(?:\s*[<>=]+\s*[\d.]+)?", re.search(r"^Requires.private: (.*)$", content, re.M)[1]):
        owner = stage.run(["dpkg", "-S", f"*/pkgconfig/{name}.pc"]).split(":")[0]
        if owner not in re.split(r"[ ,]+", depends.strip()):
            findings.append(f"libffd-dev does not depend on {owner}, whose {name}.pc it needs")


def sources():
    """apt's own, as lines of a sources.list, of Debian."""
    lines = stage.run(["apt-get", "indextargets", "--format", "$(LABEL)|deb $(REPO_URI) $(RELEASE) $(COMPONENT)",
                       "Created-By: Packages"])
    return sorted({line.split("|")[1] for line in lines.splitlines() if line.startswith("Debian")})


def proxies():
    """apt's own, as options of mmdebstrap."""
    lines = stage.run(["apt-config", "dump", "Acquire"]).splitlines()
    return [f"--aptopt={line}" for line in lines if re.search(r"::proxy\b", line, re.I) and '""' not in line]


def run_in_clean_root(folder, packages):
    """Returns the folder with what the check left."""
    given, result = os.path.join(folder, "check"), os.path.join(folder, "result")
    os.mkdir(given)
    os.mkdir(result)
    data = os.path.join(stage.ROOT, "data")
    for path in (packages["ffd"], packages["libffd0"], os.path.join(data, MESH), os.path.join(data, LATTICE)):
        shutil.copy(path, given)
    with open(os.path.join(given, "check.sh"), "w", encoding="ascii") as file:
        file.write(CHECK)
    release = re.search(r"^VERSION_CODENAME=(\w+)$", open("/etc/os-release", encoding="utf-8").read(), re.M)[1]
    stage.run(["mmdebstrap", "--variant=apt", "--format=null", *proxies(),
               f"--customize-hook=copy-in {given} /",
               "--customize-hook=chroot \"$1\" sh /check/check.sh",
               f"--customize-hook=sync-out /check {result}",
               release, "-", *sources()])
    return result


def check_result(folder, ffd, findings):
    with open(os.path.join(folder, "version"), encoding="ascii") as file:
        if file.read() != stage.run([ffd, "--version"]):
            findings.append("the installed ffd says another version")
    expected = os.path.join(folder, "expected.obj")
    data = os.path.join(stage.ROOT, "data")
    stage.run([ffd, "deform", os.path.join(data, MESH), expected, "-l", os.path.join(data, LATTICE)])
    if stage.run("cmp -s out.obj expected.obj || echo differ", cwd=folder):
        findings.append("the installed ffd deforms otherwise than the one that was built here")
    with open(os.path.join(folder, "left"), encoding="utf-8") as file:
        findings += [f"left behind when it was removed: {line.strip()}" for line in file]


def main():
    stage.need("dpkg-buildpackage", "dh", "lintian", "mmdebstrap")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        # Readable for the user that apt downloads as.
        os.chmod(folder, 0o755)
        packages = build(folder)
        if sorted(packages) != sorted(PACKAGES):
            findings.append(f"built {sorted(packages)} instead of {PACKAGES}")
        version = stage.run([sys.argv[1], "--version"]).split()[1]
        findings += [f"{path} is not of version {version}" for path in packages.values() if f"_{version}-" not in path]
        needs_of_pkg_config(packages, findings)
        (changes,) = glob.glob(os.path.join(folder, "*.changes"))
        linted = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", changes], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        print(linted.stdout)
        if linted.returncode != 0:
            findings.append("lintian finds errors")
        check_result(run_in_clean_root(folder, packages), sys.argv[1], findings)
    stage.finish(len(packages), "packages", findings)


main()
