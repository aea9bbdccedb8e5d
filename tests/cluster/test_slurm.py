#!/usr/bin/env python3
"""The shards of a manifest as a Slurm array, by the tutorial's commands: together they give what one run gives, also when a
node dies amid its jobs and the array is submitted again."""
import json
import os
import subprocess
import tempfile

from harness import case, check, equal, main, wait_until
from many import (check_report, contents, manifest, one_run, page_commands, page_folder, shell)
from slurm import Slurm

JOBS, SHARDS = 60, 4
# Rows of vertices of a mesh; of one whose job takes long enough to be interrupted.
SMALL, LARGE = 40, 180
SECONDS = 120
# The tutorial's array, for the manifest of this test.
ARRAY = page_commands("slurm").replace("many.jsonl", "jobs.jsonl")


slurm = None  # one for all cases


@case
def the_tutorial_s_commands(run):
    folder = page_folder(run, "data")
    shell(run, folder, page_commands("slurm"), slurm.environment)
    shards = contents(run, "data/many")
    page_folder(run, "one")
    run.folder_of("one/many")
    entries = one_run(run, "one", "many.jsonl")
    equal(shards, contents(run, "one/many"))
    check_report(run, "data/report.json", entries)


@case
def an_array_gives_what_one_run_gives(run):
    manifest(run, "one", JOBS, SMALL)
    manifest(run, "many", JOBS, SMALL)
    entries = one_run(run, "one")
    shell(run, "many", ARRAY, slurm.environment)
    equal(contents(run, "many/out"), contents(run, "one/out"))
    equal(len(contents(run, "one/out")), JOBS)
    check_report(run, "many/report.json", entries)


def reports(run):
    return [json.loads(run.read(f"many/report.{shard}.json"))["jobs"] for shard in range(SHARDS)]


def kill_amid(run, node):
    """Submits the array, and kills the node when one of its shards has done some jobs, not all. Returns the shards that
    it was running."""
    def done(shard):
        names = run.names("many/out")
        return sum(f"{i:03}.obj" in names for i in range(shard, JOBS, SHARDS))

    def amid():
        return [shard for shard, where in slurm.running().items() if where == node and 3 < done(shard) < JOBS // SHARDS]

    with subprocess.Popen(["sh", "-eu", "-c", ARRAY], cwd=run.path("many"), env=slurm.environment,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as submitted:
        wait_until(amid, f"{node} is amid its jobs")
        slurm.kill_node(node)
        lost = [shard for shard in range(SHARDS) if 3 < done(shard) < JOBS // SHARDS and slurm.running().get(shard) == node]
        check(lost, f"the jobs were over before {node} could be killed")
        slurm.give_up(node)
        submitted.wait(SECONDS)
    check(submitted.returncode != 0, "sbatch --wait has not told of the dead node")
    return lost


@case
def a_killed_node_is_repaired_by_submitting_again(run):
    manifest(run, "one", JOBS, LARGE)
    manifest(run, "many", JOBS, LARGE)
    entries = one_run(run, "one")
    lost = kill_amid(run, "node2")
    check(contents(run, "many/out") != contents(run, "one/out"), "nothing was lost")
    slurm.start_node("node2")
    shell(run, "many", ARRAY, slurm.environment)
    equal(contents(run, "many/out"), contents(run, "one/out"))
    check_report(run, "many/report.json", entries, ("ok", "skipped"))
    for shard, jobs in enumerate(reports(run)):
        statuses = {job["status"] for job in jobs}
        if shard in lost:
            equal(statuses, {"ok", "skipped"}, f"shard {shard}, which was cut")
    check({"skipped"} in [{job["status"] for job in jobs} for jobs in reports(run)], "no shard was left as it was")


with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
    os.chmod(folder, 0o755)
    with Slurm(os.path.realpath(folder)) as slurm:
        main()
