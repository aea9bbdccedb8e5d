#!/usr/bin/env python3
"""The shards of a manifest by GNU parallel, with the tutorial's commands: together they give what one run gives."""
from harness import case, equal, main
from many import check_report, contents, environment, manifest, one_run, page_commands, page_folder, shell

JOBS = 30
COMMANDS = page_commands("parallel")


@case
def the_tutorial_s_commands(run):
    page_folder(run, "data")
    page_folder(run, "one")
    run.folder_of("one/many")
    shell(run, "data", COMMANDS, environment(run))
    entries = one_run(run, "one", "many.jsonl")
    equal(contents(run, "data/many"), contents(run, "one/many"))
    check_report(run, "data/report.json", entries)


@case
def the_shards_give_what_one_run_gives(run):
    for folder in ("many", "one"):
        manifest(run, folder, JOBS, 60)
    commands = COMMANDS.replace("many.jsonl", "jobs.jsonl")
    shell(run, "many", commands, environment(run))
    entries = one_run(run, "one")
    equal(contents(run, "many/out"), contents(run, "one/out"))
    equal(len(contents(run, "one/out")), JOBS)
    check_report(run, "many/report.json", entries)
    run.remove("many/out/007.obj")
    run.write("many/m8.obj", run.text("many/m8.obj") + "# changed\n")
    shell(run, "many", commands, environment(run))
    found = check_report(run, "many/report.json", entries, ("ok", "skipped"))
    equal([job["output"] for job in found if job["status"] == "ok"], [entries[i]["output"] for i in (7, 8)], "what was done again")


main()
