"""The programs that the tests run scripts in: Debian's Blender, and the module bpy of the pinned wheels in an environment of its own."""

import glob
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SCRIPTS = os.path.join(ROOT, "data", "blender")
WHEELS = os.environ.get("FFD_BLENDER_WHEELS") or os.path.join(ROOT, ".build-test", "blender")
PROGRAM = "/usr/bin/blender"  # Debian's
SECONDS = 300


def skip(what, why):
    print(f"SKIP: {what}: {why}")
    sys.exit(77)


class Blender:
    """command: what stands before a scene and a script"""

    def __init__(self, name, command):
        self.name, self.command = name, command

    def run(self, folder, *scripts, scene=None, arguments=()):
        """The finished process, which has run the scripts one after the other. A variable of Python, or a Python that stands before Debian's
        in PATH, would lead Blender's to other modules."""
        words = [*self.command[1:], *([scene] if scene else [])]
        if self.command[0] == PROGRAM:
            words += ["--python-exit-code", "1"] + [word for script in scripts for word in ("-P", script)]
        else:
            words += scripts
        return self.given(folder, *words, "--", *arguments)

    def given(self, folder, *words):
        """The finished process of these words."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        environment |= {"PATH": "/usr/bin:/bin", "HOME": folder, "PWD": folder, "PYTHONDONTWRITEBYTECODE": "1", "BLENDER_USER_RESOURCES": os.path.join(folder, "resources")}
        return subprocess.run([self.command[0], *words], cwd=folder, env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              timeout=SECONDS, check=False)


def debian():
    """Debian's, or None."""
    return Blender("Debian's Blender", [PROGRAM, "-b", "--factory-startup"]) if os.path.exists(PROGRAM) else None


def wheel(folder):
    """bpy in an environment that is made in the folder, or None where its wheels were not fetched or are for another Python."""
    if not glob.glob(os.path.join(WHEELS, "bpy-*.whl")):
        return None
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    python = os.path.join(folder, "bin", "python")
    tried = subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-compile", "--disable-pip-version-check", "--require-hashes",
                            "--find-links", WHEELS, "-r", os.path.join(HERE, "requirements.txt")], capture_output=True, text=True, check=False)
    if tried.returncode != 0 and "No matching distribution" in tried.stderr:
        return None
    if tried.returncode != 0:
        sys.exit(tried.stderr)
    return Blender("bpy", [python, os.path.join(HERE, "wheel.py")])
