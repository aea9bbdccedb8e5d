"""Free-form deformation of points and meshes with B-spline lattices.

    lattice = ffd_mesh.Lattice.around(points, size=(6, 6, 6), degree=3)
    embedding = lattice.embed(points)
    Q = lattice.rest.copy()
    Q[5, 2, 2] += (0, 0, 0.3)
    moved = lattice.deform(embedding, Q)

Points are arrays (N, 3) of float32 or float64; control points are arrays (nu, nv, nw, 3). Failures raise `Error`; nothing is
printed.
"""

from ._animate import AnimatedBytes, Animation, animate_bytes, animate_file
from ._batch import batch
from ._cell_quality import Cells, cells
from ._chain import Blocks, Chain, ChainEmbedding
from ._convert import convert_lattice
from ._embed import EmbeddedBytes, embed_bytes, embed_file
from ._embedding import Embedding, Status
from ._errors import (ArgumentError, Cancelled, EmbeddingError, Error, ExistsError, FileError, GateError, InvalidError,
                      LimitError, OutOfMemoryError, UnmetError, UnsupportedError)
from ._facts import compare_bytes, compare_files, compare_folders, info, info_bytes
from ._fit import Fit, FittedFile, fit, fit_file
from ._jacobian import JacobianBytes, jacobian_bytes, jacobian_file
from ._jobs import (DeformedBytes, Positions, check_bytes, check_file, deform_bytes, deform_file, positions_bytes,
                    positions_file)
from ._lattice import Lattice
from ._library import lib as _lib
from ._meshes import deform_mesh
from ._plane import PlaneEmbedding, PlaneLattice
from ._result import Result
from ._schemas import schema
from ._values import Csr, Deformed, FoldBarrier, Folds, Parameter, parameters
from ._views import ViewBytes, edit_bytes, edit_file, view_bytes, view_file

__version__: str = _lib.ffd_version().decode()

__all__ = [
    "AnimatedBytes", "Animation", "ArgumentError", "Blocks", "Cancelled", "Cells", "Chain", "ChainEmbedding", "Csr", "Deformed", "DeformedBytes", "EmbeddedBytes", "Embedding", "EmbeddingError", "Error",
    "ExistsError", "FileError", "Fit", "FittedFile", "FoldBarrier", "Folds", "GateError", "InvalidError", "JacobianBytes", "Lattice", "LimitError",
    "OutOfMemoryError", "Parameter", "PlaneEmbedding", "PlaneLattice", "Positions", "Result", "Status", "UnmetError", "UnsupportedError", "ViewBytes", "animate_bytes", "animate_file", "batch", "cells", "check_bytes",
    "check_file", "compare_bytes", "compare_files", "compare_folders", "convert_lattice", "deform_bytes", "deform_file", "deform_mesh", "edit_bytes", "edit_file", "embed_bytes", "embed_file", "fit", "fit_file",
    "info", "info_bytes", "jacobian_bytes", "jacobian_file", "parameters", "positions_bytes", "positions_file", "schema",
    "view_bytes", "view_file",
]
