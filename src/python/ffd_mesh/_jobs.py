"""Jobs that deform meshes, as the program `ffd` does them."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Sequence

import numpy as np

from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, described
from ._library import lib
from ._result import Result, beside, finish, run


def deform_file(source: Path, output: Path | None, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice],
                **options: Any) -> Result:
    """Deforms a mesh file as `ffd deform` does; the output is complete or absent.

    source, output: paths; output None: in place. lattices: a `Lattice`, a path, or the text of a file as bytes; or several, in
      their order; of a glTF also a dict of names: each makes the morph target of its name, and
      clips=["NAME: TIME TARGET=WEIGHT, .."] animate these
    options, as those of the program (data/reference.md):
      set={"NAME": value}, outside="keep" | "extend" | "error", falloff=, snap=LENGTH or "0.001r", blocks=True,
      normals="transform" | "keep" | "recompute", as_morph="NAME", only=["node:NAME"], embedding="uvw.npy" or its bytes,
      fail_on=["folds", "tear=0.1"], quality=True (fills the figures of `check_file`), space="scene" | "mesh",
      resources="copy" | "reference", rig="keep" | "follow", force=True (replace the output), if_changed=True, dry_run=True, threads=,
      memory=BYTES, strict=True, allow_extensions=["NAME"], input_format="ply", output_format="glb", isa="auto"
    """
    with described(source, lattices, options) as (desc, warnings):
        if output is None:
            desc.in_place = True
        else:
            desc.output = library.path(output)
        found, raised = run(lib.ffd_deform_run, desc)
    return finish(found, raised, warnings)


class DeformedBytes(NamedTuple):
    """What `deform_bytes` returns."""

    data: bytes  # the mesh
    files: dict[str, bytes]  # those beside it, by their names: buffers, copies of images and material libraries
    result: Result


def deform_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice], *, name: str,
                 output: str | None = None, files: Files | None = None, **options: Any) -> DeformedBytes:
    """Deforms a mesh in memory as `deform_file` does a file, to the same bytes; reads and writes no file.

    data: bytes, or what has them (bytearray, memoryview, an array); name: that of the mesh, whose ending says the format
    output: the name of the result, None: the same; another ending converts it
    files: what the mesh names (.bin, images, .mtl): a dict of names, relative to the mesh, or a function of a name that returns
      bytes, or None for a file that is not there; what it raises is raised
    options: those of `deform_file` but for in place, force and resources
    """
    memory, taken = Memory(data, name, files), []
    with described(memory, lattices, options) as (desc, warnings):
        desc.output = library.path(name if output is None else output)
        library.sink_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    memory.reraise()
    result = finish(found, raised, warnings)
    return DeformedBytes(taken[-1][1] if taken else b"", beside(taken, name if output is None else output), result)


def check_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, files: Files | None = None,
                **options: Any) -> Result:
    """`check_file` of a mesh in memory, as `deform_bytes` takes it."""
    memory = Memory(data, name, files)
    with described(memory, lattices, options) as (desc, warnings):
        found, raised = run(lib.ffd_check_run, desc)
    memory.reraise()
    return finish(found, raised, warnings)


def check_file(source: Path, lattices: AnyLattice | Sequence[AnyLattice], **options: Any) -> Result:
    """Everything that `deform_file` does but the writing, with all figures: folds, flipped faces, torn edges, .. Options as
    there; fail_on raises `GateError`, which has the result."""
    with described(source, lattices, options) as (desc, warnings):
        found, raised = run(lib.ffd_check_run, desc)
    return finish(found, raised, warnings)


class Positions(NamedTuple):
    """What `positions_file` and `positions_bytes` return."""

    points: np.ndarray  # (N, 3) float64
    result: Result


def positions_file(source: Path, lattices: AnyLattice | Sequence[AnyLattice], **options: Any) -> Positions:
    """The deformed positions of a mesh file, which is read and not written; rows of `ffd batch --positions` are these.

    Vertices are in the order of `ffd embed`, in the space of the scene (space="mesh": of their own), not rounded to the file's
    numbers; also those that stay. Of a glTF they are the shapes that it stores, without weights of morph targets or an animation.
    A vertex of a node whose matrix has no inverse is NaN. lattices, options: as `deform_file` has them, but for those of outputs.
    """
    taken: list[Any] = []
    with described(source, lattices, options) as (desc, warnings):
        library.positions_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    return Positions(_points(taken), finish(found, raised, warnings))


def positions_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, files: Files | None = None,
                    **options: Any) -> Positions:
    """`positions_file` of a mesh in memory, as `deform_bytes` takes it."""
    memory, taken = Memory(data, name, files), []
    with described(memory, lattices, options) as (desc, warnings):
        library.positions_into(desc, taken)
        found, raised = run(lib.ffd_deform_run, desc)
    memory.reraise()
    return Positions(_points(taken), finish(found, raised, warnings))


def _points(taken: list[Any]) -> np.ndarray:
    """What the library has handed over last; a job that has failed before has none."""
    return np.frombuffer(taken[-1], np.float64).reshape(-1, 3) if taken and len(taken[-1]) else np.empty((0, 3))
