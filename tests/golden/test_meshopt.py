#!/usr/bin/env python3
"""Streams of KHR_meshopt_compression that the newest meshoptimizer makes are decoded as its own decoder decodes them.

    test_meshopt.py TEST_MESHOPT_STREAMS

FFD_NODE names the folder whose node_modules holds meshoptimizer. FFD_SEED=N repeats a run."""

import os
import subprocess
import sys
import tempfile
import time

from validate import find_packages

ROUNDS = 60
MOST_BYTES = 100000


def main():
    node_folder = find_packages("meshoptimizer")
    seed = os.environ.get("FFD_SEED") or str(time.time_ns() % 2 ** 32)
    print(f"FFD_SEED={seed}", flush=True)
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "meshopt_streams.mjs")
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "streams.bin")
        subprocess.run(["node", script, node_folder, file, seed, str(ROUNDS), str(MOST_BYTES)], check=True)
        sys.exit(subprocess.run([sys.argv[1], file], check=False).returncode)


main()
