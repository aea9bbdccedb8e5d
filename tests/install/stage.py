"""What the tests of the installed program share: a copy of what `meson install` puts down, and how commands run."""

import json
import os
import re
import shutil
import subprocess
import sys

for other in ("rules", "readme"):
    sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), other))
from test_readme import block, blocks, pages
from tree import ROOT, files, finish, read, skip

VERSION = re.search(r'^#define FFD_VERSION "(.*)"$', read("include/ffd/version.h"), re.M)[1]
# What of it programs are linked with.
ABI = VERSION.rsplit(".", 1)[0]
# From the folder of libraries.
MODULES = [f"ffd-{ABI}/ffd-{name}.so" for name in ("deflate", "draco", "image", "meshopt", "openmesh", "tinygltf")]


def need(*tools):
    """Skips the test where a program is not there."""
    for tool in tools:
        if not shutil.which(tool):
            skip(f"{tool} is not there")


def run(command, **more):
    """Runs a command (a list, or a line for sh); returns its stdout. A failure ends the test, with all that was said."""
    shell = isinstance(command, str)
    done = subprocess.run(["sh", "-eu", "-c", command] if shell else command, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
                          check=False, **more)
    if done.returncode != 0:
        print(command if shell else " ".join(command))
        print(done.stdout[-20000:] + done.stderr[-20000:])
        sys.exit(f"exit {done.returncode} from the command above")
    return done.stdout


def readme(name):
    """The commands of the pages' block ```sh NAME."""
    return block(pages(ROOT), name)


def copy_source(target):
    """A copy of the files that are or would be in the repository; returns target."""
    for path in files():
        os.makedirs(os.path.dirname(os.path.join(target, path)), exist_ok=True)
        shutil.copy(os.path.join(ROOT, path), os.path.join(target, path), follow_symlinks=False)
    return target


class Stage:
    """A build installed below a folder (DESTDIR)."""

    def __init__(self, build, root):
        run(["meson", "install", "-C", build, "--no-rebuild", "--destdir", root])
        self.root = root
        self.options = {option["name"]: option["value"]
                        for option in json.loads(run(["meson", "introspect", "--buildoptions", build]))}

    def path(self, option, *more):
        """Where a folder of Meson's ("bindir") lies now."""
        return os.path.join(self.root + self.options["prefix"], self.options[option], *more)

    def environment(self):
        """In which programs are built with the installed library and run with it."""
        libraries = self.path("libdir")
        return dict(os.environ, PKG_CONFIG_PATH=os.path.join(libraries, "pkgconfig"), LD_LIBRARY_PATH=libraries,
                    PATH=self.path("bindir") + os.pathsep + os.environ["PATH"], PYTHONDONTWRITEBYTECODE="1")


def commands(ffd):
    """Command -> the text of its help; "" -> the overview."""
    texts = {"": run([ffd, "help"])}
    for line in texts[""].splitlines():
        name = line[len("  ffd "):].split("  ")[0]
        if line.startswith("  ffd ") and name not in ("help", "--version"):
            texts[name] = run([ffd, "help", *name.split()])
    if len(texts) < 2:
        sys.exit("ffd help lists no commands")
    return texts

