# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the extension module of the Python package, and the command that lies in it, by CMake; all else is in pyproject.toml. What is missing is looked for first, and
said with what installs it; `pip install --verbose` shows each step of the compiler.

PGDR_CMAKE_OPTIONS: more for CMake, `NAME=VALUE ...` (of `tools/wheel`: PGDR_PICTURES=OFF).
PGDR_BUILD_FOLDER names a build folder that was configured with PGDR_PYTHON=ON: its module and command are brought up to date and taken.
"""
import importlib.util
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
            require_tools()
            options = {"CMAKE_BUILD_TYPE": "Release", "CMAKE_UNITY_BUILD": "ON", "PGDR_PYTHON": "ON", "PGDR_TESTS": "OFF",
                       "PGDR_BENCH": "OFF", "PGDR_INSTALL": "OFF", "PGDR_PYTHON_EXECUTABLE": sys.executable}
            options.update(word.split("=", 1) for word in os.environ.get("PGDR_CMAKE_OPTIONS", "").split())
            configured = subprocess.run(["cmake", "-S", ROOT, "-B", folder, *(["-G", "Ninja"] if shutil.which("ninja") else []),
                                         *[f"-D{name}={value}" for name, value in options.items()], *pybind11_options()], check=False)
            if configured.returncode != 0:
                refuse("CMake has not found what it needs (its words are above)")
        print("pgdr: compiling takes minutes; [steps done / steps of all, seconds so far]", flush=True)
        subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", "pgdr_python",
                        "pgdr_command"], check=True,
                       env={"NINJA_STATUS": "[%f/%t, %e s] ", **os.environ})
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        made = pathlib.Path(folder, "python", "pgdr", target.name)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(made, target)
        command = target.with_name("bin") / ("pgdr.exe" if os.name == "nt" else "pgdr")
        command.parent.mkdir(exist_ok=True)
        shutil.copy(pathlib.Path(folder, command.name), command)


def missing_packages():
    """Debian's packages of the list that are not installed; none where there is no dpkg."""
    if not shutil.which("dpkg-query"):
        return []
    names = [line for line in (ROOT / ".ci/packages-python").read_text().splitlines() if line and not line.startswith("#")]
    found = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Status}\\n", *names], capture_output=True, text=True, check=False).stdout
    return [name for name in names if f"{name} install ok installed" not in found.splitlines()]


def refuse(what):
    """Ends with what is wrong, and how Debian mends it."""
    packages = missing_packages()
    cure = f". Missing packages of Debian: apt-get install {' '.join(packages)}" if packages else \
        f". README.md and {ROOT / '.ci/packages-python'} list what is needed"
    sys.exit(f"pgdr: {what}{cure}")


def require_tools():
    """Before anything is configured."""
    compilers = [os.environ["CXX"].split()[0]] if os.environ.get("CXX") else ["c++", "g++", "clang++"]
    missing = [] if any(map(shutil.which, compilers)) else ["a C++ compiler"]
    missing += [] if shutil.which("cmake") else ["cmake"]
    missing += [f"the Python package {name}" for name in ("numpy",) if importlib.util.find_spec(name) is None]
    if missing:
        refuse(f"missing: {', '.join(missing)}")


def pybind11_options():
    """Where the pybind11 of an index has its CMake files; Debian's are where CMake looks."""
    try:
        import pybind11
        return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
    except ImportError:
        return []


if importlib.util.find_spec("wheel") is None and importlib.util.find_spec("setuptools.command.bdist_wheel") is None:
    # else only `invalid command 'bdist_wheel'` would say so
    refuse(f"missing: the Python package wheel, in {sys.prefix}. Make the environment with --system-site-packages, as ./install-python "
           "does, or install wheel and pybind11 in it")
version = re.search(r'PGDR_VERSION_STRING "([^"]+)"', (ROOT / "geometry/pgdr/version.hpp").read_text())
setup(version=version.group(1), ext_modules=[Extension("pgdr._pgdr", [])], cmdclass={"build_ext": CMakeBuild})
