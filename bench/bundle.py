#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Packs the command and bench/table_3_5.py for a machine that has Python and nothing else: no packages, no compiler.

    bench/bundle.py build/release/pgdr FOLDER [MODEL...]

FOLDER is made anew. There, FOLDER/run takes the flags of bench/table_3_5.py, and `--models cube,bat,elephant` finds each MODEL. The
command's shared libraries come along, but for the C library, which must be as new as this machine's. The processor must be of the same
kind. Exit code: 0; 2 for wrong usage.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

C_LIBRARY = re.compile(r"/(libc|libm|libdl|librt|libpthread|ld-linux[\w-]*)\.so")
PGDR = '#!/bin/sh\nhere=$(cd "$(dirname "$0")" && pwd)\nLD_LIBRARY_PATH="$here/lib" exec "$here/bin/pgdr" "$@"\n'
RUN = ('#!/bin/sh\nhere=$(cd "$(dirname "$0")" && pwd)\n'
       'exec python3 -B "$here/bench/table_3_5.py" "$here/pgdr" --model-folder "$here/models" "$@"\n')


def libraries(program):
    said = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"(/\S+) \(0x", said)
    return [pathlib.Path(path) for path in found if not C_LIBRARY.search(path)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("models", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    lost = [str(f) for f in [args.pgdr, *args.models] if not f.is_file()]
    if lost or (args.folder.exists() and not (args.folder / "bin" / "pgdr").exists() and any(args.folder.iterdir())):
        print("bundle.py: " + (f"no {', '.join(lost)}" if lost else f"{args.folder} has other files"), file=sys.stderr)
        return 2
    shutil.rmtree(args.folder, ignore_errors=True)
    for name in ("bin", "lib", "bench", "models"):
        (args.folder / name).mkdir(parents=True)
    shutil.copy(args.pgdr, args.folder / "bin" / "pgdr")
    for files, place in ((libraries(args.pgdr), "lib"), (args.models, "models"), (pathlib.Path(__file__).parent.glob("*.py"), "bench")):
        for file in files:
            shutil.copy(file, args.folder / place)
    for name, text in (("pgdr", PGDR), ("run", RUN)):
        (args.folder / name).write_text(text)
        (args.folder / name).chmod(0o755)
    size = sum(f.stat().st_size for f in args.folder.rglob("*") if f.is_file())
    print(f"{args.folder}: {size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
