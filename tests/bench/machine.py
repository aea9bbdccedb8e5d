"""What the measurements were made on, and how the program was built."""

import json
import os
import platform
import re
import subprocess

# Words of a compiler's command that its result's speed hangs on.
FLAGS = re.compile(r"-(O|m|std=|flto|fsanitize|ffp|DNDEBUG)")


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or "unknown processor"


def describe():
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return (f"{processor()}, {os.cpu_count()} cores, {memory / 1e9:.0f} GB, "
            f"{platform.system()} {platform.release()}")


def build_folder(ffd):
    """The one that the program lies in; None where it is installed."""
    folder = os.path.dirname(os.path.abspath(ffd))
    while not os.path.isfile(os.path.join(folder, "meson-info", "intro-buildoptions.json")):
        if folder == os.path.dirname(folder):
            return None
        folder = os.path.dirname(folder)
    return folder


def read_json(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return json.load(file)


def build_flags(folder):
    if not folder:
        return "unknown build"
    options = {option["name"]: option["value"] for option in read_json(folder, "meson-info", "intro-buildoptions.json")}
    words = next(entry["command"].split() for entry in read_json(folder, "compile_commands.json")
                 if entry["file"].endswith("cli/main.c"))
    compiler = words[os.path.basename(words[0]) == "ccache"]
    said = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False).stdout
    flags = " ".join(word for word in words if FLAGS.match(word))
    return f"{said.splitlines()[0] if said else compiler}; buildtype {options['buildtype']}: {flags}"
