"""What the rule tests share: the project's files, and how a test ends."""

import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKIPPED = 77


def is_build_folder(name):
    return name.startswith(("build", ".build")) or name == ".git"


def files():
    """Paths, relative to the root, of the files that are or would be in the repository."""
    try:
        listed = subprocess.run(
            ["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            capture_output=True, check=True).stdout.decode()
        paths = [path for path in listed.split("\0") if path]
    except (OSError, subprocess.CalledProcessError):  # a release tarball, or no git
        paths = []
        for folder, folders, names in os.walk(ROOT):
            if folder == ROOT:
                folders[:] = [name for name in folders if not is_build_folder(name)]
            if folder == os.path.join(ROOT, "subprojects"):
                folders[:] = ["packagefiles"]  # others are sources of other projects
            folders[:] = [name for name in folders if name != "__pycache__"]
            paths += [os.path.relpath(os.path.join(folder, name), ROOT) for name in names]
    return sorted(path for path in paths if os.path.isfile(os.path.join(ROOT, path)))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def finish(checked, what, findings):
    """Ends the test: prints the findings; to have checked nothing is a failure too."""
    for finding in findings:
        print(finding)
    print(f"{checked} {what} checked, {len(findings)} findings")
    sys.exit(1 if findings or checked == 0 else 0)
