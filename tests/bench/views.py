"""What textures add to pages and pictures of a large mesh: beside those of the same mesh without any, in turns."""

import os

import meshes
import programs
from table import Row

IMAGES, PIXELS = 4, 1024


def look(bench, source, target, *options):
    return programs.Command([bench.ffd, "view", source, "-o", bench.path(target), "--color", "plain", "--quiet", *options,
                             *(["--threads", str(bench.threads)] if bench.threads else [])], bench.path(target))


def beside_grey(bench, name, target, copy, bar, *options):
    """copy: of the images, which is added to the grey one; or None."""
    grey, textured = (look(bench, bench.path(source), target, *options) for source in ("grey.gltf", "textured.gltf"))
    samples = programs.in_turns([grey, textured] + ([copy] if copy else []), bench.runs)
    seconds = [sample.seconds for sample in samples]
    both = [sum(turn) for turn in zip(seconds[0], *seconds[2:])]
    bench.table.add(f"{name}: grey", [1000 * value for value in seconds[0]], "ms")
    beside = Row(f"{name}: grey" + (", and a copy of the images" if copy else ""), [1000 * value for value in both], "ms")
    bench.table.add(f"{name}: textured", [1000 * value for value in seconds[1]], "ms", beside, bar)


def views(bench):
    """Of a million triangles at the default size. A page without --full is simplified first."""
    side = max(2, int(bench.side * 0.708))
    triangles = 2 * (side - 1) ** 2
    bench.table.title(f"Pages and pictures with textures, {triangles:,} triangles")
    bench.mesh("grey.gltf", meshes.write_textured, side, 0, 0)
    bench.mesh("textured.gltf", meshes.write_textured, side, IMAGES, min(PIXELS, bench.side))
    with open(bench.path("images"), "wb") as file:
        for i in range(IMAGES):
            with open(bench.path(f"image-{i}.png"), "rb") as image:
                file.write(image.read())
    copy = bench.copy(bench.path("images"))
    beside_grey(bench, "page, all vertices", "view.html", copy, "<= 1.5", "--full")
    beside_grey(bench, "page", "view.html", copy, "<= 1.5")
    beside_grey(bench, "picture", "view.png", None, "<= 1.3")
    os.remove(bench.path("images"))
