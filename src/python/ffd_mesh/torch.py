"""The deformation as a function of torch, with gradients; and its basis as a sparse tensor. Needs torch 1.13 or later.

    import ffd_mesh.torch

    moved = ffd_mesh.torch.deform(lattice, embedding, Q)
    B = ffd_mesh.torch.basis(lattice, embedding, device="cuda")

Nothing else of ffd_mesh imports torch.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np

try:
    import torch  # type: ignore[import-not-found,unused-ignore]
except ImportError as error:
    raise ImportError(f"ffd_mesh.torch needs torch 1.13 or later: {error}") from error

from ._embedding import Embedding, EmbeddingOptions
from ._lattice import Lattice

if tuple(map(int, torch.__version__.split(".")[:2])) < (1, 13):
    raise ImportError(f"ffd_mesh.torch needs torch 1.13 or later, not {torch.__version__}")

__all__ = ["basis", "deform"]

_NUMBERS = {torch.float32: np.float32, torch.float64: np.float64}
_ONCE = ("ffd_mesh.torch.deform with points that need a gradient is differentiable once: second derivatives are by Q alone, with "
         "points that need none")


def deform(lattice: Lattice, embedding: Embedding, Q: torch.Tensor, points: torch.Tensor | None = None) -> torch.Tensor:
    """Deforms the embedded points by control points Q: (.., N, 3) of Q's type, with the bits of `Lattice.deform`.

    Q: (.., nu, nv, nw, 3), float32 or float64 on the CPU, any number of batch axes; float16 and bfloat16 become float32. Weights are
       those of the lattice. The gradient by Q is linear, so that it can be differentiated again and again
    points: (N, 3), any number: embedded anew, with outside=, falloff= and snap= of the embedding; the result has the type that torch
       promotes points and Q to. The gradient by points is that of the whole map x -> x + d(x), also for points outside: those that
       stay have the identity. It can be differentiated once. None: the embedded points

    Runs with `torch.get_num_threads()` threads, which change no bit. torch.func (torch 2.0 and later): grad, vjp, jacrev, vmap; jvp and
    jacfwd by Q. Raises TypeError for another type or device of tensors, ValueError for another shape, and what `Lattice.embed` and
    `Lattice.deform` raise.
    """
    if not isinstance(lattice, Lattice):
        raise TypeError(f"lattice must be an ffd_mesh.Lattice, not {type(lattice).__name__}")
    lattice._check_same(embedding)
    Q = _checked(Q, "Q")
    shape = (*lattice.size, 3)
    if Q.shape[-4:] != shape:
        raise ValueError(f"Q must have the shape (.., {', '.join(map(str, shape))}), not {tuple(Q.shape)}")
    if points is not None:
        points = _checked(points, "points")
        if points.dim() != 2 or points.shape[1] != 3:
            raise ValueError(f"points must have the shape (N, 3), not {tuple(points.shape)}")
        if embedding._options is None:
            raise ValueError("points= needs the options of embed, which Embedding.from_bytes does not know: embed the points, or "
                             "pickle the embedding")
    moved: torch.Tensor = _Moved.apply(_Places(lattice, embedding), Q.reshape(-1, *shape), points)
    return moved.reshape(*Q.shape[:-4], *moved.shape[1:])


def basis(lattice: Lattice, embedding: Embedding, device: Any = None, dtype: torch.dtype | None = None) -> torch.Tensor:
    """`Lattice.basis`, dX/dQ, as a sparse CSR tensor (N, nu*nv*nw) on any device that torch has, with columns in Python's order.

    B @ D.reshape(-1, 3) are the displacements for offsets D. For K variants D.permute(1, 2, 3, 0, 4).reshape(-1, 3 * K) makes them
    one product. Products are torch's: equal to `deform` to rounding, not to the bit.

    device: None: the CPU; dtype: a type of floats; None: float64, the bits of `Lattice.basis`
    """
    if not isinstance(lattice, Lattice):
        raise TypeError(f"lattice must be an ffd_mesh.Lattice, not {type(lattice).__name__}")
    dtype = torch.float64 if dtype is None else dtype
    if not (isinstance(dtype, torch.dtype) and dtype.is_floating_point):
        raise TypeError(f"dtype must be a type of floats, not {dtype}")
    found = lattice.basis(embedding, threads=torch.get_num_threads())
    starts, columns, values = (torch.from_numpy(part) for part in (found.indptr, found.indices, found.data))
    # Torch that can check these wants to be told whether to.
    checks: dict[str, Any] = {"check_invariants": False} if hasattr(torch.sparse, "check_sparse_tensor_invariants") else {}
    return torch.sparse_csr_tensor(starts, columns, values.to(dtype), size=found.shape, dtype=dtype, device=values.device if device is None else device,
                                   **checks)


class _Places:
    """Where points are in a lattice: those of an embedding, or others, embedded with the options of that one."""

    def __init__(self, lattice: Lattice, embedding: Embedding) -> None:
        self.lattice = lattice
        self._embedding = embedding
        self._last: Embedding | None = None  # of other points

    def of(self, points: torch.Tensor | None) -> Embedding:
        """The embedding of points; None: those of the embedding."""
        if points is None:
            return self._embedding
        given, last = _array(points), self._last
        if last is None or not _are_same(last.points, given):
            options = cast(EmbeddingOptions, self._embedding._options)._asdict()
            self._last = last = self.lattice.embed(given, **options, threads=torch.get_num_threads())
        return last

    def fresh(self) -> _Places:
        """The same, for other points at the same time."""
        return _Places(self.lattice, self._embedding)


class _Function(torch.autograd.Function):  # type: ignore[misc,unused-ignore]
    """A function of _Places and tensors. torch.func wants forward and setup_context apart; torch before 2.0 knows one of both."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if not hasattr(torch.autograd.Function, "setup_context"):
            apart = cls.forward

            def both(ctx: Any, *inputs: Any) -> Any:
                """What torch before 2.0 calls."""
                output = apart(*inputs)
                cls.setup_context(ctx, inputs, output)
                return output
            setattr(cls, "forward", staticmethod(both))

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        """Keeps what derivatives need: all inputs but the first tensor, which they are linear in."""
        ctx.places = inputs[0]
        ctx.set_materialize_grads(False)
        ctx.save_for_backward(*inputs[2:])
        ctx.save_for_forward(*inputs[2:])

    @classmethod
    def vmap(cls, info: Any, in_dims: Any, places: _Places, *tensors: Any) -> Any:
        """One call after the other."""
        rows = [cls.apply(places.fresh(), *(tensor if dim is None else tensor.select(dim, row) for tensor, dim in zip(tensors, in_dims[1:])))
                for row in range(info.batch_size)]
        return torch.stack(rows), 0


class _Linear(_Function):
    """One that takes a batch of rows, the same for each, and points, or None."""

    @classmethod
    def vmap(cls, info: Any, in_dims: Any, places: _Places, rows: Any, points: Any) -> Any:
        """Of the same points the batch has so many more rows; other points are embedded one by one."""
        if in_dims[2] is not None:
            return super().vmap(info, in_dims, places, rows, points)
        rows = rows.movedim(in_dims[1], 0)
        found = cls.apply(places, rows.flatten(0, 1), points)
        return found.reshape(*rows.shape[:2], *found.shape[1:]), 0


class _Moved(_Linear):
    """Points moved by Q, (K, nu, nv, nw, 3): (K, N, 3)."""

    @staticmethod
    def forward(places: _Places, Q: Any, points: Any) -> Any:
        """The moved points."""
        embedding = places.of(points)
        kind = Q.dtype if points is None else torch.promote_types(Q.dtype, points.dtype)
        out = np.empty((len(Q), len(embedding), 3), _NUMBERS[kind])
        places.lattice.deform(embedding, _array(Q), out=out, threads=torch.get_num_threads())
        return torch.from_numpy(out)

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        """Keeps Q only for the derivative by points."""
        ctx.places, Q, points = inputs
        ctx.kinds = Q.dtype, output.dtype
        ctx.set_materialize_grads(False)
        ctx.save_for_backward(None if points is None else Q, points)  # Q is needed by the derivative by points
        ctx.save_for_forward(points)

    @staticmethod
    def backward(ctx: Any, g: Any) -> Any:
        """The gradients by Q and by points."""
        by_Q = by_points = None
        if g is not None:
            Q, points = ctx.saved_tensors
            if ctx.needs_input_grad[1]:
                by_Q = _Gathered.apply(ctx.places, g, points).to(ctx.kinds[0])
            if ctx.needs_input_grad[2]:
                by_points = _Turned.apply(ctx.places, g, Q, points)
        return None, by_Q, by_points

    @staticmethod
    def jvp(ctx: Any, _: Any, Q: Any, points: Any) -> Any:
        """How the moved points change with Q."""
        _refuse_forward(points)
        return _Displaced.apply(ctx.places, Q.to(ctx.kinds[1]), *ctx.saved_tensors)


class _Displaced(_Linear):
    """What points move for displacements of the control points, (K, nu, nv, nw, 3): (K, N, 3)."""

    @staticmethod
    def forward(places: _Places, D: Any, points: Any) -> Any:
        """The displacements."""
        embedding, rows = places.of(points), _array(D)
        out = np.empty((len(rows), len(embedding), 3), rows.dtype)
        for row, displacements in zip(out, rows):
            row[...] = places.lattice.basis_times(embedding, displacements, threads=torch.get_num_threads())
        return torch.from_numpy(out)

    @staticmethod
    def backward(ctx: Any, g: Any) -> Any:
        """The gradient by the displacements of the control points."""
        if ctx.needs_input_grad[2]:
            raise RuntimeError(_ONCE)
        return None, None if g is None else _Gathered.apply(ctx.places, g, *ctx.saved_tensors), None

    @staticmethod
    def jvp(ctx: Any, _: Any, D: Any, points: Any) -> Any:
        """The same function, which is linear."""
        _refuse_forward(points)
        return _Displaced.apply(ctx.places, D, *ctx.saved_tensors)


class _Gathered(_Linear):
    """The gradient by the control points of one by the points, (K, N, 3): (K, nu, nv, nw, 3)."""

    @staticmethod
    def forward(places: _Places, g: Any, points: Any) -> Any:
        """The gradient by the control points."""
        embedding, rows = places.of(points), _array(g)
        out = np.empty((len(rows), *places.lattice.size, 3), rows.dtype)
        for row, gradient in zip(out, rows):
            row[...] = places.lattice.basis_transposed(embedding, gradient, threads=torch.get_num_threads())
        return torch.from_numpy(out)

    @staticmethod
    def backward(ctx: Any, D: Any) -> Any:
        """The gradient by the gradient by the points."""
        if ctx.needs_input_grad[2]:
            raise RuntimeError(_ONCE)
        return None, None if D is None else _Displaced.apply(ctx.places, D, *ctx.saved_tensors), None

    @staticmethod
    def jvp(ctx: Any, _: Any, g: Any, points: Any) -> Any:
        """The same function, which is linear."""
        _refuse_forward(points)
        return _Gathered.apply(ctx.places, g, *ctx.saved_tensors)


class _Turned(_Function):
    """The gradient by the points at rest of one by the moved points, g (K, N, 3): g (I + dD/dx), summed over K."""

    @staticmethod
    def forward(places: _Places, g: Any, Q: Any, points: Any) -> Any:
        """The gradient by the points at rest."""
        embedding = places.of(points)
        total = np.zeros((len(embedding), 3))
        for along, moved in zip(_array(g).astype(np.float64), _array(Q)):
            found = places.lattice.deform(embedding, moved, gradients=True, threads=torch.get_num_threads())
            total += along + np.einsum("nr,nrc->nc", along, cast(Any, found.gradients))
        return torch.from_numpy(total.astype(_NUMBERS[points.dtype]))

    @staticmethod
    def backward(ctx: Any, _: Any) -> Any:
        """Is refused: it takes second derivatives of the map."""
        raise RuntimeError(_ONCE)

    @staticmethod
    def jvp(ctx: Any, *_: Any) -> Any:
        """Is refused, as backward."""
        raise RuntimeError(_ONCE)


def _checked(tensor: Any, what: str) -> torch.Tensor:
    """A tensor of float32 or float64 on the CPU."""
    if not isinstance(tensor, torch.Tensor):
        raise TypeError(f"{what} must be a tensor, not {type(tensor).__name__}")
    if tensor.layout is not torch.strided:
        raise TypeError(f"{what} must be a dense tensor, not {tensor.layout}")
    if tensor.device.type != "cpu":
        raise TypeError(f"{what} is on the device {tensor.device}: deform works on the CPU, products with basis() on any device")
    floats: torch.Tensor = tensor.float() if tensor.dtype in (torch.float16, torch.bfloat16) else tensor
    if floats.dtype not in _NUMBERS:
        raise TypeError(f"{what} must be float32 or float64, not {floats.dtype}")
    return floats


def _array(tensor: Any) -> np.ndarray:
    """The memory of a tensor, whatever it is differentiated by."""
    return cast(np.ndarray, tensor.numpy(force=True))


def _are_same(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two arrays of points are equal, to the bit."""
    kind = f"u{a.itemsize}"
    return a.dtype == b.dtype and a.shape == b.shape and np.array_equal(a.view(kind), b.view(kind))


def _refuse_forward(points: Any) -> None:
    if points is not None:
        raise RuntimeError("ffd_mesh.torch.deform has no forward derivative by points: use backward, torch.func.vjp or jacrev")
