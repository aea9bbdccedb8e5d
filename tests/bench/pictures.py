"""How long a picture of a large mesh takes, by a program of its own (picture.c)."""

import subprocess

from kernels import SPREAD

# The bar: so many times a copy of the bytes of the mesh and of the picture into memory that is new, as that of one
# picture is.
BAR = "<= 20"


def picture(bench):
    """1600 x 900 of a million triangles on one core; of fewer where the meshes of the run are small."""
    bench.table.title("Picture of 1600x900, one thread")
    path = bench.built("picture")
    if not path:
        bench.table.say(f"  picture: not built beside {bench.ffd}")
        return
    triangles = min(1000000, 2 * bench.side ** 2)
    done = subprocess.run([path, str(bench.runs), str(triangles), "1600", "900"], stdout=subprocess.PIPE, text=True,
                          check=True)
    rows = {line.split()[0]: [float(value) for value in SPREAD.findall(line)[0]] for line in done.stdout.splitlines()}
    shown = {"copy": "copy of its bytes, new memory", "copy-again": "copy of its bytes, the same memory"}
    copy = [bench.table.add(what, [1000 * value for value in rows[name]], "ms") for name, what in shown.items()][0]
    bench.table.add(f"{triangles} triangles", [1000 * value for value in rows["picture"]], "ms", copy, BAR)
