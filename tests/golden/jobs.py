"""Many runs of the program as one: the jobs of a manifest, by ffd batch."""

import json
import os
import subprocess
import sys

SECONDS = 120


def deform_all(ffd, folder, jobs, *options):
    """Does jobs, as members of a manifest's line, and tells of each, in their order: exit code and message. Files of its
    own go into the folder."""
    if not jobs:
        return []
    manifest, report = (os.path.join(folder, name) for name in ("jobs.jsonl", "report.json"))
    with open(manifest, "w", encoding="utf-8") as file:
        file.writelines(json.dumps(job) + "\n" for job in jobs)
    done = subprocess.run([ffd, "batch", manifest, "--quiet", "--timeout", str(SECONDS), "--report", report, "--journal",
                           os.path.join(folder, "journal"), *options], capture_output=True, text=True, check=False,
                          timeout=SECONDS * len(jobs))
    if done.returncode not in (0, 1):
        sys.exit(f"ffd batch ended with {done.returncode}: {done.stderr}")
    with open(report, encoding="utf-8") as file:
        entries = json.load(file)["jobs"]
    if [entry["output"] for entry in entries] != [job["out"] for job in jobs]:
        sys.exit("the report of ffd batch is not on the jobs of its manifest")
    if done.returncode != any(entry["exit"] for entry in entries):
        sys.exit(f"ffd batch ended with {done.returncode}, and not as its report")
    os.remove(report)
    return [(entry["exit"], entry["error"] or "") for entry in entries]
