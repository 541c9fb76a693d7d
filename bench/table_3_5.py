#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Table 3.5 of the dissertation anew: the unit cube and the bat, both schedules and claim rules, over threads.

    bench/table_3_5.py build/release/pgdr [--threads 1,2,4] [--repeat 3] [--minutes M] [--table bench/notebook/threads.md]

All configurations run by turns, refinement alone (`--no-optimize`), and every mesh goes through `pgdr check`; reproducible meshes of one
claim rule must have the same bytes. Python's standard library is enough, and `bench/bundle.py` packs what a machine without packages
needs. Exit code: 0; 1 if a mesh is wrong or bytes differ; 2 for wrong usage.
"""
import argparse
import itertools
import os
import pathlib
import signal
import statistics
import sys
import tempfile
import time

import suite_machine
import suite_models
import tables
from suite_programs import Configuration, Suite

TEXT_SECONDS = {"cube": (77.2, 47.0, 37.06, 32.29), "bat": (235.2, 142.1, 120.0, 111.2)}  # 1 to 4 threads of 1.28 GHz
HEAD = ["model", "schedule", "claims", "threads", "seconds", "speed-up", "efficiency", "work / path", "path", "set aside", "cells", "check",
        "the text's seconds", "its efficiency"]


def arguments():
    threads = [t for t in (1, 2, 4, 8, 12, 16, 24, 32, 48, 64) if t <= suite_machine.usable_cores()]
    listed = lambda text: [word for word in text.split(",") if word]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("pgdr", nargs="?", default=str(suite_models.ROOT / "build" / "release" / "pgdr"), help="the command")
    add("--threads", type=lambda text: [int(word) for word in listed(text)], default=threads,
        help=f"default: {','.join(map(str, threads))}")
    add("--models", type=listed, default=["cube", "bat"], help="of bench/suite.py's; default: cube,bat")
    add("--model-folder", default=os.environ.get("PGDR_MODELS", ""), help="where surfaces are; $PGDR_MODELS")
    add("--schedules", type=listed, default=["reproducible", "greedy"], help="default: reproducible,greedy")
    add("--claims", type=listed, default=["boxes", "leaves"], help="default: boxes,leaves, where the command has --claims")
    add("--repeat", type=int, default=3, help="rounds, of which the table has medians; default: %(default)s")
    add("--minutes", type=float, default=float("inf"), help="no run begins after that; default: no limit")
    add("--quick", action="store_true", help="small meshes: the script itself is tried")
    add("--table", type=pathlib.Path, help="a file whose table, between its marks, is replaced")
    return parser.parse_args()


def configurations(a, claims):
    """Those with the reproducible schedule and the default claims first, should the time be over before the end."""
    by_name = {m.name: m for m in suite_models.MODELS}
    for schedule in a.schedules:
        for rule in claims:
            for name in a.models:
                for t in a.threads:
                    yield Configuration(by_name[name], "pgdr", schedule, t, claims=rule)


def run_all(suite, todo, a):
    """Rows of all runs that the time, and Ctrl-C or SIGTERM, allow."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    end, runs = time.monotonic() + 60 * a.minutes, []
    try:
        for number, c in itertools.product(range(1, a.repeat + 1), todo):
            if time.monotonic() > end:
                print(f"the time is over in round {number}", file=sys.stderr)
                break
            runs.append(suite.run(c, number))
            r = runs[-1]
            print(f"round {number}: {r['model']}, {r['schedule']} {r['claims']}, {r['threads']} threads: "
                  + (f"{r['seconds_mesh']:.3f} s" if r["seconds_mesh"] else r["remark"]), file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("ended by Ctrl-C", file=sys.stderr)
    return runs


def wrong_runs(runs):
    first = {}
    for r in runs:
        where = f"{r['model']}, {r['schedule']} {r['claims']}, {r['threads']} threads, round {r['round']}"
        if r["exit"] not in (0, 1) or r["check"] != r["exit"]:
            yield f"{where}: exit code {r['exit']}, of the check {r['check']}; {r['remark'] or ''}"
        elif r["schedule"] == "reproducible" and first.setdefault((r["model"], r["claims"]), r["sha256"]) != r["sha256"]:
            yield f"{where}: not the bytes of the first run"


def lines_of(runs):
    """The table: a line a configuration, with medians of its rounds."""
    groups = {}
    for r in runs:
        if r["seconds_mesh"]:
            groups.setdefault((r["model"], r["schedule"], r["claims"], r["threads"]), []).append(r)
    middle = lambda rows, key: statistics.median(r[key] for r in rows)
    seconds = {key: middle(rows, "seconds_mesh") for key, rows in groups.items()}
    lines = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)]
    for (model, schedule, claims, threads), rows in groups.items():
        took, one, text = seconds[model, schedule, claims, threads], seconds.get((model, schedule, claims, 1)), TEXT_SECONDS.get(model, ())
        ordered = schedule == "reproducible"  # the greedy schedule has no path: what it waited for depends on the threads
        values = [model, schedule, claims or "-", str(threads), f"{took:.2f}", f"{one / took:.2f}" if one else "",
                  f"{100 * one / took / threads:.0f} %" if one else "",
                  f"{statistics.median(r['work_seconds'] / r['critical_path_seconds'] for r in rows):.1f}" if ordered else "",
                  f"{middle(rows, 'critical_path_seconds'):.3f}" if ordered else "",
                  f"{100 * statistics.median(r['set_aside'] / max(1, r['committed']) for r in rows):.2f} %", f"{middle(rows, 'cells'):,.0f}",
                  "/".join(sorted({str(r["check"]) for r in rows}))]
        values += [f"{text[threads - 1]:g}", f"{100 * text[0] / text[threads - 1] / threads:.0f} %"] if threads <= len(text) else ["", ""]
        lines.append("| " + " | ".join(values) + " |")
    return lines


def claim_rules(pgdr, wanted):
    """What is wanted of them; one rule, the only one, of a command that has no such flag."""
    return wanted if "--claims" in suite_machine.said([pgdr, "mesh", "--help"]) else [""]


def main():
    a = arguments()
    pgdr, known = pathlib.Path(a.pgdr).resolve(), {m.name: m for m in suite_models.MODELS}
    if not pgdr.is_file() or not set(a.models) <= set(known) or not set(a.schedules) <= {"reproducible", "greedy"} or a.repeat < 1:
        print(f"table_3_5.py: no {a.pgdr}, or no such model or schedule", file=sys.stderr)
        return 2
    record = suite_machine.record(suite_models.ROOT, pgdr)
    with tempfile.TemporaryDirectory(prefix="pgdr_table_") as folder:
        chosen = [known[name] for name in a.models]
        inputs = suite_models.inputs_of(chosen, a.model_folder, pathlib.Path(folder))
        a.models = list(inputs)
        sizes = {m.name: m.quick if a.quick else m.size for m in chosen}
        suite = Suite(pgdr, inputs, sizes, 3600, flags=["--no-optimize"])
        runs = run_all(suite, list(configurations(a, claim_rules(pgdr, a.claims))), a)
    lines = lines_of(runs) + ["", f"{suite_machine.words(record)}, medians of {max([r['round'] for r in runs], default=0)}."]
    print("\n".join(lines))
    if a.table:
        tables.write_table(a.table, lines, "table 3.5")
    wrong = list(wrong_runs(runs))
    print("".join(f"WRONG: {w}\n" for w in wrong), end="")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
