"""Calls by the hundred thousand, by many threads at once, interrupted, and without a word printed."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import ffd_mesh as ffd
import numpy as np
import support


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Running(unittest.TestCase):
    def test_memory_does_not_grow(self):
        random = support.rng("memory")
        lattice = support.curved(random)
        Q, points = support.pushed(random, lattice), random.uniform(0, 1, (6, 3)).astype(np.float32)
        embedding = lattice.embed(points)
        out = np.empty_like(points)

        def calls(count):
            for i in range(count):
                lattice.deform(embedding, Q, out=out, threads=1)
                if i % 20 == 0:
                    lattice.basis(lattice.embed(points, threads=1, progress=bool), threads=1)
                    lattice.deform(embedding, normals=points, threads=1)
                    embedding.affected([[1, 1, 1]])
                    ffd.Lattice.parse(lattice.text)
                    try:
                        lattice.embed(points, outside="error", threads=-1)
                    except ValueError:
                        pass
            gc.collect()

        calls(5_000)
        before = resident()
        calls(95_000)
        self.assertLess(resident() - before, 2_000_000)

    def test_threads_share_an_embedding(self):
        random = support.rng("share")
        lattice = support.curved(random)
        embedding = lattice.embed(random.uniform(0, 1, (4000, 3)))
        Qs = [support.pushed(random, lattice) for _ in range(40)]
        wanted = [lattice.deform(embedding, Q).tobytes() for Q in Qs]
        with ThreadPoolExecutor(8) as pool:
            found = list(pool.map(lambda Q: lattice.deform(embedding, Q, threads=2).tobytes(), Qs))
        self.assertEqual(found, wanted)

    def test_other_threads_run_during_a_call(self):
        random = support.rng("gil")
        lattice = support.curved(random, weights=True)
        points = random.uniform(0, 1, (40_000, 3))
        turns, done = 0, threading.Event()
        caller = threading.Thread(target=lambda: (lattice.embed(points, threads=1), done.set()))
        caller.start()
        while not done.wait(0.001):
            turns += 1
        caller.join()
        self.assertGreater(turns, 5)

    def test_threads_follow_affinity(self):
        """A thread that may use one processor of several: its calls start no other."""
        random = support.rng("affinity")
        lattice = support.curved(random)
        points = random.uniform(0, 1, (30_000, 3))
        tasks = []

        def confined():
            os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
            tasks.append(len(os.listdir("/proc/self/task")))
            lattice.embed(points, progress=lambda done: tasks.append(len(os.listdir("/proc/self/task"))))
        caller = threading.Thread(target=confined)
        caller.start()
        caller.join()
        self.assertGreater(len(tasks), 1)
        self.assertEqual(set(tasks), {tasks[0]})

    def test_progress_rises_and_cancels(self):
        random = support.rng("progress")
        lattice = support.curved(random)
        points = random.uniform(0, 1, (30_000, 3))
        seen, threads = [], set()

        def progress(done):
            seen.append(done)
            threads.add(threading.get_ident())
        lattice.embed(points, progress=progress)
        self.assertTrue(seen == sorted(seen) and 0 < seen[0] and seen[-1] <= 1)
        self.assertEqual(threads, {threading.get_ident()})
        with self.assertRaises(ffd.Cancelled):
            lattice.embed(points, progress=lambda done: False)
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            lattice.embed(points, progress=lambda done: 1 / 0)
        embedding = lattice.embed(points)
        with self.assertRaises(ffd.Cancelled):
            lattice.deform(embedding, lattice.rest + 1, progress=lambda done: done < 0)

    def test_an_interrupt_ends_a_call(self):
        random = support.rng("interrupt")
        lattice = support.curved(random, weights=True)
        points = random.uniform(0, 1, (1_500_000, 3))  # half a second and more
        going = threading.Event()
        # What runs in the background may have been started with the signal ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

        def interrupt():
            going.wait()
            time.sleep(0.02)
            os.kill(os.getpid(), signal.SIGINT)
        for progress in (None, lambda done: True):
            going.clear()
            helper = threading.Thread(target=interrupt)
            helper.start()
            with self.assertRaises(KeyboardInterrupt):
                going.set()
                began = time.thread_time()
                lattice.embed(points, threads=1, progress=progress)
            helper.join()
            part = time.thread_time() - began
            self.assertLess(part, 0.75 * self.seconds_of_all(lattice, points))

    def test_an_interrupt_ends_a_job(self):
        random = support.rng("interrupt")
        lattice = support.curved(random, weights=True)
        count = 1_500_000
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n" + "".join(
            f"property float {axis}\n" for axis in "xyz") + "end_header\n"
        mesh = head.encode() + random.uniform(0, 1, (count, 3)).astype("<f4").tobytes()
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        for job in (lambda: ffd.deform_bytes(mesh, lattice, name="a.ply", threads=1),
                    lambda: ffd.check_bytes(mesh, lattice, name="a.ply", threads=1)):
            helper = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
            helper.start()
            began = time.thread_time()
            with self.assertRaises(KeyboardInterrupt):
                job()
            part = time.thread_time() - began
            helper.join()
            self.assertLess(part, 0.75 * self.seconds_of_all(lattice, random.uniform(0, 1, (count, 3))))

    def seconds_of_all(self, lattice, points):
        """What the whole call takes, from a part of it."""
        if not hasattr(self, "whole"):
            began = time.thread_time()
            lattice.embed(points[:60_000], threads=1)
            self.whole = (time.thread_time() - began) * len(points) / 60_000
        return self.whole

    def test_nothing_is_printed(self):
        script = """
import os, signal, sys
import numpy as np, ffd_mesh as ffd
signal.signal(signal.SIGINT, signal.default_int_handler)
points = np.random.default_rng(1).uniform(0, 1, (200000, 3))
lattice = ffd.Lattice.from_points(np.stack(np.meshgrid(*[np.linspace(0, 1, 4) ** 1.5] * 3, indexing="ij"), -1) + 0.01)
for bad in (lambda: lattice.embed(points, outside="error"), lambda: ffd.Lattice.load("absent"), lambda: ffd.info("absent"),
            lambda: lattice.embed(points, progress=lambda done: 1 / 0),
            lambda: lattice.embed(points, progress=lambda done: os.kill(os.getpid(), signal.SIGINT)),
            lambda: ffd.deform_file("absent.obj", "out.obj", lattice)):
    try:
        bad()
        sys.exit("no exception")
    except (ffd.Error, ZeroDivisionError, KeyboardInterrupt):
        pass
result = ffd.deform_file(sys.argv[1], "out.obj", lattice, force=True)
assert result.warnings, result
"""
        done = subprocess.run([sys.executable, "-W", "error", "-X", "dev", "-c", script, os.path.join(support.DATA, "models", "spot.obj")],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
