# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Plots of a suite's summary, as SVG, drawn by gnuplot (Debian: gnuplot-nox)."""
import shutil
import subprocess

HEAD = """set terminal svg size 760,520 noenhanced font "sans-serif,13" background "white"
set encoding utf8
set key below reverse Left maxcols 2
set grid ytics lt 1 lw 1 lc rgb "#dddddd"
set border 3
set tics nomirror
"""


class NoGnuplot(Exception):
    pass


def gnuplot(folder, name, script):
    program = shutil.which("gnuplot")
    if not program:
        raise NoGnuplot("gnuplot is not there (Debian: apt-get install gnuplot-nox): no plots, the figures are in the .csv files")
    file = folder / (name + ".svg")
    done = subprocess.run([program], input=f"{HEAD}set output '{file.name}'\n{script}\n", text=True, capture_output=True,
                          timeout=60, cwd=folder)
    if done.returncode:
        raise RuntimeError(f"gnuplot: {done.stderr.strip()[:500]}")
    return file


def quoted(words):
    return '"' + words.replace("\\", "").replace('"', "'") + '"'


def block(name, rows):
    return f"${name} << EOD\n" + "\n".join(" ".join(map(str, r)) for r in rows) + "\nEOD\n"


def lines(title, x_label, y_label, curves, more=""):
    """Curves: [(name, [(x, y), ...])]. Empty ones are left out; "" if there is none."""
    curves = [(n, rows) for n, rows in curves if rows]
    if not curves:
        return ""
    script = "".join(block(f"d{i}", rows) for i, (_, rows) in enumerate(curves))
    plots = [f"$d{i} using 1:2 with linespoints lw 2 pt 7 ps 0.7 title {quoted(n)}" for i, (n, _) in enumerate(curves)]
    return (f"{script}set title {quoted(title)}\nset xlabel {quoted(x_label)}\nset ylabel {quoted(y_label)}\n{more}\n"
            f"plot {', '.join(plots)}")


def bars(title, y_label, groups, table, style="clustered gap 1", missing="NaN"):
    """A cluster of bars a group; table: {(group, bar): value}. Style `rowstacked`, with 0 for what is missing: a stack a group."""
    names = list(dict.fromkeys(bar for _, bar in table))
    if not table:
        return ""
    rows = [[quoted(g)] + [f"{table[g, n]:.6g}" if (g, n) in table else missing for n in names] for g in groups]
    plots = [f"$d using {i + 2}:xtic(1) title {quoted(n)}" for i, n in enumerate(names)]
    return (f"{block('d', rows)}set title {quoted(title)}\nset ylabel {quoted(y_label)}\nset yrange [0:*]\n"
            f"set style data histogram\nset style histogram {style}\nset style fill solid 0.8\n"
            f"plot {', '.join(plots)}")


def label(row):
    words = row["program"] + (f", {row['schedule']}" if row["schedule"] else "")
    return words


def remove(folder):
    """Plots of an earlier suite."""
    names = ["efficiency", "work_path", "path", "path_stages", "work_path_stages", "bytes_per_cell", "rate", "diagnosis"]
    for file in [folder / (n + ".svg") for n in names] + list(folder.glob("time_*.svg")):
        file.unlink(missing_ok=True)


def of_stages(stages):
    """Of the reproducible schedule with the fewest threads: the plots of path, and of work over path, by stage. What is less than a
    hundredth of a model's path is left out, or put together."""
    rows = [s for s in stages if s["schedule"] == "reproducible"]
    rows = [s for s in rows if s["threads"] == min(r["threads"] for r in rows)]
    models = list(dict.fromkeys(s["model"] for s in rows))
    total = {(m, key): sum(s[key] for s in rows if s["model"] == m) for m in models for key in ("work", "path")}
    large = list(dict.fromkeys(s["stage"] for s in rows if s["path"] > total[s["model"], "path"] / 100))
    shares = {(m, name): 0 for m in models for name in large + ["others"]}
    for s in rows:
        shares[s["model"], s["stage"] if s["stage"] in large else "others"] += 100 * s["path"] / total[s["model"], "work"]
    ratios = {(s["stage"], s["model"]): s["work"] / s["path"] for s in rows if s["stage"] in large and s["path"]}
    return {"path_stages": bars("pgdr, reproducible: critical path by stage", "per cent of all work, which no machine goes below",
                                models, shares, "rowstacked", "0"),
            "work_path_stages": bars("pgdr, reproducible: work / critical path by stage", "no machine is faster than so many times",
                                     large, ratios)}


def draw(folder, summary, stages, diagnosis):
    """The files that were drawn. @throws NoGnuplot"""
    measured = [r for r in summary if r["seconds_mesh"]]
    models = list(dict.fromkeys(r["model"] for r in measured))
    threads = sorted({r["threads"] for r in measured})
    ticks = "set logscale x 2\nset xtics (" + ", ".join(f'"{t}" {t}' for t in threads) + ")"
    ticks += f"\nset xrange [{threads[0] * 0.9}:{threads[-1] * 1.1}]" if threads else ""
    scripts = {}
    for model in models:
        curves = {}
        for r in measured:
            if r["model"] == model:
                curves.setdefault(label(r), []).append((r["threads"], r["seconds_mesh"]))
        scripts["time_" + model] = lines(f"{model}: seconds of meshing", "threads", "seconds", list(curves.items()),
                                         ticks + "\nset logscale y")
    own = [r for r in measured if r["program"] == "pgdr" and r["schedule"] == "reproducible"]
    curves = {m: [(r["threads"], r["efficiency"]) for r in own if r["model"] == m and r["efficiency"]] for m in models}
    scripts["efficiency"] = lines("pgdr, reproducible: efficiency", "threads", "time of one thread / (threads × time)",
                                  list(curves.items()), ticks + "\nset yrange [0:1.1]")
    pick = lambda key, rows: {(r["model"], f"{label(r)}, {r['threads']}"): r[key] for r in rows if r[key]}
    scripts["work_path"] = bars("pgdr, reproducible: work / critical path", "no schedule is faster than so many times",
                                models, pick("work_over_path", own))
    curves = {m: [(r["threads"], r["critical_path_seconds"]) for r in own if r["model"] == m and r["critical_path_seconds"]] for m in models}
    scripts["path"] = lines("pgdr, reproducible: critical path", "threads", "seconds", list(curves.items()), ticks + "\nset logscale y")
    scripts.update(of_stages(stages))
    least = [r for r in measured if r["threads"] == min(x["threads"] for x in measured if x["program"] == r["program"])]
    scripts["bytes_per_cell"] = bars("peak memory of the program", "bytes a cell", models, pick("bytes_per_cell", least))
    rate = {k: v / 1e6 for k, v in pick("cells_per_second", least).items()}
    scripts["rate"] = bars("cells a second of meshing, fewest threads", "million cells a second", models, rate)
    curves = {}
    for r in diagnosis:
        curves.setdefault(r["surface"], []).append((r["triangles"], r["processor_seconds"]))
    scripts["diagnosis"] = lines("diagnosis of surfaces", "triangles", "processor seconds", list(curves.items()),
                                 "set logscale xy")
    return [gnuplot(folder, name, script) for name, script in scripts.items() if script]
