# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Runs one command and writes what the system says of it. A process of its own, which is small: on Linux the peak of a
process begins with that of the one that started it.

    suite_measure.py RESULT.json LIMIT COMMAND...
"""
import json
import os
import signal
import sys
import time


def main():
    result, limit, command = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
    start = time.monotonic()
    child = os.posix_spawnp(command[0], command, os.environ)
    late = []

    def end(*_):
        late.append(True)
        os.kill(child, signal.SIGKILL)
    signal.signal(signal.SIGALRM, end)
    signal.signal(signal.SIGTERM, end)
    signal.setitimer(signal.ITIMER_REAL, limit)
    _, status, usage = os.wait4(child, 0)
    seconds = time.monotonic() - start
    signal.setitimer(signal.ITIMER_REAL, 0)
    with open(result, "w", encoding="utf-8") as file:
        json.dump({"exit": None if late else os.waitstatus_to_exitcode(status), "seconds_total": seconds,
                   "cpu_user": usage.ru_utime, "cpu_system": usage.ru_stime, "peak_bytes": 1024 * usage.ru_maxrss}, file)


if __name__ == "__main__":
    main()
