"""What the page of `ffd edit` takes in a browser: a step of a drag beside a redraw, and memory beside the page's file."""

import json
import os
import shutil
import subprocess

import meshes

HERE = os.path.dirname(os.path.abspath(__file__))
STEPS = 9


def edits(bench):
    """200,000 vertices (side 447) and 8^3 control points at the default size; Chromium draws without a graphics card."""
    side, node, browser = max(8, int(bench.side * 0.447)), shutil.which("node"), shutil.which("chromium")
    packages = os.environ.get("FFD_NODE")
    if not (node and browser and packages):
        bench.table.say("\nThe page of ffd edit: FFD_NODE, node or Chromium is not there")
        return
    bench.table.title(f"The page of ffd edit ({side * side:,} vertices, 8^3)")
    source, page = bench.path("edit.obj"), bench.path("edit.html")
    bench.mesh("edit.obj", meshes.write_obj, side)
    subprocess.run([bench.ffd, "edit", source, "--size", "8,8,8", "-o", page, "--quiet"], check=True)
    done = subprocess.run([node, os.path.join(HERE, "edit_page.mjs"), packages, browser, page, str(max(3, min(STEPS, bench.runs)))], check=True,
                          capture_output=True, text=True)
    found = json.loads(done.stdout)
    redraw = bench.table.add("redraw", found["redraw"], "ms")
    bench.table.add("a step of a drag", found["step"], "ms", redraw, "<= 2")
    size = bench.table.add("size of the page", [os.path.getsize(page) / 1e6], "MB")
    bench.table.add("memory of its process", [found["memory"] / 1e6], "MB", size, "<= 6")
