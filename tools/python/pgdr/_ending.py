# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What happens to work in C++ when Python ends."""
from __future__ import annotations

import atexit
import os
import threading


class _Work:
    """`with WORK:` is around calls of C++ that give the GIL away for long. Daemon threads may still be in such a call when the
    interpreter ends, and would bring the process down where they want the GIL back: so runs are told to stop then, and all are
    waited for."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._count = 0
        self.is_ending = False

    def __enter__(self) -> None:
        with self._changed:
            if self.is_ending:
                raise RuntimeError("Python is ending: no new work is begun")
            self._count += 1

    def __exit__(self, *_: object) -> None:
        with self._changed:
            self._count -= 1
            self._changed.notify_all()

    def end(self) -> None:
        with self._changed:
            self.is_ending = True
            self._changed.wait_for(lambda: self._count == 0)

    def forget(self) -> None:
        """In the child of a fork, which has none of the threads."""
        _Work.__init__(self)


WORK = _Work()
atexit.register(WORK.end)
os.register_at_fork(after_in_child=WORK.forget)
