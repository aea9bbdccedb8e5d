"""The types of arguments: words, arrays, and the options of jobs, which are the program's (data/reference.md)."""

from __future__ import annotations

import os
from typing import Any, Iterator, Literal, Mapping, Protocol, Sequence, SupportsFloat, SupportsIndex, TypedDict, Union

import numpy as np
from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]

# Arrays that are returned.
Doubles = NDArray[np.float64]
Floats = NDArray[np.floating[Any]]
# Arrays that are taken: numbers of any real type, or lists of them, with so many axes.
_Real = Union[NDArray[np.floating[Any]], NDArray[np.integer[Any]]]
Row = Union[_Real, Sequence[SupportsFloat]]
Rows = Union[_Real, Sequence[Row]]
Grid = Union[_Real, Sequence[Sequence[Sequence[SupportsFloat]]]]
ControlPoints = Union[_Real, Sequence[Sequence[Sequence[Sequence[SupportsFloat]]]]]
Indices = Union[NDArray[np.integer[Any]], Sequence[SupportsIndex]]
Triangles = Union[NDArray[np.integer[Any]], Sequence[Sequence[SupportsIndex]]]
# One for all of u, v, w or x, y, z, or three.
Counts = Union[SupportsIndex, Sequence[SupportsIndex], NDArray[np.integer[Any]]]
Degrees = Union[SupportsIndex, None, Sequence[Union[SupportsIndex, None]], NDArray[np.integer[Any]]]
Numbers = Union[SupportsFloat, Row]

Outside = Literal["keep", "extend", "error"]
Isa = Literal["auto", "scalar", "sse2", "avx2", "avx512", "neon"]
KnotWord = Literal["default", "clamped", "open", "uniform", "closed"]
KnotWords = Union[KnotWord, Sequence[KnotWord]]
Knots = Union[KnotWord, tuple[Literal["closed"], Row], Sequence[Union[KnotWord, Row, tuple[Literal["closed"], Row]]]]
Spacing = Literal["greville", "uniform"]
Shape = Literal["box", "cylinder"]
Volume = Literal["rest", "deformed"]
Direction = Literal["u", "v", "w"]
Half = Literal["u-", "u+", "v-", "v+", "w-", "w+"]
Part = Literal["rest", "deformed", "both"]
Order = Literal["uvw", "auto"]
Format = Literal["auto", "obj", "gltf", "glb", "ply", "off", "stl", "vtk", "su2", "vtu", "vtp", "vts", "msh", "foam"]
Space = Literal["scene", "mesh"]
Wrt = Literal["points", "parameters"]
Color = Literal["auto", "displacement", "status", "det", "plain"]
Side = Literal["front", "back", "left", "right", "top", "bottom", "iso"]
Axis = Literal["x", "y", "z"]
Verdict = Literal["none", "some", "unknown"]
Texts = Union[str, Sequence[str]]


class Sparse(Protocol):
    """A scipy.sparse.csr_array, as far as it is used here. Without scipy a `Csr` is returned, which has its arrays alone."""

    data: Any
    indices: Any
    indptr: Any
    shape: tuple[int, int]
    T: Any

    def __matmul__(self, other: Any) -> Any: ...

    def __getitem__(self, key: Any) -> Any: ...

    def __iter__(self) -> Iterator[Any]: ...

    def toarray(self) -> Doubles:
        """All entries, also the zeros."""

    def sum(self, axis: int | None = None) -> Any:
        """The sum of the entries."""


class ReadOptions(TypedDict, total=False):
    """How a mesh is read."""

    input_format: Format
    space: Space
    memory: int
    strict: bool
    allow_extensions: Texts


class EmbedOptions(ReadOptions, total=False):
    """Options of `embed_bytes`."""

    set: Mapping[str, Any]
    snap: float | str
    threads: int


class EmbedFileOptions(EmbedOptions, total=False):
    """Options of `embed_file`."""

    force: bool


class PositionOptions(EmbedOptions, total=False):
    """Options that positions depend on."""

    time: float
    outside: Outside
    falloff: float
    seam: str
    only: Texts
    weight: Path | bytes | Row
    isa: Isa


class JacobianOptions(PositionOptions, total=False):
    """Options of `jacobian_bytes`."""

    timeout: float


class JacobianFileOptions(JacobianOptions, total=False):
    """Options of `jacobian_file`."""

    force: bool


class MeshOptions(PositionOptions, total=False):
    """Options of all that deforms a whole mesh."""

    blocks: bool
    normals: Literal["transform", "keep", "recompute"]
    rig: Literal["keep", "follow"]
    rigid: Texts
    uniform: Texts
    embedding: Path | bytes
    fail_on: Texts
    quality: bool
    make_folders: bool


class ViewOptions(MeshOptions, total=False):
    """Options of `view_file`, `view_bytes`."""

    timeout: float


class WriteOptions(MeshOptions, total=False):
    """Options of what writes the mesh: one, or each of a batch."""

    as_morph: str
    clips: Texts
    resources: Literal["copy", "reference", "refresh"]
    output_format: Format
    force: bool
    if_changed: bool


class JobOptions(WriteOptions, total=False):
    """Options of `deform_file` and of all that do its work without writing a mesh file."""

    timeout: float
    dry_run: bool


class BatchOptions(WriteOptions, total=False):
    """Options of `batch`: those of its jobs, and those of their pictures."""

    in_place: bool
    shared_box: bool
    csv_ignore: str
    color: Color
    camera: Side | Sequence[float]
    size: tuple[int, int]
    frames: int
    animation: str
    up: Axis
    no_cage: bool


class AnimateOptions(TypedDict, total=False):
    """Options of `animate_bytes`."""

    space: Space
    memory: int
    strict: bool
    allow_extensions: Texts
    set: Mapping[str, Any]
    outside: Outside
    falloff: float
    seam: str
    snap: float | str
    only: Texts
    weight: Path | bytes | Row
    normals: Literal["transform", "keep"]
    threads: int
    isa: Isa
    timeout: float
    dry_run: bool


class AnimateFileOptions(AnimateOptions, total=False):
    """Options of `animate_file`."""

    resources: Literal["copy", "reference", "refresh"]
    force: bool
    if_changed: bool
    make_folders: bool


class EditOptions(EmbedOptions, total=False):
    """Options of `edit_file`, `edit_bytes`."""

    only: Texts
    outside: Outside
    falloff: float
    time: float
    isa: Isa
    timeout: float


class PointOptions(TypedDict, total=False):
    """Options of `Lattice.embed`, as `deform_mesh` takes them."""

    outside: Outside
    falloff: float
    snap: float
    threads: int
    isa: Isa


def names(*options: Any) -> frozenset[str]:
    """The names of the options in these dictionaries."""
    return frozenset(name for one in options for name in one.__annotations__)
