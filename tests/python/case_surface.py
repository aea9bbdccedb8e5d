"""What the package offers is what the headers and the pages have: declarations, options, the page, the examples."""

import ast
import glob
import importlib.metadata
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support
from ffd_mesh import _declarations, _library

EXAMPLES = os.path.join(support.DATA, "examples", "python")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def headers():
    for path in glob.glob(os.path.join(support.SOURCE, "include", "ffd", "*.h")):
        yield re.sub(r"/\*.*?\*/", "", read(path), flags=re.S)


class Declarations(unittest.TestCase):
    def test_every_function_is_declared_and_there(self):
        names = {name for text in headers() for name in re.findall(r"\bFFD_API\b[^;(#]*?\b(ffd_\w+)\s*\(", text)}
        self.assertEqual(names, set(_declarations.FUNCTIONS))
        self.assertGreater(len(names), 50)
        for name in names:
            self.assertTrue(getattr(_library.lib, name))

    def test_statuses_and_errors_have_names(self):
        self.assertEqual([status.name for status in ffd.Status],
                         [name.split("_")[-1] for name in _declarations.ENUMERATIONS["ffd_vertex_status"]])
        kinds = {kind.status for kind in vars(ffd).values() if isinstance(kind, type) and issubclass(kind, ffd.Error)}
        self.assertEqual(kinds, set(_declarations.ENUMERATIONS["ffd_status"].values()) - {0})

    def test_what_is_offered_is_documented_and_typed(self):
        for name in ffd.__all__:
            thing = getattr(ffd, name)
            self.assertTrue(thing.__doc__, name)
        folder = os.path.dirname(ffd.__file__)
        self.assertTrue(os.path.exists(os.path.join(folder, "py.typed")))
        for path in glob.glob(os.path.join(folder, "*.py")):
            if path.endswith("_declarations.py"):
                continue
            with open(path, encoding="utf-8") as file:
                for node in ast.walk(ast.parse(file.read())):
                    is_overload = any(isinstance(by, ast.Name) and by.id == "overload" for by in getattr(node, "decorator_list", ()))
                    if isinstance(node, ast.FunctionDef) and not node.name.startswith("_") and not is_overload:
                        given = [a for a in node.args.args + node.args.kwonlyargs if a.arg not in ("self", "cls")]
                        self.assertTrue(node.returns and all(a.annotation for a in given), f"{path}: {node.name}")
                        self.assertTrue(ast.get_docstring(node) or path.rpartition("_")[2] in ("library.py", "arrays.py", "errors.py")
                                        or node.name in ("degree", "text"), f"{path}: {node.name}")

    def test_schemas_and_examples_come_with_it(self):
        folder = os.path.dirname(ffd.__file__)
        for name in ("lattice", "report"):
            path = os.path.join(support.DATA, "schema", f"ffd-{name}.schema.json")
            self.assertEqual(ffd.schema(name), json.loads(read(path)))
        with self.assertRaisesRegex(ValueError, "'lattice', 'report'"):
            ffd.schema("mesh")
        with_package = [name for name in sorted(os.listdir(EXAMPLES)) if "import ffd_mesh" in read(os.path.join(EXAMPLES, name))]
        self.assertGreater(len(with_package), 4)
        self.assertEqual(sorted(name for name in os.listdir(os.path.join(folder, "examples")) if name.endswith(".py")), with_package)
        for name in with_package:
            self.assertEqual(read(os.path.join(folder, "examples", name)), read(os.path.join(EXAMPLES, name)))

    def test_numpy_is_the_only_requirement(self):
        meta = importlib.metadata.metadata("ffd-mesh")
        self.assertEqual([word.split()[0].split(">")[0] for word in meta.get_all("Requires-Dist")], ["numpy"])
        self.assertEqual(meta["Version"], ffd.__version__)

    def test_what_the_page_needs_comes_with_it(self):
        """The program by both of its names, the notices of all that is compiled in, and no link that leads nowhere."""
        installed = importlib.metadata.distribution("ffd-mesh")
        links = re.findall(r"\]\(([^)]+)\)", installed.metadata.get_payload())
        self.assertEqual([link for link in links if not re.match("#|https?://", link)], [])
        notices = [str(path) for path in installed.files if ".dist-info/licenses/" in str(path)]
        for name in ("/LICENSE", "/THIRD-PARTY.md", "/draco.txt", "/tinygltf.txt", "/nlohmann_json.txt", "/libxxhash.txt"):
            self.assertTrue(any(path.endswith(name) for path in notices), name)
        mesh, lattice = (os.path.join(support.DATA, name) for name in ("models/spot.obj", "lattices/twist.json"))
        for program in ([sys.executable, "-m", "ffd_mesh"], [os.path.join(os.path.dirname(sys.executable), "ffd")]):
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([*program, "batch", "--in", mesh, "-l", lattice, "--positions", "all.npy"], cwd=folder, check=True,
                               capture_output=True)
                self.assertEqual(np.load(os.path.join(folder, "all.npy")).shape, (1, ffd.info(mesh)["vertices"], 3))

    def test_arrays_need_no_other_library(self):
        script = ("import sys, numpy as np, ffd_mesh as ffd; lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1)); "
                  "points = np.random.default_rng(1).random((10, 3)); lattice.deform(lattice.embed(points), lattice.rest + 1); "
                  "print(open('/proc/self/maps').read())")
        maps = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
        self.assertIn("ffd_mesh/libffd.so", maps)
        self.assertIsNone(re.search("OpenMesh|libpng|libjpeg|libwebp|draco|meshopt|tinygltf", maps))


class Pages(unittest.TestCase):
    def test_the_pages_run(self):
        blocks = []
        for page in ("README.md", "data/python.md"):
            blocks += re.findall(r"^```python\n(.*?)^```$", read(os.path.join(support.SOURCE, page)), re.M | re.S)
        self.assertGreater(len(blocks), 4)
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(support.DATA, os.path.join(folder, "data"))
            with open(os.path.join(folder, "page.py"), "w", encoding="utf-8") as file:
                file.write("\n".join(blocks))
            done = subprocess.run([sys.executable, "../page.py"], cwd=os.path.join(folder, "data"), capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_tutorial_runs(self):
        text = "\n".join(read(os.path.join(support.SOURCE, page)) for page in ("README.md", "data/tutorial.md"))
        with tempfile.TemporaryDirectory() as folder:
            data = os.path.join(folder, "data")
            shutil.copytree(support.DATA, data)
            for name in ("wing.json", "wing-folds.json"):
                os.rename(os.path.join(data, "lattices", name), os.path.join(data, "lattices", "shown-" + name))
            for name, content in re.findall(r"^```json (\S+)\n(.*?)^```$", text, re.M | re.S):
                with open(os.path.join(data, name), "w", encoding="utf-8") as file:
                    file.write(content)
            commands = re.findall(r"^```sh python\n(.*?)^```$", text, re.M | re.S)
            script, = re.findall(r"^```python\n(.*?)^```$", read(os.path.join(support.SOURCE, "data/tutorial.md")), re.M | re.S)
            paths = os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]])
            printed = ""
            for command in (["sh", "-eu", "-c", "".join(commands)], [sys.executable, "-c", script]):
                done = subprocess.run(command, cwd=data, env=os.environ | {"PATH": paths}, capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""), command)
                printed += done.stdout
            # Another scipy ends elsewhere by its tolerance.
            stated = re.findall(r"^wing.*?\.json: ([\d.]+) forward .*folds: (\w+), least det (\S+)$", text, re.M)
            found = re.findall(r"^wing.*?\.json: ([\d.]+) forward .*folds: (\w+), least det (\S+)$", printed, re.M)
            self.assertEqual([verdict for _, verdict, _ in found], ["some", "none"])
            for (forward, verdict, least), (more, other, det) in zip(stated, found, strict=True):
                self.assertEqual(verdict, other)
                self.assertLess(abs(float(forward) - float(more)), 0.002)
                self.assertLess(abs(float(least) - float(det)), 0.02)
            for name in ("wing.json", "wing-folds.json"):
                made, shown = (ffd.Lattice.load(os.path.join(data, path)) for path in (name, "lattices/shown-" + name))
                self.assertLess(np.abs(made.deformed - shown.deformed).max(), 2e-3)
            variants = np.load(os.path.join(data, "variants.npy"), mmap_mode="r")
            self.assertEqual((variants.shape, variants.dtype), ((10_000, 1159, 3), np.dtype(np.float32)))
            training = np.load(os.path.join(data, "training.npz"))
            low, high = training["parameters"].min(axis=0), training["parameters"].max(axis=0)
            self.assertTrue((low < [0.701, 0.701, -59.9]).all() and (high > [1.299, 1.399, 59.9]).all())
            for row in (0, 1, 9_999):
                lattice = ffd.Lattice.load(os.path.join(data, "sweep.json"), dict(zip(("HEIGHT", "GIRTH", "DEGREES"), training["parameters"][row])))
                moved, _ = ffd.positions_file(os.path.join(data, "models/keg_decorated.obj"), lattice)
                self.assertLess(np.abs(moved - variants[row]).max(), 1e-6)

    def example(self, name):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, os.path.join(EXAMPLES, name)], cwd=folder, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""), name)
        return done.stdout

    def test_an_optimisation_needs_few_evaluations(self):
        evaluations, first, last, area = map(float, re.findall(r"-?\d[\d.e+-]*", self.example("optimise.py")))
        self.assertLess(evaluations, 60)
        self.assertLess(last, first / 50)
        self.assertLess(abs(area), 1e-9)

    def test_variants_fill_one_array(self):
        self.assertRegex(self.example("variants.py"), r"^500 variants of \d+ points, [1-9]\d* that fold")

    def test_meshes_of_other_packages(self):
        self.assertIn("volume", self.example("with_trimesh.py"))
        self.assertIn("points", self.example("with_meshio.py"))
        try:
            import pyvista
        except ImportError:
            self.skipTest("pyvista is not among the pinned wheels")
        self.assertIn("volume", self.example("with_pyvista.py"))
