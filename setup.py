# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the extension module of the Python package by CMake; all else is in pyproject.toml.

PGDR_BUILD_FOLDER names a build folder that was configured with PGDR_PYTHON=ON: its module is brought up to date and taken.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        folder = os.environ.get("PGDR_BUILD_FOLDER")
        if folder is None:
            folder = pathlib.Path(self.build_temp).resolve()
            options = {"CMAKE_BUILD_TYPE": "Release", "CMAKE_UNITY_BUILD": "ON", "PGDR_PYTHON": "ON", "PGDR_TESTS": "OFF",
                       "PGDR_TOOLS": "OFF", "PGDR_BENCH": "OFF", "PGDR_INSTALL": "OFF", "PGDR_PYTHON_EXECUTABLE": sys.executable}
            subprocess.run(["cmake", "-S", ROOT, "-B", folder, *[f"-D{name}={value}" for name, value in options.items()],
                            *pybind11_options()], check=True)
        subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", "pgdr_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        made = pathlib.Path(folder, "python", "pgdr", target.name)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(made, target)


def pybind11_options():
    """Where the pybind11 of an index has its CMake files; Debian's are where CMake looks."""
    try:
        import pybind11
        return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
    except ImportError:
        return []


version = re.search(r'PGDR_VERSION_STRING "([^"]+)"', (ROOT / "geometry/pgdr/version.hpp").read_text())
setup(version=version.group(1), ext_modules=[Extension("pgdr._pgdr", [])], cmdclass={"build_ext": CMakeBuild})
