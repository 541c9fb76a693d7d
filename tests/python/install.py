# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Installs the package by pip into a clean prefix, from a copy of what git has, and runs there what a stranger would do. Before that,
where there is no compiler, it has to be refused with what is missing.

Usage: install.py SOURCE BUILD    (BUILD: a build folder with PGDR_PYTHON=ON, whose module is taken)
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

source, build = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    copy = folder / "source"
    for file in ("pyproject.toml", "setup.py", "README.md", "geometry/pgdr/version.hpp", ".ci/packages-python"):
        (copy / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / file, copy / file)
    shutil.copytree(source / "tools/python", copy / "tools/python", ignore=shutil.ignore_patterns("__pycache__"))
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    install = [sys.executable, "-m", "pip", "install", copy, "--no-build-isolation", "--no-deps", "--no-index", "--prefix", folder / "prefix"]
    bare = {k: v for k, v in environment.items() if k != "CXX"}
    refused = subprocess.run(install, check=False, env={**bare, "PATH": str(folder)}, capture_output=True, text=True)
    assert refused.returncode != 0 and "missing: a C++ compiler, cmake" in refused.stdout + refused.stderr, refused
    subprocess.run(install, check=True, env={**environment, "PGDR_BUILD_FOLDER": str(build)})
    place, = folder.glob("prefix/**/pgdr/__init__.py")
    shutil.copy(source / "tests/python/test_tasks.py", folder)
    environment["PYTHONPATH"] = str(place.parents[1])
    where = subprocess.run([sys.executable, "-c", "import pgdr; print(pgdr.__file__)"], check=True, env=environment, cwd=folder,
                           capture_output=True, text=True).stdout.strip()
    assert where == str(place), where
    subprocess.run([sys.executable, "test_tasks.py"], check=True, env=environment, cwd=folder)

    # The command has come along.
    script, = (file for file in folder.glob("prefix/**/bin/pgdr") if file.parents[1].name != "pgdr")
    for command in ([script], [sys.executable, "-m", "pgdr"]):
        said = subprocess.run([*command, "--version"], check=True, env=environment, cwd=folder, capture_output=True, text=True).stdout
        assert said == subprocess.run([build / "pgdr", "--version"], check=True, capture_output=True, text=True).stdout, said
    assert subprocess.run([script, "mesh"], check=False, env=environment, capture_output=True).returncode == 2  # its exit code is the command's
