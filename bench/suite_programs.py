# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""One run of one program on one model: its command, what it says of itself, and what the checker says of its mesh.

A row has the keys of COLUMNS; None is unknown. Seconds of meshing are each program's own: pgdr's and gmsh's pass on the wall,
TetGen's are the processor's. `cpu` is the processor's time of the whole command, all threads, measured from outside.
"""
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import suite_models

COLUMNS = ["model", "program", "schedule", "claims", "threads", "round", "cells", "vertices", "seconds_mesh", "seconds_refine",
           "seconds_read", "seconds_write", "seconds_total", "cpu_user", "cpu_system", "peak_bytes", "bytes_per_cell",
           "leaves", "visits", "set_aside", "committed", "refused", "work_seconds", "critical_path_seconds", "work_over_path",
           "max_radius_edge", "min_angle_deg", "max_angle_deg", "over_radius_edge", "findings", "exit", "check", "sha256", "load", "remark"]


@dataclasses.dataclass(frozen=True)
class Configuration:
    model: suite_models.Model
    program: str
    schedule: str
    threads: int
    geo: str = ""  # gmsh
    claims: str = ""  # pgdr; none: its default


def measure(command, folder, limit, environment=None):
    """(exit code, None if it did not end in time; what it printed; seconds and bytes, by the system)."""
    result = folder / "measured.json"
    with tempfile.TemporaryFile() as said:
        launcher = [sys.executable, "-I", "-S", pathlib.Path(__file__).with_name("suite_measure.py"), result, limit]
        process = subprocess.Popen([str(c) for c in launcher + list(command)], cwd=folder, stdout=said,
                                   stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   env={**os.environ, **(environment or {})})
        try:
            process.wait()
        finally:  # if this is interrupted: the launcher ends the command
            process.terminate()
            process.wait()
        said.seek(0)
        words = said.read().decode(errors="replace")
    own = json.loads(result.read_text())
    return own.pop("exit"), words, own


def read_json(path):
    return json.loads(path.read_text()) if path.exists() else {}


def sha256(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def quality(report):
    q, found = report.get("quality", {}), report.get("bounds", {}).get("over_radius_edge")
    return {"max_radius_edge": q.get("max_radius_edge"), "min_angle_deg": q.get("min_angle_deg"),
            "max_angle_deg": q.get("max_angle_deg"), "over_radius_edge": found, "findings": report.get("finding_count"),
            "cells": report.get("cells"), "vertices": report.get("vertices")}


class Suite:
    """What all runs have in common. Verdicts of equal meshes with equal reasons are asked for once."""

    def __init__(self, pgdr, inputs, sizes, limit, tetgen=None, gmsh=None, flags=()):
        """`flags`: more of them for `pgdr mesh`."""
        self.pgdr, self.inputs, self.sizes, self.limit = pathlib.Path(pgdr).resolve(), inputs, sizes, limit
        self.tetgen_program, self.gmsh_program, self.flags = tetgen, gmsh, list(flags)
        self.verdicts = {}

    def run(self, configuration, number):
        row = {**dict.fromkeys(COLUMNS), "model": configuration.model.name, "program": configuration.program,
               "schedule": configuration.schedule, "claims": configuration.claims, "threads": configuration.threads, "round": number,
               "stages": [], "load": round(os.getloadavg()[0], 2)}
        with tempfile.TemporaryDirectory(prefix="pgdr_suite_") as folder:
            program = {"pgdr": self.run_pgdr, "TetGen": self.run_tetgen}.get(configuration.program, self.run_gmsh)
            row.update(program(configuration, pathlib.Path(folder)))
        if row["cells"] and row["peak_bytes"]:
            row["bytes_per_cell"] = row["peak_bytes"] / row["cells"]
        return row

    def check(self, mesh, folder, *more):
        """(exit code, report) of `pgdr check`; the time it takes is no part of any figure."""
        report = folder / "check.json"
        code, _, _ = measure([self.pgdr, "check", mesh, "--report", report, "--quiet", *more], folder, 10 * self.limit)
        return code, read_json(report)

    def run_pgdr(self, c, folder):
        source, flags = self.inputs[c.model.name], c.model.pgdr_flags(self.sizes[c.model.name])
        mesh, report = folder / "mesh.vtu", folder / "report.json"
        claims = ["--claims", c.claims] if c.claims else []
        code, said, row = measure([self.pgdr, "mesh", source, "-o", mesh, "--threads", c.threads, "--schedule", c.schedule, *claims,
                                   "--report", report, "--quiet", *flags, *self.flags], folder, self.limit)
        row["exit"] = code
        data = read_json(report)
        if code not in (0, 1) or not mesh.exists():
            row["remark"] = "out of time" if code is None else said.strip()[:300]
            return row
        s, visits = data["seconds"], data["scheduler"]
        row.update({"seconds_" + k: s[k] for k in ("mesh", "refine", "read", "write")})
        row.update({k: visits[k] for k in ("leaves", "visits", "set_aside", "work_seconds", "critical_path_seconds")})
        if c.schedule == "reproducible" and row["critical_path_seconds"]:  # greedy has no generations to add up
            row["work_over_path"] = row["work_seconds"] / row["critical_path_seconds"]
        row.update({k: data["insertions"][k] for k in ("committed", "refused")})
        row["stages"] = data.get("stages", [])
        row["peak_bytes"] = data["peak_rss_bytes"]
        row["sha256"] = sha256(mesh)
        key = row["sha256"], json.dumps(data["bounds"])
        if key not in self.verdicts:
            self.verdicts[key] = self.check(mesh, folder, "--input", source, "--reasons", report, *flags)
        row["check"], verdict = self.verdicts[key]
        row.update(quality(verdict))
        return row

    def run_tetgen(self, c, folder):
        size, model = self.sizes[c.model.name], c.model
        source = suite_models.for_peers(self.inputs[model.name], folder)
        if model.background:
            suite_models.write_background(source.with_suffix(""), model.background * size, 20)
            switches = "-pq2mBF"
        else:
            switches = model.tetgen_switches(size)
        code, said, row = measure([self.tetgen_program, switches, source], folder, self.limit)
        seconds = {k: float(v) for k, v in re.findall(r"^(.+?) seconds: *([\d.eE+-]+)", said, re.M)}
        mesh = source.with_suffix(".1.ele")
        row["exit"] = code
        if code != 0 or not mesh.exists():
            row["remark"] = "out of time" if code is None else "no mesh: " + " ".join(said.split())[-200:]
            return row
        row["seconds_refine"] = seconds.get("Refinement")
        row["seconds_mesh"] = sum(v for k, v in seconds.items() if k not in ("Output", "Total running"))
        row["seconds_write"] = seconds.get("Output")
        row["check"], verdict = self.check(mesh, folder, "--radius-edge", "2")
        row.update(quality(verdict))
        row["remark"] = switches
        return row

    def run_gmsh(self, c, folder):
        edge = c.model.edge * self.sizes[c.model.name]
        if c.geo in ("surface.geo", "remesh.geo"):
            suite_models.off_to_msh(suite_models.for_peers(self.inputs[c.model.name], folder), folder / "surface.msh")
        geo = shutil.copy(suite_models.ROOT / "bench" / "peers" / c.geo, folder)
        # Threads of OpenMP, which some systems put on one core.
        places = ",".join(f"{{{i}}}" for i in sorted(os.sched_getaffinity(0))[:c.threads])
        bind = {"OMP_PROC_BIND": "true", "OMP_PLACES": places, "OMP_NUM_THREADS": str(c.threads)} if c.threads > 1 else {}
        arguments = ["-3", "-algo", "hxt", "-nt", c.threads, "-setnumber", "edge", f"{edge:.9g}", geo, "-o", folder / "mesh.msh"]
        code, said, row = measure([self.gmsh_program, *arguments], folder, self.limit, bind)
        wall = {k: float(v) for k, v in re.findall(r"Done meshing (\dD) \(Wall ([\d.eE+-]+)s", said)}
        row["exit"] = code
        errors = re.findall(r"^Error *: (?!-|Mesh gen|Check| )(.+)$", said, re.M)
        row["remark"] = "out of time" if code is None else "; ".join(dict.fromkeys(e.strip() for e in errors))[:200] or c.geo
        if code != 0 or not (folder / "mesh.msh").exists():
            return row
        row["check"], verdict = self.check(folder / "mesh.msh", folder, "--radius-edge", "2")
        if verdict.get("cells"):  # it writes a file without cells where it fails
            row.update(quality(verdict))
            prepared = re.findall(r"Done (?:classifying|creating geometry)[^(]*\(Wall ([\d.eE+-]+)s", said)
            row["seconds_mesh"] = sum(wall.values()) + sum(map(float, prepared))
            row["seconds_refine"] = wall.get("3D")
        return row
