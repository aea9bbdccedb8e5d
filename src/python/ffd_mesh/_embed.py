"""Embeddings of whole meshes, as `ffd embed` makes them: what jobs take as `embedding`."""

from __future__ import annotations

import io
from typing import Any, NamedTuple, Unpack

import numpy as np
from numpy.typing import NDArray

from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, embedding_described
from ._library import lib
from ._result import Result, finish, run
from ._types import Doubles, EmbedFileOptions, EmbedOptions, names


def embed_file(source: Path, output: Path, lattice: AnyLattice, *, status_output: Path | None = None,
               **options: Unpack[EmbedFileOptions]) -> Result:
    """Finds u, v, w of all vertices of a mesh file in the lattice at rest, as `ffd embed` does, once for many jobs: they take
    output as `embedding`, and `numpy.load` reads it. Both outputs or none are written.

    output: an .npy, (N, 3) float64, NaN where there is none; vertices in the order of `positions_file`
    lattice: a `Lattice`, a path, or the text of a file as bytes; without moves, or with placeholders in them that have no
      values, it will do. status_output: an .npy, (N,) uint8, of `Status`; None: none
    options: set={"NAME": value}, snap=LENGTH or "0.001r" (jobs need the same), space="scene" | "mesh", threads=, memory=BYTES,
      strict=True, allow_extensions=["NAME"], input_format="ply", force=True (replace the outputs)
    Returns a `Result` with counts and warnings. Raises `Error`. Any number of threads may call it.
    """
    with embedding_described(source, lattice, options, names(EmbedFileOptions), ("status_output",)) as (desc, warnings):
        desc.output = library.path(output)
        if status_output is not None:
            desc.status_output = library.path(status_output)
        found, raised = run(lib.ffd_embed_run, desc)
    return finish(found, raised, warnings)


class EmbeddedBytes(NamedTuple):
    """What `embed_bytes` returns."""

    data: bytes  # what `embed_file` writes: jobs take it as `embedding`
    uvw: Doubles  # (N, 3), NaN where there is none
    status: NDArray[np.uint8]  # (N,) uint8, of `Status`
    result: Result


def embed_bytes(data: Any, lattice: AnyLattice, *, name: str, files: Files | None = None,
                **options: Unpack[EmbedOptions]) -> EmbeddedBytes:
    """`embed_file` of a mesh in memory: data, name and files as `deform_bytes` takes them; reads and writes no file."""
    memory = Memory(data, name, files)
    taken: list[Any] = []
    with embedding_described(memory, lattice, options, names(EmbedOptions), ("name", "files")) as (desc, warnings):
        desc.output, desc.status_output = b"uvw.npy", b"status.npy"
        library.sink_into(desc, taken)
        found, raised = run(lib.ffd_embed_run, desc)
    memory.reraise()
    result, made = finish(found, raised, warnings), dict(taken)
    uvw, status = (np.load(io.BytesIO(made[output])) for output in ("uvw.npy", "status.npy"))
    return EmbeddedBytes(made["uvw.npy"], uvw, status, result)
