#!/usr/bin/env python3
"""What `ffd` takes, beside plain copies of the same bytes and what others take that are installed: a table of medians
with their spread, and of the bars that they are to reach.

    bench.py --ffd PATH [--runs 5] [--side 1000] [--jobs 1000] [--threads N] [--only SUBJECT...] [--large GB]
             [--blender PATH] [--python PATH] [--static PATH] [--folder DIR] [--csv FILE]

The meshes are made first (at the default size a GLB of 48 MB and an OBJ of v, vt, vn and quads of about 160 MB).
What is compared is run in turns. Time is wall-clock, memory the largest resident set of the process.
"""

import argparse
import os
import shutil
import tempfile

import authoring
import batches
import edits
import fits
import jobs
import kernels
import lattices
import machine
import meshes
import peers
import pictures
import programs
import pythons
import table
import views

SUBJECTS = {
    "start": jobs.start,
    "static": jobs.static,
    "glb": jobs.glb,
    "sizes": jobs.sizes,
    "blocks": jobs.blocks,
    "obj": jobs.obj,
    "peers": peers.peers,
    "attributes": jobs.attributes,
    "weights": jobs.weights,
    "threads": jobs.threads,
    "inversion": jobs.inversion,
    "tears": jobs.tears,
    "seams": jobs.seams,
    "splats": jobs.splats,
    "authoring": authoring.authoring,
    "formats": authoring.formats,
    "animation": authoring.animation,
    "fits": fits.fits,
    "displacement": kernels.displacement,
    "embedding": kernels.embedding,
    "arrays": kernels.arrays,
    "python": pythons.calls,
    "picture": pictures.picture,
    "views": views.views,
    "edits": edits.edits,
    "batch": batches.batch,
    "sweep": batches.sweep,
    "positions": batches.positions,
}


class Bench:
    """What the subjects share: what they were asked for, a folder, its meshes and lattices, and the table."""

    def __init__(self, arguments, folder):
        self.ffd, self.blender, self.large = arguments.ffd, arguments.blender, arguments.large
        self.python, self.static = arguments.python, arguments.static
        self.runs, self.side, self.jobs, self.threads = (arguments.runs, arguments.side, arguments.jobs,
                                                         arguments.threads)
        self.build, self.folder, self.table = machine.build_folder(arguments.ffd), folder, table.Table()
        self.lattices = {kind: lattices.write_kind(self.path(kind + ".json"), kind) for kind in lattices.RESTS}

    def path(self, name):
        return os.path.join(self.folder, name)

    def built(self, name):
        """A program that lies in the build folder beside ffd; None where it does not."""
        path = self.build and os.path.join(self.build, "tests", "bench", name)
        return path if path and os.path.isfile(path) else None

    def mesh(self, name, write, *arguments):
        """The path of a mesh, which is made when it is first asked for."""
        path = self.path(name)
        if not os.path.exists(path):
            meshes.make(path, write, *arguments)
        return path

    def glb(self):
        return self.mesh("in.glb", meshes.write_glb, self.side)

    def obj(self):
        return self.mesh("in.obj", meshes.write_obj, self.side)

    def deform(self, source, lattice, *options, target=None, threads=0):
        target, threads = target or self.path("out" + os.path.splitext(source)[1]), threads or self.threads
        return programs.Command([self.ffd, "deform", source, target, "-l", lattice, "--quiet", *options,
                                 *(["--threads", str(threads)] if threads else [])],
                                None if target == "-" else target)

    def copy(self, source):
        target = self.path("copy")
        return programs.Command(["dd", "if=" + source, "of=" + target, "bs=64M"], target)


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ffd", required=True)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--side", type=int, default=1000, help="the mesh has side x side vertices")
    parser.add_argument("--jobs", type=int, default=1000, help="of a batch")
    parser.add_argument("--threads", type=int, default=0, help="0: all cores")
    parser.add_argument("--only", nargs="+", choices=SUBJECTS, default=list(SUBJECTS), metavar="SUBJECT",
                        help=", ".join(SUBJECTS))
    parser.add_argument("--large", type=float, metavar="GB", help="also an OBJ of this many gigabytes")
    parser.add_argument("--blender", metavar="PATH", help="compare Blender too")
    parser.add_argument("--python", metavar="PATH", help="a Python that has ffd_mesh")
    parser.add_argument("--static", metavar="PATH", help="compare the static program too")
    parser.add_argument("--folder", help="where the files are made (default: a temporary folder)")
    parser.add_argument("--csv", metavar="FILE", help="the table, with the values of all runs (of the kernels: least, median, greatest)")
    arguments = parser.parse_args()
    for program in (arguments.ffd, arguments.blender, arguments.static):
        if program and not shutil.which(program):
            parser.error(f"{program}: no such program")
    return arguments


def main():
    arguments = parse()
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        bench = Bench(arguments, folder)
        bench.table.say(machine.describe())
        bench.table.say(f"{machine.build_flags(bench.build)}; threads: {bench.threads or 'all'}; runs: {bench.runs}")
        bench.table.head()
        try:
            for name in arguments.only:
                SUBJECTS[name](bench)
            if bench.large:
                jobs.large(bench)
        finally:
            if arguments.csv:
                bench.table.save(arguments.csv)


main()
