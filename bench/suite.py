#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Benchmarks: models x threads x schedules, beside other meshers that are installed. See docs/benchmarks.md.

    bench/suite.py [build/release/pgdr] [--quick] [--models cube,graded] [--threads 1,2,4] [--repeat 5] [--out FOLDER]

All configurations run by turns. Every mesh goes through `pgdr check`, and reproducible meshes must have the same bytes.
Exit code: 0; 1 if a mesh is wrong or bytes differ (wrong.txt says which); 2 for wrong usage.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import statistics
import sys
import tempfile

import suite_machine
import suite_models
import suite_plots
from suite_programs import COLUMNS, Configuration, Suite

SUMMARY = ["model", "program", "schedule", "threads", "runs", "cells", "seconds_mesh", "seconds_mesh_min", "seconds_mesh_max",
           "seconds_refine", "seconds_read", "seconds_write", "seconds_total", "cpu_seconds", "cells_per_second", "speed_up",
           "efficiency", "beside_pgdr", "critical_path_seconds", "work_over_path", "bytes_per_cell", "max_radius_edge", "min_angle_deg",
           "max_angle_deg", "over_radius_edge", "exit", "check", "remark"]
STAGES = ["model", "schedule", "threads", "stage", "seconds", "work", "path"]


def names_of(text, known, what):
    names = [n for n in text.split(",") if n]
    for n in names:
        if n not in known:
            sys.exit(usage(f"{what} {n} is not one of {', '.join(known)}"))
    return names


def usage(message):
    print(f"suite.py: {message}", file=sys.stderr)
    return 2


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    default_threads = [t for t in (1, 2, 4, 8, 16, 32, 64, 128) if t <= suite_machine.usable_cores()]
    add("pgdr", nargs="?", default=str(suite_models.ROOT / "build" / "release" / "pgdr"), help="the command")
    add("--quick", action="store_true", help="small meshes: the suite itself is tried, no figure is worth anything")
    add("--models", default="", help=f"of {', '.join(m.name for m in suite_models.MODELS)}; default: the first six")
    add("--model-folder", default=os.environ.get("PGDR_MODELS", ""), help="where elephant and armadillo are; $PGDR_MODELS")
    add("--threads", default=",".join(map(str, default_threads)), help="default: %(default)s")
    add("--schedules", default="reproducible,greedy", help="default: %(default)s")
    add("--repeat", type=int, default=3, help="rounds; default: %(default)s")
    add("--peers", default="tetgen,gmsh", help="other programs, run where they are installed; default: %(default)s")
    add("--limit", type=float, default=3600, help="seconds for one run of a program; default: %(default)s")
    add("--bench-diagnosis", default="", help="default: bench/bench_diagnosis beside the command, if it is there")
    add("--out", type=pathlib.Path, default=pathlib.Path("out/bench"), help="folder of the results; default: %(default)s")
    return parser.parse_args()


def configurations(models, threads, schedules, peers):
    for model in models:
        for schedule in schedules:
            for t in threads:
                yield Configuration(model, "pgdr", schedule, t)
        if "tetgen" in peers and (model.volume or model.background):
            yield Configuration(model, "TetGen", "", 1)
        if "gmsh" in peers:
            for words, geo in model.geo:
                for t in threads:
                    yield Configuration(model, "gmsh HXT" + (f" ({words})" if words else ""), "", t, geo)


def wrong_runs(runs):
    """What makes the suite fail; another program's failures are results."""
    first = {}
    for r in (r for r in runs if r["program"] == "pgdr"):
        where = f"{r['model']}, {r['schedule']}, {r['threads']} threads, round {r['round']}"
        if r["exit"] not in (0, 1) or r["check"] != r["exit"]:
            yield f"{where}: exit code {r['exit']}, of the check {r['check']}; {r['remark'] or ''}"
        elif r["schedule"] == "reproducible" and first.setdefault(r["model"], r)["sha256"] != r["sha256"]:
            yield f"{where}: not the bytes of {first[r['model']]['threads']} threads, round {first[r['model']]['round']}"


def median(rows, key):
    values = [r[key] for r in rows if r[key] is not None]
    return statistics.median(values) if values else None


def summarize(runs):
    """Medians of each configuration, in the order in which they ran first."""
    groups = {}
    for r in runs:
        groups.setdefault((r["model"], r["program"], r["schedule"], r["threads"]), []).append(r)
    summary = []
    for (model, program, schedule, threads), rows in groups.items():
        s = {**dict.fromkeys(SUMMARY), "model": model, "program": program, "schedule": schedule, "threads": threads}
        for key in ("cells", "seconds_mesh", "seconds_refine", "seconds_read", "seconds_write", "seconds_total",
                    "critical_path_seconds", "work_over_path", "bytes_per_cell"):
            s[key] = median(rows, key)
        for key in ("max_radius_edge", "min_angle_deg", "max_angle_deg", "over_radius_edge", "exit", "check", "remark"):
            s[key] = rows[-1][key]
        times = [r["seconds_mesh"] for r in rows if r["seconds_mesh"] is not None]
        s["runs"] = len(rows)
        s["cpu_seconds"] = statistics.median(r["cpu_user"] + r["cpu_system"] for r in rows)
        if times:
            s["seconds_mesh_min"], s["seconds_mesh_max"] = min(times), max(times)
            s["cells_per_second"] = s["cells"] / s["seconds_mesh"] if s["seconds_mesh"] else None
        summary.append(s)
    at = {(s["model"], s["program"], s["schedule"], s["threads"]): s for s in summary}
    for s in summary:
        one = at.get((s["model"], s["program"], s["schedule"], 1))
        if one and one["seconds_mesh"] and s["seconds_mesh"]:
            s["speed_up"] = one["seconds_mesh"] / s["seconds_mesh"]
            s["efficiency"] = s["speed_up"] / s["threads"]
        own = at.get((s["model"], "pgdr", "reproducible", s["threads"]))
        if own and own["cells_per_second"] and s["cells_per_second"]:
            s["beside_pgdr"] = own["cells_per_second"] / s["cells_per_second"]
    return summary


def summarize_stages(runs):
    """Medians of each stage of pgdr's configurations, in the order in which stages ran."""
    groups = {}
    for r in runs:
        sums = {}
        for s in r["stages"]:  # a stage may run more than once
            into = sums.setdefault(s["name"], dict.fromkeys(("seconds", "work", "path"), 0))
            for key in into:
                into[key] += s.get(key, 0)
        for name, found in sums.items():
            groups.setdefault((r["model"], r["schedule"], r["threads"], name), []).append(found)
    return [dict(zip(STAGES, key)) | {k: median(rows, k) for k in ("seconds", "work", "path")} for key, rows in groups.items()]


def write_csv(path, columns, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.DictWriter(file, columns, lineterminator="\n", extrasaction="ignore")
        out.writeheader()
        out.writerows(rows)


def print_table(summary):
    """The columns that matter most, for the eye."""
    shown = [("cells", "cells", "11,.0f"), ("mesh s", "seconds_mesh", "9.3f"), ("cpu s", "cpu_seconds", "8.2f"),
             ("cells/s", "cells_per_second", "11,.0f"), ("effic.", "efficiency", "6.2f"), ("to pgdr", "beside_pgdr", "7.2f"),
             ("work/path", "work_over_path", "9.1f"), ("path s", "critical_path_seconds", "8.3f"),
             ("B/cell", "bytes_per_cell", "6.0f"),
             ("ratio", "max_radius_edge", "9.4g"), ("over", "over_radius_edge", "7d"), ("check", "check", "5d")]
    width = {key: int(re.match(r"\d+", form).group()) for _, key, form in shown}
    print(f"\n{'model':10} {'program, schedule':34} {'thr':>3} " + " ".join(f"{head:>{width[key]}}" for head, key, _ in shown))
    for s in summary:
        cells = [format(s[key], form) if s[key] is not None else "-".rjust(width[key]) for _, key, form in shown]
        print(f"{s['model']:10} {suite_plots.label(s)[:34]:34} {s['threads']:3} " + " ".join(cells))


def run_diagnosis(a):
    """Rows of bench_diagnosis, and what was wrong with it."""
    program = a.bench_diagnosis or str(pathlib.Path(a.pgdr).resolve().parent / "bench" / "bench_diagnosis")
    if not pathlib.Path(program).exists():
        return [], [f"{program} is not there"] if a.bench_diagnosis else []
    flags = ["--json", "--repeat", "1", "--triangles", "1000,4000"] if a.quick else ["--json", "--repeat", str(a.repeat)]
    said = suite_machine.said([program, *flags], a.limit)
    return (json.loads(said)["rows"], []) if said else ([], ["bench_diagnosis fails"])


def run_all(suite, todo, a, runs):
    """Appends to runs. False if Ctrl-C (or SIGTERM) ended it: what there is then is summed up."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for number in range(1, a.repeat + 1):
            for i, c in enumerate(todo, 1):
                row = suite.run(c, number)
                runs.append(row)
                shown = f"{row['seconds_mesh']:.3f} s" if row["seconds_mesh"] is not None else row["remark"] or "no mesh"
                print(f"round {number}, {i}/{len(todo)}: {c.model.name}, {suite_plots.label(row)}, {c.threads}: {shown}",
                      flush=True)
                write_csv(a.out / "runs.csv", COLUMNS, runs)
    except KeyboardInterrupt:
        print("ended by Ctrl-C", file=sys.stderr)
        return False
    return True


def versions(pgdr, peers):
    found = {"pgdr": suite_machine.said([pgdr, "--version"])}
    if "tetgen" in peers:
        found["TetGen"] = peers["tetgen"]  # 1.5 cannot be asked for its version
    if "gmsh" in peers:
        found["gmsh"] = suite_machine.said([peers["gmsh"], "--version"])
    return found


def chosen(a):
    """What the flags ask for: models, schedules, threads, and the programs of the peers that are installed."""
    by_name = {m.name: m for m in suite_models.MODELS}
    models = [by_name[n] for n in names_of(a.models, by_name, "model")] or [m for m in suite_models.MODELS if m.usual]
    programs = {}
    for peer in names_of(a.peers, ["tetgen", "gmsh"], "peer"):
        programs[peer] = shutil.which(peer)
        if not programs[peer]:
            print(f"{peer} is not installed, and left out", file=sys.stderr)
    return ([m for m in models if m.quick or not a.quick], names_of(a.schedules, ["reproducible", "greedy"], "schedule"),
            list(dict.fromkeys(int(t) for t in a.threads.split(","))), {p: f for p, f in programs.items() if f})


def remove_old(folder):
    """Results of an earlier suite."""
    for name in ["runs.csv", "summary.csv", "stages.csv", "diagnosis.csv", "results.json", "wrong.txt"]:
        (folder / name).unlink(missing_ok=True)
    suite_plots.remove(folder)


def write_results(folder, record):
    write_csv(folder / "runs.csv", COLUMNS, record["runs"])
    write_csv(folder / "summary.csv", SUMMARY, record["summary"])
    write_csv(folder / "stages.csv", STAGES, record["stages"])
    if record["diagnosis"]:
        write_csv(folder / "diagnosis.csv", list(record["diagnosis"][0]), record["diagnosis"])
    (folder / "results.json").write_text(json.dumps(record, indent=1) + "\n")
    (folder / "wrong.txt").write_text("".join(w + "\n" for w in record["wrong"]))
    print_table(record["summary"])
    try:
        suite_plots.draw(folder, record["summary"], record["stages"], record["diagnosis"])
    except suite_plots.NoGnuplot as error:
        print(error, file=sys.stderr)


def main():
    a = arguments()
    pgdr = pathlib.Path(a.pgdr).resolve()
    if not pgdr.is_file():
        return usage(f"there is no {a.pgdr}: build it first (cmake --preset release && cmake --build --preset release)")
    if a.repeat < 1 or not re.fullmatch(r"[1-9]\d*(,[1-9]\d*)*", a.threads):
        return usage("--repeat and --threads take positive whole numbers")
    models, schedules, threads, peers = chosen(a)
    a.out.mkdir(parents=True, exist_ok=True)
    remove_old(a.out)
    record = suite_machine.record(suite_models.ROOT, pgdr)
    if record["machine"]["load_before"] > 0.3 and not a.quick:
        print("the machine is busy: compare cpu seconds, if anything", file=sys.stderr)

    runs = []
    with tempfile.TemporaryDirectory(prefix="pgdr_suite_") as folder:
        inputs = suite_models.inputs_of(models, a.model_folder, pathlib.Path(folder))
        models = [m for m in models if m.name in inputs]
        if not models:
            return usage("none of these models is there")
        sizes = {m.name: m.quick if a.quick else m.size for m in models}
        suite = Suite(pgdr, inputs, sizes, a.limit, peers.get("tetgen"), peers.get("gmsh"))
        ended = run_all(suite, list(configurations(models, threads, schedules, peers)), a, runs)
    diagnosis, wrong = run_diagnosis(a) if ended else ([], ["ended by Ctrl-C"])
    wrong = list(wrong_runs(runs)) + wrong
    record.update(programs=versions(pgdr, peers), quick=a.quick, repeat=a.repeat, sizes=sizes, wrong=wrong,
                  summary=summarize(runs), stages=summarize_stages(runs), diagnosis=diagnosis, runs=runs)
    write_results(a.out, record)
    for w in wrong:
        print("WRONG: " + w)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
