#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the pgdr command does to what is on the paths that it writes, and to its standard streams. Devices are nodes in a folder of
the test, or FIFOs; none of the machine's is named but /dev/full, which nothing can replace as it is only redirected to.
Usage: test_outputs.py [Class[.test]...]"""
import json
import os
import pathlib
import signal
import socket
import stat
import subprocess
import threading
import time
import unittest

from test_command import BRACKET, COMMAND, PLATE, Case
from test_estimates import children_seconds

IS_ROOT = os.geteuid() == 0


class OutputCase(Case):
    def setUp(self):
        super().setUp()
        self.pgdr("mesh", PLATE, "-o", self.folder / "right.vtu", "--quiet", expect=0)
        self.right = (self.folder / "right.vtu").read_bytes()

    def outputs(self, name):
        """A command for each kind of output that is text, with this name for it, and what must have been made beside it."""
        mesh = ["mesh", PLATE, "-o", self.output, "--quiet"]
        right = self.folder / "right.vtu"
        return {"report": [*mesh, "--report", name], "trace": [*mesh, "--trace", name],
                "report of check": ["check", right, "--report", name, "--quiet"],
                "report of info": ["info", PLATE, "--report", name, "--quiet"],
                "report of view": ["view", right, "-o", self.folder / "right.svg", "--report", name, "--quiet"]}

    def kind(self, path):
        return stat.S_IFMT(os.lstat(path).st_mode)

    def device(self, minor):
        """A node of a memory device: 3 takes all, 7 is always full."""
        if not IS_ROOT:
            self.skipTest("only root makes device nodes")
        node = self.folder / f"device{minor}.json"
        try:
            os.mknod(node, stat.S_IFCHR | 0o666, os.makedev(1, minor))
            with open(node, "wb"):
                pass
        except OSError as error:
            self.skipTest(f"no device nodes here: {error}")
        return node

    def reader(self, fifo):
        """Reads all of a FIFO meanwhile; the list has it after join()."""
        got = []
        thread = threading.Thread(target=lambda: got.append(fifo.read_bytes()), daemon=True)
        thread.start()
        return thread, got

    def fifo(self, name):
        os.mkfifo(self.folder / name)
        return self.folder / name

    def assert_no_temporary(self):
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.endswith(".tmp")], [])


class Replaced(OutputCase):
    """What may be replaced is, and nothing else."""

    def test_devices_are_written_to(self):
        node = self.device(3)
        for what, command in self.outputs(node).items():
            with self.subTest(what):
                self.pgdr(*command, expect=0)
                self.assertEqual(self.kind(node), stat.S_IFCHR)
        self.pgdr("mesh", PLATE, "-o", self.output, "--report", node, "--trace", node, expect=0)  # none replaces the other
        (self.folder / "picture.svg").symlink_to(node)
        (self.folder / "mesh.vtu").symlink_to(node)
        self.pgdr("view", self.folder / "right.vtu", "-o", self.folder / "picture.svg", expect=0)
        self.pgdr("mesh", PLATE, "-o", self.folder / "mesh.vtu", expect=0)
        self.assertTrue((self.folder / "mesh.vtu").is_symlink() and (self.folder / "picture.svg").is_symlink())
        self.assertEqual(self.kind(node), stat.S_IFCHR)
        self.assert_no_temporary()

    def test_a_full_device_is_an_error_and_stays(self):
        node = self.device(7)
        for what, command in self.outputs(node).items():
            with self.subTest(what):
                self.assertIn("No space", self.pgdr(*command, expect=4).stderr)
                self.assertEqual(self.kind(node), stat.S_IFCHR)
        self.assertEqual(self.output.read_bytes(), self.right)

    def test_fifos_are_written_to(self):
        fifo = self.fifo("pipe.json")
        for what, command in self.outputs(fifo).items():
            with self.subTest(what):
                thread, got = self.reader(fifo)
                self.pgdr(*command, expect=0)
                thread.join(20)
                self.assertGreater(len(json.loads(got[0])), 0)
                self.assertEqual(self.kind(fifo), stat.S_IFIFO)

    def test_meshes_and_pictures_go_to_fifos(self):
        for extension in (".vtu", ".msh", ".mesh"):
            file = self.folder / ("file" + extension)
            self.pgdr("mesh", PLATE, "-o", file, expect=0)
            fifo = self.fifo("pipe" + extension)
            thread, got = self.reader(fifo)
            self.pgdr("mesh", PLATE, "-o", fifo, expect=0)
            thread.join(20)
            self.assertEqual(got[0], file.read_bytes())
        self.pgdr("view", self.folder / "right.vtu", "-o", self.folder / "file.svg", expect=0)
        fifo = self.fifo("pipe.svg")
        thread, got = self.reader(fifo)
        self.pgdr("view", self.folder / "right.vtu", "-o", fifo, expect=0)
        thread.join(20)
        self.assertEqual(got[0], (self.folder / "file.svg").read_bytes())

    def test_families_go_to_fifos_one_after_the_other(self):
        self.pgdr("mesh", PLATE, "-o", self.folder / "file.ele", expect=0)
        pipes = [self.fifo("pipe" + e) for e in (".node", ".edge", ".ele")]
        run = subprocess.Popen([COMMAND, "mesh", PLATE, "-o", self.folder / "pipe.ele", "--quiet"])
        texts = [pipe.read_bytes() for pipe in pipes]  # as `cat` of all would
        self.assertEqual(run.wait(20), 0)
        self.assertEqual(texts, [(self.folder / ("file" + p.suffix)).read_bytes() for p in pipes])

    def test_a_reader_that_leaves_is_an_error(self):
        fifo = self.fifo("pipe.mesh")
        run = subprocess.Popen([COMMAND, "mesh", BRACKET, "-o", fifo, "--size", "0.1", "--no-optimize", "--quiet"], stderr=subprocess.PIPE)
        with open(fifo, "rb") as read:
            read.read(10)
        said = run.communicate(timeout=60)[1].decode()
        self.assertEqual(run.returncode, 4, said)
        self.assertIn("Broken pipe", said)
        self.assertEqual(self.kind(fifo), stat.S_IFIFO)

    def test_a_writer_whom_nobody_reads_ends_at_a_signal(self):
        for flags in (["-o", self.fifo("pipe.vtu")], ["-o", self.output, "--trace", self.fifo("trace.json")],
                      ["-o", self.output, "--report", self.fifo("report.fifo")]):
            run = subprocess.Popen([COMMAND, "mesh", PLATE, *flags, "--quiet"])
            time.sleep(1)
            self.assertIsNone(run.poll())
            run.send_signal(signal.SIGTERM)
            self.assertEqual(run.wait(20), -signal.SIGTERM)
        self.assertEqual(self.output.read_bytes(), self.right)
        self.assert_no_temporary()

    def test_sockets_and_folders_stay(self):
        name = self.folder / "socket.json"
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(str(name))
            for what, command in self.outputs(name).items():
                with self.subTest(what):
                    self.assertIn("socket", self.pgdr(*command, expect=4).stderr)
                    self.assertEqual(self.kind(name), stat.S_IFSOCK)
        folder = self.folder / "folder.json"
        folder.mkdir()
        for what, command in self.outputs(folder).items():
            with self.subTest(what):
                self.assertIn("directory", self.pgdr(*command, expect=4).stderr)
                self.assertTrue(folder.is_dir())
        self.assertFalse(self.output.exists())  # all of that is known before there is a mesh

    def test_links_are_followed_and_stay(self):
        (self.folder / "below").mkdir()
        for there in (True, False):
            target = self.folder / "below" / f"target{there}.json"
            if there:
                target.write_text("old")
                target.chmod(0o640)
            link, chain = self.folder / f"link{there}.json", self.folder / f"chain{there}.json"
            link.symlink_to(pathlib.Path("below") / target.name)
            chain.symlink_to(link)
            for what, command in self.outputs(chain).items():
                with self.subTest(what):
                    self.pgdr(*command, expect=0)
                    self.assertTrue(link.is_symlink() and chain.is_symlink())
                    json.loads(target.read_text())
            if there:
                self.assertEqual(stat.S_IMODE(target.stat().st_mode), 0o640)
        mesh = self.folder / "mesh.vtu"
        mesh.symlink_to(self.folder / "below" / "mesh.vtu")  # not yet there
        self.pgdr("mesh", PLATE, "-o", mesh, expect=0)
        self.assertTrue(mesh.is_symlink())
        self.assertEqual((self.folder / "below" / "mesh.vtu").read_bytes(), self.right)
        again = self.pgdr("mesh", PLATE, "-o", mesh, "--report", self.folder / "below" / "mesh.vtu", expect=2)
        self.assertIn("would replace the output", again.stderr)

    def test_links_that_lead_nowhere(self):
        one, other, absent = self.folder / "one.json", self.folder / "other.json", self.folder / "absent.json"
        one.symlink_to(other)
        other.symlink_to(one)
        absent.symlink_to(self.folder / "none" / "file.json")
        for name in (one, absent):
            for what, command in self.outputs(name).items():
                with self.subTest(what):
                    self.pgdr(*command, expect=4)
                    self.assertTrue(name.is_symlink())
        self.assertFalse(self.output.exists())
        target = self.folder / "later.vtu"  # a file that does not exist yet, by two names
        link = self.folder / "link.json"
        link.symlink_to(target)
        self.assertIn("would replace the output", self.pgdr("mesh", PLATE, "-o", target, "--report", link, expect=2).stderr)

    def test_modes_and_owners_are_kept(self):
        for mode in (0o600, 0o640, 0o666, 0o755):
            for name, command in {"out.vtu": ["mesh", PLATE, "-o", self.output], "out.svg":
                                  ["view", self.folder / "right.vtu", "-o", self.folder / "out.svg"],
                                  "report.json": ["info", PLATE, "--report", self.report],
                                  "out.ele": ["mesh", PLATE, "-o", self.folder / "out.ele"]}.items():
                file = self.file(name, "old")
                file.chmod(mode)
                if IS_ROOT:
                    os.chown(file, 12345, 23456)
                self.pgdr(*command, expect=0)
                now = file.stat()
                self.assertNotEqual(file.read_bytes(), b"old")
                self.assertEqual(stat.S_IMODE(now.st_mode), mode, name)
                if IS_ROOT:
                    self.assertEqual((now.st_uid, now.st_gid), (12345, 23456))

    def test_new_files_follow_the_umask(self):
        self.pgdr("mesh", PLATE, "-o", self.output, "--report", self.report, expect=0, preexec_fn=lambda: os.umask(0o027))
        for file in (self.output, self.report):
            self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o640)

    def test_write_protected_files_stay(self):
        def as_nobody():
            if IS_ROOT:
                os.setgid(65534)
                os.setuid(65534)
        self.folder.chmod(0o777)
        file = self.file("kept.json", "old")
        file.chmod(0o444)
        for what, command in self.outputs(file).items():
            with self.subTest(what):
                self.assertIn("Permission", self.pgdr(*command, expect=4, preexec_fn=as_nobody).stderr)
                self.assertEqual(file.read_text(), "old")
        locked = self.folder / "locked"
        locked.mkdir()
        locked.chmod(0o555)
        for what, command in self.outputs(locked / "new.json").items():
            with self.subTest(what):
                self.assertIn("Permission", self.pgdr(*command, expect=4, preexec_fn=as_nobody).stderr)
        self.assertFalse(self.output.exists())

    def test_folders_of_the_system(self):
        """Even root makes no files there, which no permission says."""
        for name in ("/proc/pgdr.json", "/proc/self/comm"):
            for what, command in self.outputs(name).items():
                with self.subTest(what):
                    self.pgdr(*command, expect=4)
        self.assertFalse(self.output.exists())

    def test_a_report_that_cannot_be_written_costs_no_meshing(self):
        begin = children_seconds()
        self.pgdr("mesh", BRACKET, "-o", self.output, "--size", "0.01", "--report", self.folder / "none" / "report.json", expect=4)
        self.assertLess(children_seconds() - begin, 5)  # the mesh takes a minute
        self.assertFalse(self.output.exists())

    def test_unknown_suffixes_are_wrong_usage(self):
        fifo = self.fifo("never.poly")  # whose reading would not end
        for output in ("out.pdf", "out", "out.dxf", "out.poly"):
            self.assertIn(".vtu", self.pgdr("mesh", fifo, "-o", self.folder / output, expect=2).stderr)
            self.assertIn(".svg", self.pgdr("view", fifo, "-o", self.folder / output, expect=2).stderr)


class Streams(OutputCase):
    """Standard output that is full, closed, a pipe that nobody reads, or a file that is named, too."""

    def commands(self):
        right = self.folder / "right.vtu"
        return [["mesh", PLATE, "-o", self.output], ["info", PLATE], ["info", right], ["check", right],
                ["view", right, "-o", self.folder / "right.svg"], ["--help"], ["mesh", "--help"], ["--version"]]

    def shell(self, command, redirection):
        line = " ".join(map(str, [COMMAND, *command])) + " " + redirection
        return subprocess.run(["bash", "-c", line], capture_output=True, text=True, timeout=60)

    def test_what_cannot_be_printed_is_an_error_and_costs_nothing(self):
        for redirection in ("> /dev/full", ">&-", ">&- <&-"):
            for command in self.commands():
                done = self.shell(command, redirection)
                self.assertEqual(done.returncode, 4, f"{command} {redirection}: {done.stderr}")
                self.assertIn("standard output", done.stderr)
            self.assertEqual(self.output.read_bytes(), self.right)
            self.output.unlink()

    def test_the_report_says_so(self):
        self.shell(["mesh", PLATE, "-o", self.output, "--report", self.report], "> /dev/full")
        report = self.json()
        self.assertEqual([e["file"] for e in report["errors"]], ["standard output"])
        self.assertGreater(report["cells"], 0)

    def test_nothing_to_print_is_no_error(self):
        for redirection in ("> /dev/full", ">&-", ">&- 2>&- <&-"):
            done = self.shell(["mesh", PLATE, "-o", self.output, "--quiet"], redirection)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(self.output.read_bytes(), self.right)

    def test_closed_streams_get_into_no_file(self):
        self.shell(["mesh", PLATE, "-o", self.output, "--report", self.report, "--trace", self.folder / "trace.json"],
                   ">&- 2>&- <&-")
        self.assertEqual(self.output.read_bytes(), self.right)
        self.json()
        json.loads((self.folder / "trace.json").read_text())

    def test_a_pipe_that_nobody_reads(self):
        read, write = os.pipe()
        os.close(read)
        done = subprocess.run([COMMAND, "mesh", PLATE, "-o", self.output, "--report", self.report], stdout=write,
                              stderr=subprocess.PIPE, text=True, timeout=60)
        os.close(write)
        self.assertEqual(done.returncode, 4)
        self.assertIn("Broken pipe", done.stderr)
        self.assertEqual(self.output.read_bytes(), self.right)
        self.json()

    def test_what_went_wrong_before_counts_more(self):
        other = self.file("other.poly", "3 2 0 0\n1 0 0\n2 5 0\n3 5 5\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n")
        done = self.shell(["check", self.folder / "right.vtu", "--input", other], "> /dev/full")
        self.assertEqual(done.returncode, 6)

    def test_reports_go_to_standard_output(self):
        for name in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            done = self.pgdr("mesh", PLATE, "-o", self.output, "--quiet", "--report", name, expect=0)
            self.assertGreater(json.loads(done.stdout)["cells"], 0)
            log = self.folder / "log.json"
            with open(log, "wb") as out:
                subprocess.run([COMMAND, "mesh", PLATE, "-o", self.output, "--report", name], stdout=out, check=True)
            text = log.read_text()  # the summary, then the report: the file that is open is not replaced
            self.assertIn("wrote", text)
            self.assertGreater(json.loads(text[text.index("\n{\n"):])["cells"], 0)
        closed = self.shell(["mesh", PLATE, "-o", self.output, "--quiet", "--report", "/dev/fd/9"], "")
        self.assertEqual(closed.returncode, 4, closed.stderr)


class Fifos(OutputCase):
    """Inputs that can be read once."""

    def feed(self, *names):
        """Writes files to FIFOs of the same names in the folder, each once."""
        pipes = []
        for file in names:
            pipe = self.folder / ("fed" + pathlib.Path(file).suffix)
            if not pipe.exists():
                os.mkfifo(pipe)
            threading.Thread(target=lambda p=pipe, b=pathlib.Path(file).read_bytes(): p.write_bytes(b), daemon=True).start()
            pipes.append(pipe)
        return pipes if len(pipes) > 1 else pipes[0]

    def test_each_command_reads_once(self):
        mesh = self.folder / "right.vtu"
        self.pgdr("mesh", PLATE, "-o", self.folder / "right.msh", expect=0)
        for pipe in (lambda: self.feed(PLATE), lambda: self.feed(self.folder / "right.msh")):
            self.pgdr("mesh", pipe(), "-o", self.output, expect=0)
        self.pgdr("mesh", self.feed(PLATE), "-o", self.output, "--quiet", expect=0)
        self.assertEqual(self.output.read_bytes(), self.right)
        self.pgdr("info", self.feed(PLATE), expect=0)
        self.pgdr("info", self.feed(self.folder / "right.msh"), expect=0)
        self.pgdr("check", self.feed(mesh), "--input", self.feed(PLATE), expect=0)
        self.pgdr("view", self.feed(mesh), "-o", self.folder / "picture.svg", expect=0)

    def test_families_are_read_once(self):
        self.pgdr("mesh", PLATE, "-o", self.folder / "right.ele", expect=0)
        node, ele, edge = self.feed(*(self.folder / ("right" + e) for e in (".node", ".ele", ".edge")))
        self.pgdr("check", ele, "--input", PLATE, expect=0)
        points, segments = self.folder / "points.node", self.folder / "points.poly"
        lines = PLATE.read_text().splitlines()
        lines = [line for line in lines if line.strip() and not line.startswith("#")]
        count = int(lines[0].split()[0])
        points.write_text("\n".join(lines[:count + 1]) + "\n")
        segments.write_text("\n".join(["0 2 0 0", *lines[count + 1:]]) + "\n")
        without = segments.read_text().replace("0 2 0 0", "0", 1)  # the dimension is in the .node file alone
        segments.write_text(without)
        node, poly = self.feed(points, segments)
        self.pgdr("mesh", poly, "-o", self.output, "--quiet", expect=0)
        self.assertEqual(self.output.read_bytes(), self.right)

    def test_waiting_for_an_input_ends_at_a_signal(self):
        pipe = self.fifo("waits.poly")
        for command in (["mesh", pipe, "-o", self.output], ["info", pipe], ["check", self.folder / "right.vtu", "--input", pipe]):
            for number in (signal.SIGTERM, signal.SIGINT):
                for begun in (False, True):
                    run = subprocess.Popen([COMMAND, *map(str, command)], stdout=subprocess.DEVNULL)
                    writer = open(pipe, "wb") if begun else None  # opens once the command reads
                    if begun:
                        writer.write(b"4 2 0 0\n1 0 0\n")
                        writer.flush()
                    time.sleep(0.5)
                    self.assertIsNone(run.poll())
                    run.send_signal(number)
                    self.assertEqual(run.wait(20), -number)
                    if writer:
                        writer.close()
        self.assertFalse(self.output.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
