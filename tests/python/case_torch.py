"""The deformation as a function of torch: its bits, its gradients beside differences, what it refuses; the basis as a sparse tensor.

Runs in the Python that has torch (test_package.py); without torch only what is said then is tested.
"""

import multiprocessing
import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import ffd_mesh as ffd
import numpy as np
import support

try:
    import torch
except ImportError:
    torch = None
if torch is not None:
    import ffd_mesh.torch as ffd_torch
needs_torch = unittest.skipIf(torch is None, "torch is not installed")
needs_transforms = unittest.skipIf(not hasattr(torch, "func"), "torch.func came with torch 2.0")
OUTSIDE = ({"outside": "keep"}, {"outside": "extend"}, {"outside": "extend", "falloff": 0.4})


def of(array, dtype=None, wanted=True):
    """A tensor of its own, of numbers that may be read-only."""
    return torch.tensor(np.array(array), dtype=dtype).requires_grad_(wanted)


def lattices(random):
    """Of each kind: a box, a bent volume, weights, weights that moved, a closed direction."""
    yield ffd.Lattice.box((0, 0, 0), (1, 1, 1), (4, 3, 5), (3, 1, 2))
    yield support.curved(random)
    weighted = support.curved(random, weights=True)
    yield weighted
    yield weighted.moved(weights=random.uniform(0.5, 2, weighted.size))
    yield ffd.Lattice.around(random.uniform(0, 1, (40, 3)), size=(3, 6, 4), degree=2, shape="cylinder")


def tensors(random, lattice, count=8):
    """Points in and round a lattice, and two times three sets of control points."""
    points = random.uniform(-0.3, 1.3, (count, 3))
    return points, lattice.rest + 0.1 * random.standard_normal((2, 3, *lattice.rest.shape))


class Absent(unittest.TestCase):
    def run_python(self, script):
        return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)

    def test_the_package_does_not_import_torch(self):
        done = self.run_python("import sys, ffd_mesh; sys.exit('torch' in sys.modules or hasattr(ffd_mesh, 'torch'))")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_without_torch_an_import_says_what_is_needed(self):
        old = "import types; sys.modules['torch'] = types.ModuleType('torch'); sys.modules['torch'].__version__ = '1.12.1'; "
        for before, words in (("sys.modules['torch'] = None; ", "needs torch 1.13 or later: "), (old, "needs torch 1.13 or later, not 1.12.1")):
            done = self.run_python(f"import sys; {before}import ffd_mesh.torch")
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr.splitlines()[-1], "^ImportError: ffd_mesh.torch " + words)


@needs_torch
class Values(unittest.TestCase):
    def test_results_are_those_of_arrays_to_the_bit(self):
        random = support.rng("torch bits")
        for lattice in lattices(random):
            points, Q = tensors(random, lattice, 300)
            for dtype, options in ((np.float32, OUTSIDE[0]), (np.float64, OUTSIDE[1]), (np.float64, OUTSIDE[2])):
                embedding = lattice.embed(points.astype(dtype), **options)
                wanted = [[lattice.deform(embedding, one) for one in row] for row in Q.astype(dtype)]
                found = ffd_torch.deform(lattice, embedding, of(Q.astype(dtype)))
                self.assertEqual((found.shape, found.detach().numpy().tobytes()), ((2, 3, 300, 3), np.array(wanted).tobytes()))
                one = ffd_torch.deform(lattice, embedding, of(Q[1, 2].astype(dtype)))
                self.assertEqual((one.shape, one.detach().numpy().tobytes()), ((300, 3), wanted[1][2].tobytes()))
                turned = of(Q.astype(dtype)).transpose(0, 1).flip(1)
                self.assertTrue(torch.equal(ffd_torch.deform(lattice, embedding, turned), found.transpose(0, 1).flip(1)))

    def test_the_result_has_the_type_of_the_control_points(self):
        random = support.rng("torch types")
        lattice = support.curved(random)
        points, Q = tensors(random, lattice)
        for kind in (np.float32, np.float64):
            embedding = lattice.embed(points.astype(kind))
            for dtype, array in ((torch.float32, np.float32), (torch.float64, np.float64)):
                wanted = np.empty((8, 3), array)
                lattice.deform(embedding, Q[0, 0].astype(array), out=wanted)
                found = ffd_torch.deform(lattice, embedding, of(Q[0, 0], dtype))
                self.assertEqual((found.dtype, found.detach().numpy().tobytes()), (dtype, wanted.tobytes()))
                other = ffd_torch.deform(lattice, embedding, of(Q[0, 0], dtype), of(points.astype(kind)))
                self.assertEqual(other.dtype, torch.float32 if dtype == torch.float32 and kind == np.float32 else torch.float64)
                self.assertLess((other - found).abs().max().item(), 1e-6)
        for dtype in (torch.float16, torch.bfloat16):
            low = of(Q[0], dtype)
            found = ffd_torch.deform(lattice, embedding, low, of(points, dtype))
            self.assertEqual(found.dtype, torch.float32)
            self.assertTrue(torch.equal(found, ffd_torch.deform(lattice, embedding, low.float(), of(points, dtype).float())))
            found.sum().backward()
            self.assertEqual(low.grad.dtype, dtype)

    def test_points_are_embedded_with_the_options_of_the_embedding(self):
        random = support.rng("torch points")
        for lattice in lattices(random):
            points, Q = tensors(random, lattice)
            others = random.uniform(-0.2, 1.2, (60, 3))
            for options in (*OUTSIDE, {"snap": 0.05}):
                embedding = lattice.embed(points, **options)
                wanted = lattice.deform(lattice.embed(others, **options), Q[0, 1])
                for known in (embedding, pickle.loads(pickle.dumps(embedding))):
                    found = ffd_torch.deform(lattice, known, of(Q[:, 1]), of(others, wanted=False))
                    self.assertEqual(found[0].detach().numpy().tobytes(), wanted.tobytes(), options)
        self.assertRaises(ffd.EmbeddingError, ffd_torch.deform, lattice, lattice.embed(points[:0], outside="error"), of(Q[0, 0]), of(others + 9))
        restored = ffd.Embedding.from_bytes(embedding.to_bytes(), lattice, points)
        self.assertTrue(torch.equal(ffd_torch.deform(lattice, restored, of(Q)), ffd_torch.deform(lattice, embedding, of(Q))))
        self.assertRaisesRegex(ValueError, "from_bytes does not know", ffd_torch.deform, lattice, restored, of(Q), of(others))

    def test_batches_may_be_empty(self):
        random = support.rng("torch empty")
        lattice = support.curved(random)
        points, Q = tensors(random, lattice)
        embedding = lattice.embed(points)
        for shape in ((0,), (0, 3), (3, 0, 2)):
            q, x = torch.zeros(*shape, *lattice.size, 3, requires_grad=True), of(points)
            for found in (ffd_torch.deform(lattice, embedding, q), ffd_torch.deform(lattice, embedding, q, x)):
                self.assertEqual(found.shape, (*shape, 8, 3))
                found.sum().backward()
            self.assertEqual((q.grad.shape, x.grad.abs().sum().item()), (q.shape, 0))
        q, x = of(Q), torch.zeros(0, 3, requires_grad=True)
        ffd_torch.deform(lattice, embedding, q, x).sum().backward()
        self.assertEqual((x.grad.shape, q.grad.abs().sum().item()), ((0, 3), 0))

    def test_without_gradients_nothing_is_kept(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        embedding = lattice.embed([[0.5, 0.5, 0.5]])
        self.assertFalse(ffd_torch.deform(lattice, embedding, of(lattice.rest, wanted=False)).requires_grad)
        for mode in (torch.no_grad, torch.inference_mode):
            with mode():
                self.assertFalse(ffd_torch.deform(lattice, embedding, of(lattice.rest)).requires_grad)
        with torch.autocast("cpu", dtype=torch.bfloat16):
            layer = torch.ones(2, 2, requires_grad=True)
            shift = (torch.ones(1, 2) @ layer).sum()
            self.assertEqual(shift.dtype, torch.bfloat16)
            found = ffd_torch.deform(lattice, embedding, of(lattice.rest, torch.float32) + shift)
            self.assertEqual(found.dtype, torch.float32)
        found.sum().backward()
        self.assertTrue(torch.equal(layer.grad, torch.full((2, 2), 3.0)))

    def test_what_is_refused(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        embedding, Q, x = lattice.embed([[0.5, 0.5, 0.5]]), of(lattice.rest, wanted=False), torch.zeros(2, 3)
        for kind, words, arguments in (
                (TypeError, "lattice must be an ffd_mesh.Lattice, not str", ("a.json", embedding, Q)),
                (TypeError, "embedding must be what embed returns, not Tensor", (lattice, Q, Q)),
                (ffd.InvalidError, "made with another lattice", (ffd.Lattice.box((0, 0, 0), (1, 1, 2)), embedding, Q)),
                (TypeError, "Q must be a tensor, not ndarray", (lattice, embedding, lattice.rest)),
                (TypeError, "Q must be float32 or float64, not torch.int64", (lattice, embedding, Q.long())),
                (TypeError, "Q must be float32 or float64, not torch.complex128", (lattice, embedding, Q + 0j)),
                (TypeError, "Q must be a dense tensor, not torch.sparse_coo", (lattice, embedding, Q.to_sparse())),
                (TypeError, r"Q is on the device meta: deform works on the CPU, products with basis\(\) on any", (lattice, embedding, Q.to("meta"))),
                (ValueError, r"Q must have the shape \(\.\., 4, 4, 4, 3\), not \(4, 4, 3, 4\)", (lattice, embedding, Q.transpose(2, 3))),
                (ValueError, r"Q must have the shape .* not \(4, 4, 3\)", (lattice, embedding, Q[0])),
                (TypeError, "points must be a tensor, not list", (lattice, embedding, Q, [[0, 0, 0]])),
                (TypeError, "points must be float32 or float64, not torch.int32", (lattice, embedding, Q, x.int())),
                (TypeError, "points is on the device meta", (lattice, embedding, Q, x.to("meta"))),
                (ValueError, r"points must have the shape \(N, 3\), not \(1, 2, 3\)", (lattice, embedding, Q, x[None])),
                (ValueError, "is nan, not a finite number", (lattice, embedding, Q * np.nan))):
            with self.assertRaisesRegex(kind, words) as caught:
                ffd_torch.deform(*arguments)
            self.assertNotIn("\n", str(caught.exception))

    def test_views_that_are_negated(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        Q = of(lattice.rest + 0.125, wanted=False)
        negated = torch.complex(Q, -Q).conj().imag
        self.assertTrue(negated.is_neg())
        embedding = lattice.embed([[0.5, 0.5, 0.5]])
        self.assertTrue(torch.equal(ffd_torch.deform(lattice, embedding, negated), ffd_torch.deform(lattice, embedding, Q)))


@needs_torch
class Gradients(unittest.TestCase):
    def test_they_are_those_of_differences(self):
        random = support.rng("torch gradients")
        for lattice in lattices(random):
            points, Q = tensors(random, lattice)
            for options in OUTSIDE:
                embedding = lattice.embed(points, **options)

                def moved(Q, x=None, lattice=lattice, embedding=embedding):
                    return ffd_torch.deform(lattice, embedding, Q, x)
                check = torch.autograd.gradcheck
                # All entries of the Jacobians, and then some products with them.
                self.assertTrue(check(moved, of(Q[0, 0])))
                self.assertTrue(check(lambda x, moved=moved, Q=of(Q[0, 0]): moved(Q, x), of(points)))
                self.assertTrue(check(moved, of(Q), fast_mode=True, check_forward_ad=True))
                self.assertTrue(check(moved, (of(Q[:, 1]), of(points)), fast_mode=True))
                self.assertTrue(check(moved, (of(Q[:, 1]), of(points, wanted=False)), fast_mode=True, check_forward_ad=True))
                self.assertTrue(torch.autograd.gradgradcheck(lambda Q, moved=moved: moved(Q ** 2), of(Q[:, 1]), fast_mode=True))

    def test_points_that_stay_have_the_identity(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        Q = of(lattice.rest * 2)
        x = of([[0.25, 0.5, 0.75], [3, 3, 3], [np.nan, 0, 0]])
        found = ffd_torch.deform(lattice, lattice.embed(np.zeros((0, 3))), Q, x)
        g = torch.tensor([[1.0, 2, 3], [4, 5, 6], [7, 8, 9]], dtype=torch.float64)
        found.backward(g)
        self.assertLess((x.grad - g * torch.tensor([[2.0], [1], [1]])).abs().max().item(), 1e-14)
        self.assertLess((Q.grad.sum(dim=(0, 1, 2)) - g[0]).abs().max().item(), 1e-14)

    def test_float32_gradients_are_those_of_float64_rounded(self):
        random = support.rng("torch float32")
        lattice = support.curved(random, weights=True)
        points, Q = tensors(random, lattice, 500)
        points, Q = points.astype(np.float32), Q.astype(np.float32)
        embedding = lattice.embed(points.astype(np.float64))
        g = random.standard_normal((2, 3, 500, 3)).astype(np.float32)
        grads = {}
        for dtype in (torch.float32, torch.float64):
            q, x = of(Q, dtype), of(points)
            ffd_torch.deform(lattice, embedding, q, x).backward(of(g, dtype, False))
            grads[dtype] = q.grad, x.grad
            self.assertEqual((q.grad.dtype, x.grad.dtype), (dtype, torch.float32))
        for low, high in zip(*grads.values()):
            self.assertTrue(torch.equal(low, high.float()))

    def test_they_do_not_depend_on_threads(self):
        random = support.rng("torch threads")
        lattice = support.curved(random)
        points, Q = tensors(random, lattice, 20000)
        embedding = lattice.embed(points, outside="extend")

        def grads():
            q, x = of(Q[0]), of(points)
            (ffd_torch.deform(lattice, embedding, q, x) ** 2).sum(dim=(1, 2)).prod().backward()
            return q.grad.numpy().tobytes() + x.grad.numpy().tobytes()
        before = torch.get_num_threads()
        try:
            found = set()
            for threads in (1, 2, 5):
                torch.set_num_threads(threads)
                found.add(grads())
        finally:
            torch.set_num_threads(before)
        self.assertEqual(len(found), 1)
        results = []
        workers = [threading.Thread(target=lambda: results.append(grads())) for _ in range(4)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(set(results), found)

    def test_second_ones_by_points_are_refused(self):
        random = support.rng("torch twice")
        lattice = support.curved(random)
        points, Q = tensors(random, lattice)
        embedding = lattice.embed(points)
        for of_first in (0, 1):
            q, x = of(Q[0]), of(points)
            loss = (ffd_torch.deform(lattice, embedding, q, x) ** 2).sum()
            first = torch.autograd.grad(loss, (q, x), create_graph=True)[of_first]
            for second in (q, x):
                with self.assertRaisesRegex(RuntimeError, "differentiable once"):
                    torch.autograd.grad(first.sum(), second, retain_graph=True)
        with torch.autograd.forward_ad.dual_level():
            x = torch.autograd.forward_ad.make_dual(of(points, wanted=False), of(points, wanted=False))
            with self.assertRaisesRegex(RuntimeError, "no forward derivative by points"):
                ffd_torch.deform(lattice, embedding, of(Q, wanted=False), x)

    def test_points_that_change_before_the_gradient(self):
        random = support.rng("torch changed")
        lattice = support.curved(random)
        points, Q = tensors(random, lattice)
        embedding, q, x = lattice.embed(points), of(Q), of(points)
        loss = ffd_torch.deform(lattice, embedding, q, x).sum()
        with torch.no_grad():
            x.add_(0.1)
        self.assertRaisesRegex(RuntimeError, "modified by an inplace operation", loss.backward)
        steps = []
        for _ in range(2):  # of an optimizer, which writes to the same memory
            wanted = of(x.detach().numpy())
            ffd_torch.deform(lattice, embedding, q, x).sum().backward()
            ffd_torch.deform(lattice, embedding, q, wanted).sum().backward()
            self.assertTrue(torch.equal(x.grad, wanted.grad))
            steps.append(x.grad)
            with torch.no_grad():
                x.add_(x.grad, alpha=-0.01)
            x.grad = None
        self.assertFalse(torch.equal(*steps))


@needs_torch
@needs_transforms
class Transforms(unittest.TestCase):
    def setUp(self):
        random = support.rng("torch.func")
        self.lattice = support.curved(random)
        points, Q = tensors(random, self.lattice)
        self.embedding = self.lattice.embed(points, outside="extend", falloff=0.5)
        self.Q, self.x = of(Q[0], wanted=False), of(np.stack([points, points + 0.1, points - 0.1]), wanted=False)

    def moved(self, Q, x=None):
        return ffd_torch.deform(self.lattice, self.embedding, Q, x)

    def loss(self, Q, x=None):
        return (self.moved(Q, x) ** 3).sum()

    def grads(self, Q, x):
        """By Q and x, without torch.func."""
        Q, x = Q.clone().requires_grad_(), x.clone().requires_grad_()
        return torch.autograd.grad(self.loss(Q, x), (Q, x))

    def test_vmap(self):
        vmap = torch.func.vmap
        wanted = torch.stack([torch.stack([self.moved(Q, x) for x in self.x]) for Q in self.Q])
        self.assertTrue(torch.equal(vmap(self.moved)(self.Q), self.moved(self.Q)))
        self.assertTrue(torch.equal(vmap(self.moved, in_dims=2)(self.Q.movedim(0, 2)), self.moved(self.Q)))
        self.assertTrue(torch.equal(vmap(vmap(self.moved))(self.Q[None]), self.moved(self.Q)[None]))
        self.assertTrue(torch.equal(vmap(self.moved, in_dims=(0, None))(self.Q, self.x[1]), wanted[:, 1]))
        self.assertTrue(torch.equal(vmap(self.moved, in_dims=(None, 0))(self.Q[2], self.x), wanted[2]))
        self.assertTrue(torch.equal(vmap(self.moved)(self.Q, self.x), wanted[range(3), range(3)]))
        self.assertTrue(torch.equal(vmap(lambda Q: vmap(lambda x: self.moved(Q, x))(self.x))(self.Q), wanted))

    def test_grad(self):
        func = torch.func
        wanted = [self.grads(Q, x) for Q, x in zip(self.Q, self.x)]
        for number in (0, 1):
            own = torch.stack([one[number] for one in wanted])
            for found in (torch.stack([func.grad(self.loss, number)(Q, x) for Q, x in zip(self.Q, self.x)]),
                          func.vmap(func.grad(self.loss, number))(self.Q, self.x), func.grad(lambda Q, x: func.vmap(self.loss)(Q, x).sum(), number)(self.Q, self.x)):
                self.assertLess((found - own).abs().max().item(), 1e-12)

    def test_jacobians(self):
        func = torch.func
        B = ffd_torch.basis(self.lattice, self.embedding).to_dense()
        for jacobian in (func.jacrev, func.jacfwd):
            for found in (jacobian(self.moved)(self.Q[0]), jacobian(lambda Q: self.moved(Q, self.x[0]))(self.Q[0])):
                found = found.reshape(8, 3, -1, 3)
                self.assertLess((found - torch.einsum("nm,cd->ncmd", B, torch.eye(3, dtype=B.dtype))).abs().max().item(), 1e-14)
        by_points = func.jacrev(self.moved, 1)(self.Q[0], self.x[0])
        E = self.lattice.deform(self.embedding, self.Q[0].numpy(), gradients=True).gradients
        self.assertLess((by_points[range(8), :, range(8)] - of(E) - torch.eye(3)).abs().max().item(), 1e-14)
        self.assertEqual(torch.count_nonzero(by_points.abs().sum(dim=(1, 3))).item(), 8)
        hessian = func.hessian(self.loss)(self.Q[0])
        torch.testing.assert_close(hessian, torch.autograd.functional.hessian(self.loss, self.Q[0]), rtol=1e-12, atol=1e-12)

    def test_what_is_refused(self):
        func, Q, x = torch.func, self.Q[0], self.x[0]
        for words, call in (("differentiable once", lambda: func.jacrev(func.grad(self.loss, 1), 1)(Q, x)),
                            ("differentiable once", lambda: func.jacrev(func.grad(self.loss, 0), 1)(Q, x)),
                            ("differentiable once", lambda: func.jacrev(func.grad(self.loss, 1), 0)(Q, x)),
                            ("differentiable once", lambda: func.jacfwd(func.grad(self.loss, 1), 0)(Q, x)),
                            ("no forward derivative by points", lambda: func.jvp(self.moved, (Q, x), (Q, x))),
                            ("no forward derivative by points", lambda: func.hessian(self.loss, 1)(Q, x))):
            self.assertRaisesRegex(RuntimeError, words, call)


class Variants(torch.utils.data.Dataset if torch else object):
    """Points under random control points, deformed with their gradients by who loads them."""

    def __init__(self, lattice, embedding):
        self.lattice, self.embedding = lattice, embedding

    def __len__(self):
        return 6

    def __getitem__(self, number):
        q = of(support.pushed(np.random.default_rng(number), self.lattice))
        x = of(self.embedding.points)
        moved = ffd_torch.deform(self.lattice, self.embedding, q, x)
        (moved ** 2).sum().backward()
        return moved.detach(), q.grad, x.grad


@needs_torch
class Loaders(unittest.TestCase):
    def test_workers_that_are_forked_or_spawned(self):
        random = support.rng("torch loaders")
        lattice = support.curved(random)
        data = Variants(lattice, lattice.embed(random.uniform(-0.1, 1.1, (9000, 3)).astype(np.float32), outside="extend"))
        wanted = [part.numpy().tobytes() for part in torch.utils.data.default_collate([data[number] for number in range(6)])]
        for method in ("fork", "spawn"):
            loader = torch.utils.data.DataLoader(data, batch_size=6, num_workers=2, timeout=120, multiprocessing_context=multiprocessing.get_context(method))
            (found,) = loader
            self.assertEqual([part.numpy().tobytes() for part in found], wanted, method)


@needs_torch
class Bases(unittest.TestCase):
    def setUp(self):
        # "Sparse CSR tensor support is in beta state", once
        warnings.simplefilter("ignore", UserWarning)
        self.addCleanup(warnings.resetwarnings)

    def test_they_are_those_of_arrays(self):
        random = support.rng("torch basis")
        for lattice in lattices(random):
            embedding = lattice.embed(random.uniform(-0.1, 1.1, (200, 3)), outside="extend")
            wanted = lattice.basis(embedding)
            found = ffd_torch.basis(lattice, embedding)
            self.assertEqual((found.layout, found.dtype, found.device.type, tuple(found.shape)), (torch.sparse_csr, torch.float64, "cpu", wanted.shape))
            for part, name in ((found.crow_indices(), "indptr"), (found.col_indices(), "indices"), (found.values(), "data")):
                self.assertTrue(np.array_equal(part.numpy(), getattr(wanted, name)), name)
            low = ffd_torch.basis(lattice, embedding, "cpu", torch.float32)
            self.assertTrue(np.array_equal(low.values().numpy(), wanted.data.astype(np.float32)))
        self.assertEqual(ffd_torch.basis(lattice, lattice.embed(np.zeros((0, 3)))).shape, (0, 72))

    def test_a_product_deforms_variants_to_rounding(self):
        random = support.rng("torch product")
        lattice = support.curved(random)
        points = random.uniform(0, 1, (100, 3))
        embedding = lattice.embed(points)
        for dtype, near in ((torch.float64, 1e-14), (torch.float32, 2e-6)):
            B, D = ffd_torch.basis(lattice, embedding, dtype=dtype), of(0.1 * random.standard_normal((5, *lattice.size, 3)), dtype)
            moved = of(points, dtype) + (B @ D.permute(1, 2, 3, 0, 4).reshape(-1, 15)).reshape(100, 5, 3).permute(1, 0, 2)
            wanted = ffd_torch.deform(lattice, embedding, of(lattice.rest, dtype) + D)
            self.assertLess((moved - wanted).abs().max().item(), near)
            found, = torch.autograd.grad((moved ** 2).sum(), D, retain_graph=True)
            right, = torch.autograd.grad((wanted ** 2).sum(), D)
            self.assertLess((found - right).abs().max().item(), 100 * near)

    def test_what_is_refused(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        embedding = lattice.embed([[0.5, 0.5, 0.5]])
        for kind, words, arguments in ((TypeError, "lattice must be an ffd_mesh.Lattice", (None, embedding)),
                                       (TypeError, "embedding must be what embed returns", (lattice, None)),
                                       (TypeError, "dtype must be a type of floats, not torch.int32", (lattice, embedding, None, torch.int32)),
                                       (TypeError, "dtype must be a type of floats, not float", (lattice, embedding, None, "float"))):
            self.assertRaisesRegex(kind, words, ffd_torch.basis, *arguments)


@needs_torch
class Pages(unittest.TestCase):
    def test_the_page_runs(self):
        with open(os.path.join(support.SOURCE, "data", "python.md"), encoding="utf-8") as file:
            section = re.search(r"^## Torch and JAX\n(.*?)^## ", file.read(), re.M | re.S)[1]
        blocks = re.findall(r"^```py\n(.*?)^```$", section, re.M | re.S)
        self.assertEqual(["import jax" in block for block in blocks], [False, False, True])
        names = {}
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(os.path.join(support.DATA, "models"), os.path.join(folder, "models"))
            for number, block in enumerate(blocks):
                try:
                    exec(compile(block, f"python.md, block {number}", "exec"), names)
                except ImportError as error:
                    self.assertIn("jax", str(error))


if __name__ == "__main__":
    unittest.main()
