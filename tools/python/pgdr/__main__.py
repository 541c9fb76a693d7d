# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The command pgdr that lies in the package: `pgdr ...`, or `python -m pgdr ...`."""
import os
import pathlib
import subprocess
import sys


def main() -> None:
    """Becomes the command, with the arguments and the streams of this process."""
    windows = os.name == "nt"
    command = pathlib.Path(__file__).with_name("bin") / ("pgdr.exe" if windows else "pgdr")
    if not command.exists():
        sys.exit(f"pgdr: the command is not in this package ({command}): pip puts it there; Debian's package pgdr has it, too")
    arguments = [str(command), *sys.argv[1:]]
    if windows:  # exec would leave the console to whoever waits for this process
        sys.exit(subprocess.run(arguments, check=False).returncode)
    os.execv(arguments[0], arguments)


if __name__ == "__main__":
    main()
