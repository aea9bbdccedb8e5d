"""Jobs that deform or check meshes, like the program `ffd`."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Sequence, Unpack

import numpy as np

from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, described
from ._library import Progress, lib
from ._result import Result, beside, finish, run
from ._types import Doubles, JobOptions


def deform_file(source: Path, output: Path | None, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice],
                *, progress: Progress | None = None, **options: Unpack[JobOptions]) -> Result:
    """Deforms a mesh file, as `ffd deform` does. The output is complete or absent.

    source, output: paths; output None: in place
    lattices: a `Lattice`, a path, or the text of a lattice file as bytes; or a list of these, applied in order. For a glTF also
      a dict {name: lattice}: each makes a morph target of that name, and clips=["NAME: TIME TARGET=WEIGHT, .."] animate them
    options, as in the program (data/reference.md):
      set={"NAME": value}, time=SECONDS (of lattices with keys), outside="keep" | "extend" | "error", falloff=, snap=LENGTH or "0.001r", blocks=True,
      seam="C1" (hold the faces that the mesh cuts, so that it joins the rest smoothly) or "C2:u-,v+" or "C0:all",
      normals="transform" | "keep" | "recompute", as_morph="NAME", only=["node:NAME"], embedding="uvw.npy" or its bytes,
      rigid=["node:Wheel", "joint:NAME", "component"] (parts that move as one piece), uniform= (likewise, with a scale each),
      weight="FILE.npy" | "attribute:NAME" | "color:r" | "joint:NAME" | "property:NAME", "1-.." of one, or an array (how much of the
      displacement each vertex takes),
      fail_on=["folds", "tear=0.1"], quality=True (fills the figures of `check_file`), space="scene" | "mesh",
      resources="copy" | "reference" | "refresh", rig="keep" | "follow", force=True (replace the output), if_changed=True, dry_run=True,
      make_folders=True (those of output), threads=, memory=BYTES, strict=True, allow_extensions=["NAME"], input_format="ply", output_format="glb", isa="auto",
      timeout=SECONDS (a job that takes longer raises an `Error`, and writes nothing)
    progress: called from time to time with the finished fraction, 0 to 1; returning False ends the job, which writes nothing and
      raises `Cancelled`. Its exceptions do the same, and are passed on
    Raises `Error`. Threads may call it at the same time.
    """
    with described(source, lattices, options, own=("progress",)) as (desc, warnings):
        if output is None:
            desc.in_place = True
        else:
            desc.output = library.path(output)
        with library.progress_into(desc, progress):
            found, raised = run(lib.ffd_deform_run, desc)
    return finish(found, raised, warnings)


class DeformedBytes(NamedTuple):
    """What `deform_bytes` returns."""

    data: bytes  # the mesh
    files: dict[str, bytes]  # further files by name: buffers, copied images and material libraries
    result: Result


def deform_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice], *, name: str,
                 output: str | None = None, files: Files | None = None, **options: Unpack[JobOptions]) -> DeformedBytes:
    """Like `deform_file`, for a mesh in memory, with the same bytes as result; reads and writes no files.

    data: bytes, or an object with a buffer (bytearray, memoryview, array)
    name: of the mesh; its ending determines the format, "points" is one of OpenFOAM
    output: name of the result; None: the same; another ending converts it
    files: the files that the mesh refers to (.bin, images, .mtl; faces, owner, .. of OpenFOAM): a dict of bytes by name, relative to the mesh; or a function
      that takes a name and returns bytes, or None if the file is missing. Its exceptions are passed on
    options: those of `deform_file`, except force and resources
    """
    memory = Memory(data, name, files)
    taken: list[Any] = []
    with described(memory, lattices, options, own=("name", "output", "files")) as (desc, warnings):
        desc.output = library.path(name if output is None else output)
        library.sink_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    memory.reraise()
    result = finish(found, raised, warnings)
    return DeformedBytes(taken[-1][1] if taken else b"", beside(taken, name if output is None else output), result)


def check_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, files: Files | None = None,
                **options: Unpack[JobOptions]) -> Result:
    """Like `check_file`, for a mesh in memory. data, name, files: as in `deform_bytes`."""
    memory = Memory(data, name, files)
    with described(memory, lattices, options, own=("name", "files")) as (desc, warnings):
        found, raised = run(lib.ffd_check_run, desc)
    memory.reraise()
    return finish(found, raised, warnings)


def check_file(source: Path, lattices: AnyLattice | Sequence[AnyLattice], **options: Unpack[JobOptions]) -> Result:
    """Does everything that `deform_file` does except writing, and computes all figures: folds, flipped faces, torn edges, ..

    lattices, options: as in `deform_file`. With fail_on it may raise `GateError`, which has the result.
    """
    with described(source, lattices, options) as (desc, warnings):
        found, raised = run(lib.ffd_check_run, desc)
    return finish(found, raised, warnings)


class Positions(NamedTuple):
    """What `positions_file` and `positions_bytes` return."""

    points: Doubles  # (N, 3)
    result: Result


def positions_file(source: Path, lattices: AnyLattice | Sequence[AnyLattice], **options: Unpack[JobOptions]) -> Positions:
    """Computes the deformed positions of a mesh file, without writing it. They are a row of `ffd batch --positions`.

    All vertices are returned, in the order of `ffd embed`, in the space of the scene (space="mesh": each mesh's own), not rounded
    to the file's number type. For a glTF this is the stored shape, without morph targets and animations. Vertices of a node
    whose matrix has no inverse are NaN.

    lattices, options: as in `deform_file`, except the options for outputs
    """
    taken: list[Any] = []
    with described(source, lattices, options) as (desc, warnings):
        library.positions_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    return Positions(_points(taken), finish(found, raised, warnings))


def positions_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, files: Files | None = None,
                    **options: Unpack[JobOptions]) -> Positions:
    """Like `positions_file`, for a mesh in memory. data, name, files: as in `deform_bytes`."""
    memory = Memory(data, name, files)
    taken: list[Any] = []
    with described(memory, lattices, options, own=("name", "files")) as (desc, warnings):
        library.positions_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    memory.reraise()
    return Positions(_points(taken), finish(found, raised, warnings))


def _points(taken: list[Any]) -> Doubles:
    """The positions that the library has passed last, (N, 3); empty for a job that has failed before."""
    return np.frombuffer(taken[-1], np.float64).reshape(-1, 3) if taken and len(taken[-1]) else np.empty((0, 3))
