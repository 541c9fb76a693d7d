#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The man page and the completions say all that --help says. PGDR_COMMAND names the command. Usage: test_help_pages.py [Class[.test]...]"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from test_command import COMMAND, Case

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools" / "help_pages.py"


class HelpPages(Case):
    def setUp(self):
        super().setUp()
        subprocess.run([sys.executable, "-B", SCRIPT, COMMAND, self.folder], check=True)
        self.flags = {name: sorted(set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", self.pgdr(name, "--help", expect=0).stdout, re.MULTILINE)))
                      for name in ("mesh", "check", "info", "view")}

    def text(self, name):
        return (self.folder / name).read_text()

    def test_every_flag_is_everywhere(self):
        page = self.text("pgdr.1").replace("\\-", "-")
        for name, flags in self.flags.items():
            self.assertGreater(len(flags), 5)
            section = page.partition(f'.SH "PGDR {name.upper()}"')[2].partition("\n.SH ")[0]
            for flag in flags:
                self.assertRegex(section, rf"\\fB{flag}\\fR.*\n[^.\n]", flag)  # with words
                self.assertIn(f"'{flag}[", self.text("_pgdr"))
                self.assertIn(f" -l {flag[2:]}", self.text("pgdr.fish"))
        for code in range(8):
            self.assertIn(f".B {code}\n", page)

    def test_the_page_is_sound(self):
        if not shutil.which("groff"):
            self.skipTest("groff is not installed")
        done = subprocess.run(["groff", "-man", "-ww", "-z", self.folder / "pgdr.1"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")

    def completed(self, *words):
        script = f'source {self.folder}/pgdr.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _pgdr; printf "%s\\n" "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", script, "bash", *words], capture_output=True, text=True, check=True, cwd=self.folder)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def test_bash(self):
        self.assertEqual(self.completed("pgdr", "v"), ["view"])
        for name, flags in self.flags.items():
            self.assertEqual(sorted(self.completed("pgdr", name, "--")), flags)
        self.assertEqual(self.completed("pgdr", "mesh", "a.poly", "--size", "pgdr"), [])
        self.assertEqual(sorted(self.completed("pgdr", "mesh", "pgdr")), ["pgdr.1", "pgdr.bash", "pgdr.fish"])
        self.assertIn("pgdr.1", self.completed("pgdr", "mesh", "a.poly", "-o", "pgdr"))

    def test_zsh_and_fish(self):
        for shell, name in (("zsh", "_pgdr"), ("fish", "pgdr.fish")):
            if shutil.which(shell):
                subprocess.run([shell, "-n", self.folder / name], check=True)


if __name__ == "__main__":
    unittest.main()
