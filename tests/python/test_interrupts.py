# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Signals: what can be stopped ends soon after them, what cannot is finished first, and what a handler raises comes out."""
import os
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import pgdr
from shapes import checked, cube


def interrupt():
    os.kill(os.getpid(), signal.SIGINT)


def rippled(n):
    """A surface of 2 n n triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    rim = np.minimum(np.minimum(x, 1 - x), np.minimum(y, 1 - y))
    lid = np.column_stack([x.ravel(), y.ravel(), 1 + np.minimum(rim, 0.1).ravel() * np.sin(40 * x * y).ravel()])
    row = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    triangles = np.concatenate([np.stack([row, row + 1, row + n + 2], axis=1), np.stack([row, row + n + 2, row + n + 1], axis=1)])
    return lid, triangles


class Interrupts(unittest.TestCase):
    def test_a_check_ends_soon(self):
        made = checked(self, cube(), size=0.08)
        self.assertGreater(len(made.cells), 5000)
        asked = []

        def slow(at):
            if not asked:
                interrupt()
            asked.append(len(at))
            time.sleep(0.3)
            return np.full(len(at), 1.0)

        with self.assertRaises(KeyboardInterrupt):
            pgdr.check(made, cube(), size=slow)
        self.assertLess(sum(asked), len(made.cells))
        self.assertTrue(made.check(cube()))

    def test_a_handler_may_raise_what_it_likes(self):
        class Late(Exception):
            pass

        def raise_late(*_):
            raise Late("now")

        before = signal.signal(signal.SIGALRM, raise_late)
        lid, triangles = rippled(60)
        plc = pgdr.Plc(lid, facets=triangles)
        mesh = checked(self, cube(), size=0.08)
        try:
            for call in (lambda: pgdr.diagnose(plc), lambda: pgdr.check(mesh, cube()), lambda: pgdr.mesh(cube(), size=0.003)):
                signal.setitimer(signal.ITIMER_REAL, 0.05)
                with self.assertRaisesRegex(Late, "now"):
                    for _ in range(10000):
                        call()
        finally:
            signal.signal(signal.SIGALRM, before)

    def test_a_handler_that_raises_nothing_stops_nothing(self):
        heard = []
        before = signal.signal(signal.SIGUSR1, lambda *_: heard.append(time.monotonic()))
        try:
            def size(at):
                if not heard:
                    os.kill(os.getpid(), signal.SIGUSR1)
                return np.full(len(at), 0.2)
            checked(self, cube(), size=size)
        finally:
            signal.signal(signal.SIGUSR1, before)
        self.assertTrue(heard)

    def test_files_are_whole(self):
        old, new = checked(self, cube(), size=0.5), checked(self, cube(), size=0.08)
        interrupted = 0
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "m.mesh")
            for delay in np.linspace(0.0, 0.04, 15):
                old.write(file)
                timer = threading.Timer(delay, interrupt)
                try:
                    timer.start()
                    new.write(file)
                    timer.join()
                    time.sleep(0.1)
                except KeyboardInterrupt:
                    interrupted += 1
                timer.join()
                self.assertEqual(os.listdir(folder), ["m.mesh"])
                self.assertIn(len(pgdr.Mesh.read(file).cells), (len(old.cells), len(new.cells)))
        self.assertEqual(interrupted, 15)

    def test_a_thread_that_is_not_the_main_one_hears_no_signals(self):
        done = []
        worker = threading.Thread(target=lambda: done.append(pgdr.mesh(cube(), size=0.08)))
        worker.start()
        with self.assertRaises(KeyboardInterrupt):
            interrupt()
            time.sleep(5)
        worker.join()
        self.assertEqual(done[0].stop, "finished")
        self.assertTrue(done[0].check(cube()))


if __name__ == "__main__":
    unittest.main()
