"""How positions of meshes follow control points or placeholders, as `ffd jacobian` tells it."""

from __future__ import annotations

import ctypes
from typing import Any, Sequence

from . import _library as library
from ._description import AnyLattice, Path, described
from ._library import lib
from ._result import plain


def jacobian_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice], *, by: str = "points",
                  components: bool = False, of: int | None = None, times: Path | None = None, transposed: Path | None = None,
                  check: bool = False, **options: Any) -> dict[str, Any]:
    """Writes the derivative of a file's positions, as `ffd jacobian` does: by control points, u fastest, or by="parameters", the
    placeholders of their moves. Returns rows, columns, entries, vertices, moving, and with check worst.

    output: .npz (scipy.sparse.load_npz), .mtx or .npy. times, transposed: an .npy that is multiplied instead, output an .npy
    of: the lattice of several, from 0; None: the last. options: those of `deform_file` that positions depend on, and force
    """
    desc, result = library.filled("ffd_jacobian_desc"), library.empty("ffd_jacobian_result")
    desc.output, desc.by = library.path(output), library.number_of("ffd_jacobian_by", by, "by")
    desc.components, desc.check = bool(components), bool(check)
    if of is not None:
        desc.of = library.integer(of, "of")
    desc.times, desc.transposed = (None if path is None else library.path(path) for path in (times, transposed))
    with described(source, lattices, options) as (job, _):
        desc.job = ctypes.pointer(job)
        library.call(lib.ffd_jacobian_run, ctypes.byref(desc), ctypes.byref(result))
    found = plain(result)
    del found["struct_size"]
    return found if check else {name: value for name, value in found.items() if name != "worst"}
