#!/usr/bin/env python3
"""Where things lie: which files are C++, that every source belongs to a target, what stands at the top, that
memory is asked for in one place, and that nothing tells of the place where the project was written.

    test_sources.py BUILD-FOLDER
"""

import json
import os
import re
import sys

import tree

TOP = {
    ".ci", ".clang-format", ".editorconfig", ".gitattributes", ".github", ".gitignore", ".pre-commit-hooks.yaml", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE",
    "README.md", "data", "doc", "include", "meson.build", "meson_options.txt", "pyproject.toml", "src", "subprojects", "tests",
}

# C++ is for adapters to C++ libraries, behind a C header.
CPP = [r"src/base/(memory/process_operators|system/exceptions)\.cpp", r"src/(io/(gltf/read|openmesh)|mesh/meshopt)/\w+\.cpp"]

# Put together here so that this file does not hold them itself; * after a word: a whole word only.
WORDS = ["/wo" "rk/", "/ro" "ot/", "/ho" "me/", "../sha" "red", "cla" "ude", "anthro" "pic", "open" "ai",
         "chat" "gpt", "sub" "agent", "CE" "O*", "registry." "npmjs", "deb.deb" "ian.org", "pypi" ".org",
         "co-auth" "ored-by"]
# The one place that looks for sample models in a folder beside the checkout.
WORDS_ALLOWED = {("tests/run.sh", "../sha" "red")}

ALLOCATION = re.compile(r"(?<![\w.>])(malloc|calloc|realloc|aligned_alloc|strdup|strndup)\s*\(")


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)


def find_words(path):
    with open(os.path.join(tree.ROOT, path), "rb") as file:
        text = file.read().decode("latin-1")
    for word in WORDS:
        pattern = r"\b" + re.escape(word[:-1]) + r"\b" if word.endswith("*") else re.escape(word)
        flags = 0 if word.endswith("*") else re.I
        # Pictures and models are not text: a match of a few bytes there is chance.
        if path.endswith((".png", ".glb", ".bin")) and len(word) < 8:
            continue
        if re.search(pattern, text, flags) and (path, word) not in WORDS_ALLOWED:
            yield f"{path}: holds '{word}'"


def sources_of_targets(build):
    with open(os.path.join(build, "meson-info", "intro-targets.json"), encoding="utf-8") as file:
        targets = json.load(file)
    root = os.path.realpath(tree.ROOT)
    return {os.path.relpath(os.path.realpath(source), root)
            for target in targets for group in target["target_sources"] for source in group.get("sources", [])}


def main():
    paths = tree.files()
    findings = [f"{name}: not expected at the top level" for name in sorted({p.split("/")[0] for p in paths} - TOP)]
    listed, runner = sources_of_targets(sys.argv[1]), tree.read("tests/run.sh")
    for path in paths:
        findings += find_words(path)
        if re.search(r"\.(cc|cxx|hh|hpp|hxx)$", path) and not path.startswith("subprojects/"):
            findings.append(f"{path}: C++ files end in .cpp, headers in .h")
        if path.startswith("src/"):
            if path.endswith(".cpp") and not any(re.fullmatch(pattern, path) for pattern in CPP):
                findings.append(f"{path}: C++ outside the adapters")
            # The program sees the public headers only.
            if path.endswith((".c", ".h")) and not path.startswith(("src/base/memory/memory.", "src/base/windows/", "src/cli/")):
                for match in ALLOCATION.finditer(without_comments(tree.read(path))):
                    findings.append(f"{path}: {match.group(1)} instead of base/memory/memory.h")
        # src/python is built by the option python only, src/wasm by emscripten only, others for Windows or macOS only. The runner compiles what it links every program with.
        if path.endswith((".c", ".cpp")) and path.startswith(("src/", "tests/")) and path not in listed and \
                not path.startswith(("src/python/", "src/wasm/", "src/base/macos/", "src/base/windows/", "tests/windows/")) and not path.endswith("_windows.c") and path not in runner:
            findings.append(f"{path}: part of no target")
    tree.finish(len(paths), "files", findings)


main()
