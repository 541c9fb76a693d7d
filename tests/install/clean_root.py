#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Installs pgdr as the README says where nothing of it was ever there: in fresh roots of Debian 12, made by debootstrap. Root, Linux.

tests/install/clean_root.py [wheel] [deb] [clone] --command build/release/pgdr: by default wheel and deb, of dist/ (tools/wheel, tools/deb).

wheel: a root with python3 and numpy alone; pip installs the wheel without an index; the module and the command mesh a model.
deb: the same root; apt installs the command and the module with what they depend on.
clone: a root with git alone; ./demo of a clone, which compiles for minutes.
The meshes have to be those of --command, to the last byte. Says how long each took.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODEL = ROOT / "tests/models/bracket.poly"
PACKAGES = {"wheel": ["python3", "python3-numpy"], "deb": ["python3", "python3-numpy"], "clone": ["ca-certificates", "git"]}
MIRROR = "http://deb.debian.org/debian"
OF_MODULE = "import pgdr; pgdr.mesh(pgdr.Plc.read('/bracket.poly'), threads=2).write('/module.vtu')"


def run(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, **more)


class Root:
    """A fresh root of Debian 12, with /proc, by which the loader finds the folder of a program."""

    def __init__(self, kept, scratch, *packages):
        archive = kept / ("-".join(["bookworm", *packages]) + ".tar")
        self.path = pathlib.Path(tempfile.mkdtemp(dir=scratch))
        if archive.exists():
            run("tar", "-xf", archive, "-C", self.path)
        else:
            run("debootstrap", "--variant=minbase", "--include=" + ",".join(packages), "bookworm", self.path, MIRROR,
                stdout=subprocess.DEVNULL)
            run("tar", "-cf", archive, "-C", self.path, ".")
        shutil.copy("/etc/resolv.conf", self.path / "etc/resolv.conf")
        shutil.copy(MODEL, self.path / "bracket.poly")

    def __enter__(self):
        run("mount", "-t", "proc", "proc", self.path / "proc")
        return self

    def __exit__(self, *_):
        run("umount", self.path / "proc")

    def run(self, *command, **more):
        return run("chroot", self.path, "/usr/bin/env", "-i", "PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin", "LANG=C.UTF-8",
                   "DEBIAN_FRONTEND=noninteractive", *command, **more)

    def bring(self, file):
        shutil.copy(file, self.path / file.name)
        return "/" + file.name


def only(pattern):
    found = sorted((ROOT / "dist").glob(pattern))
    if len(found) != 1:
        sys.exit(f"dist/{pattern}: {len(found)} files; tools/wheel and tools/deb make one each")
    return found[0]


def install_wheel(root):
    pip = next(pathlib.Path("/usr/share/python-wheels").glob("pip-*.whl"))  # pip runs from its own wheel
    root.run("python3", root.bring(pip) + "/pip", "install", "--quiet", "--no-index", "--break-system-packages", "--root-user-action=ignore",
             root.bring(only("pgdr-*.whl")))


def install_deb(root):
    files = [root.bring(only(name)) for name in ("pgdr_*.deb", "python3-pgdr_*.deb")]
    root.run("apt-get", "update", "-q", stdout=subprocess.DEVNULL)
    root.run("apt-get", "install", "-q", "-y", "--no-install-recommends", *files, stdout=subprocess.DEVNULL)


def try_package(root, install, command):
    """Installs and meshes, by the command and by the module; compares with the command that was built here."""
    begin = time.monotonic()
    install(root)
    installed = time.monotonic()
    root.run("pgdr", "mesh", "/bracket.poly", "-o", "/command.vtu", stdout=subprocess.DEVNULL)
    root.run("pgdr", "view", "/command.vtu", "-o", "/page.html", stdout=subprocess.DEVNULL)  # the viewer is in it, and asks for nothing
    root.run("python3", "-c", OF_MODULE)
    end = time.monotonic()
    run(command, "mesh", MODEL, "-o", root.path / "own.vtu", stdout=subprocess.DEVNULL)
    own = (root.path / "own.vtu").read_bytes()
    for name in ("command.vtu", "module.vtu"):
        if (root.path / name).read_bytes() != own:
            sys.exit(f"{name} differs from the mesh of {command}")
    words = root.run("pgdr", "--version", capture_output=True, text=True).stdout.strip()
    print(f"{words}: {installed - begin:.1f} s to install, {end - installed:.1f} s to mesh twice; the bytes of {command}", flush=True)


def try_clone(root):
    begin = time.monotonic()
    run("git", "clone", "-q", ROOT, root.path / "pgdr")
    root.run("sh", "-c", "cd /pgdr && ./demo")
    print(f"clone and ./demo: {time.monotonic() - begin:.0f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", help="wheel, deb, clone; by default wheel and deb")
    parser.add_argument("--command", type=pathlib.Path, default=ROOT / "build/release/pgdr")
    parser.add_argument("--kept", type=pathlib.Path, default=ROOT / "build/roots", help="where roots are kept as archives")
    arguments = parser.parse_args()
    arguments.kept.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for what in arguments.what or ["wheel", "deb"]:
            if what not in PACKAGES:
                parser.error(f"{what}: it is one of {', '.join(PACKAGES)}")
            with Root(arguments.kept, scratch, *PACKAGES[what]) as root:
                if what == "clone":
                    try_clone(root)
                else:
                    try_package(root, install_wheel if what == "wheel" else install_deb, arguments.command.resolve())


if __name__ == "__main__":
    main()
