#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the man page and the shells' completions from what the command says of itself (--help), so that they are never behind it.

Usage: help_pages.py COMMAND FOLDER    writes FOLDER/pgdr.1, and pgdr.bash, _pgdr (zsh), pgdr.fish
"""
import pathlib
import re
import subprocess
import sys
from typing import List, NamedTuple, Tuple

FOLDER_WORDS = ("OUTPUT", "PICTURE", "FILE", "FILE.json", "REPORT.json", "MESH", "INPUT")  # values that are files


class Flag(NamedTuple):
    names: List[str]  #: --output, -o
    value: str  #: what it takes, in capitals; "": nothing
    words: str


class Page(NamedTuple):
    name: str  #: of the subcommand; "" of the command itself
    purpose: str
    usage: str
    positionals: List[Flag]
    flags: List[Flag]
    others: List[Tuple[str, str]]  #: subcommands
    footer: str


COLUMN = 30  # where CLI11 begins the words of an option


def rows_of(lines):
    """(head, words) of a list of options; words stand from a column on, behind the head or, if that is long, in the next line."""
    rows = []
    for line in lines:
        if line.startswith(" " * COLUMN):
            rows[-1][1] = f"{rows[-1][1]} {line.strip()}".strip()
        elif line.strip():
            fits = line[COLUMN - 1:COLUMN] in (" ", "")
            rows.append([line[:COLUMN].strip(), line[COLUMN:].strip()] if fits else [line.strip(), ""])
    return rows


def flag_of(head, words):
    names, _, rest = head.partition(" ")
    return Flag(names.split(","), re.sub(r"\b(REQUIRED|Needs|Excludes):?.*$|\.\.\.", "", rest).strip(), words)


def page_of(text, name):
    """What --help says."""
    head, *sections = re.split(r"^(Positionals|Options|Subcommands):\n", text, flags=re.MULTILINE)
    parts = dict(zip(sections[::2], sections[1::2]))
    last = sections[-2]
    parts[last], _, footer = parts[last].partition("\n\n")
    lists = {key: rows_of(value.splitlines()) for key, value in parts.items()}
    lines = head.strip().splitlines()
    usage = next(line.partition(": ")[2] for line in lines if line.startswith("Usage"))
    return Page(name, lines[0], usage, [flag_of(*row) for row in lists.get("Positionals", [])],
                [flag_of(*row) for row in lists.get("Options", [])], [tuple(row) for row in lists.get("Subcommands", [])], footer.strip())


def pages_of(command):
    """That of the command, then those of its subcommands."""
    def said(*words):
        return subprocess.run([command, *words, "--help"], check=True, capture_output=True, text=True).stdout
    first = page_of(said(), "")
    return [first] + [page_of(said(name), name) for name, _ in first.others]


def roff(text):
    """As roff takes it: no line is a request, backslashes and hyphens are themselves."""
    made = text.replace("\\", "\\e").replace("-", "\\-").replace("\n", " ")
    return "\\&" + made if made.startswith((".", "'")) else made


def man(pages, version):
    out = [f'.TH PGDR 1 "" "{version}" "User Commands"', ".SH NAME", "pgdr \\- Delaunay meshes with guaranteed quality, in 3D and 2D",
           ".SH SYNOPSIS"]
    for page in pages[1:]:
        out += [f".B {roff('pgdr ' + page.name)}", roff(page.usage.partition(page.name)[2].strip()), ".br"]
    for page in pages:
        out += [".SH " + (f'"PGDR {page.name.upper()}"' if page.name else "DESCRIPTION"), roff(page.purpose) + "."]
        for flag in page.positionals + page.flags:
            out += [".TP", "\\fB" + "\\fR, \\fB".join(map(roff, flag.names)) + "\\fR" + (f" \\fI{roff(flag.value)}\\fR" if flag.value else ""),
                    roff(flag.words)]
    exits = pages[0].footer.partition(": ")[2]
    out += [".SH EXIT STATUS"]
    for code in exits.rstrip(".").split("; "):
        number, _, words = code.partition(" ")
        out += [".TP", f".B {number}", roff(words)]
    out += [".SH SEE ALSO", ".BR tetgen (1), gmsh (1)"]
    return "\n".join(out) + "\n"


def bash(pages):
    cases = []
    for page in pages[1:]:
        files = " ".join(name for flag in page.flags if flag.value in FOLDER_WORDS for name in flag.names)
        plain = " ".join(name for flag in page.flags if flag.value and flag.value not in FOLDER_WORDS for name in flag.names)
        names = " ".join(name for flag in page.flags for name in flag.names if name.startswith("--"))
        cases.append(f"    {page.name}) files=' {files} '; plain=' {plain} '; names='{names}' ;;")
    subcommands = " ".join(name for name, _ in pages[0].others)
    return "\n".join(["# Completion of pgdr for bash, made by help_pages.py.", "_pgdr() {",
                      '  local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}" files plain names',
                      "  if ((COMP_CWORD == 1)); then", f'    COMPREPLY=($(compgen -W "{subcommands} --help --version" -- "$word"))', "    return",
                      "  fi", '  case "${COMP_WORDS[1]}" in', *cases, "    *) return ;;", "  esac",
                      '  if [[ $plain == *" $before "* ]]; then COMPREPLY=(); return; fi',
                      '  if [[ $word == -* && $files != *" $before "* ]]; then COMPREPLY=($(compgen -W "$names" -- "$word")); return; fi',
                      '  COMPREPLY=($(compgen -f -- "$word"))', "}", "complete -o filenames -F _pgdr pgdr", ""])


def quoted(text):
    return text.replace("'", "").replace("[", "(").replace("]", ")").replace(":", ".").replace("\n", " ")


def zsh(pages):
    out = ["#compdef pgdr", "# Completion of pgdr for zsh, made by help_pages.py.", "local -a commands", "commands=("]
    out += [f"  '{name}:{quoted(words)}'" for name, words in pages[0].others]
    out += [")", "if ((CURRENT == 2)); then", "  _describe command commands", "  return", "fi", "case $words[2] in"]
    for page in pages[1:]:
        out += [f"  {page.name})", "    _arguments \\"]
        for flag in page.flags:
            action = f":{quoted(flag.value)}:{'_files' if flag.value in FOLDER_WORDS else ''}" if flag.value else ""
            out += [f"      '{name}[{quoted(flag.words)[:100]}]{action}' \\" for name in flag.names]
        out += ["      '*:file:_files' ;;"]
    return "\n".join(out + ["esac", ""])


def fish(pages):
    out = ["# Completion of pgdr for fish, made by help_pages.py."]
    out += [f"complete -c pgdr -n __fish_use_subcommand -f -a {name} -d '{quoted(words)}'" for name, words in pages[0].others]
    for page in pages[1:]:
        for flag in page.flags:
            names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in flag.names)
            takes = (" -r" if flag.value in FOLDER_WORDS else " -x") if flag.value else ""
            out.append(f"complete -c pgdr -n '__fish_seen_subcommand_from {page.name}' {names}{takes} -d '{quoted(flag.words)[:100]}'")
    return "\n".join(out) + "\n"


def main():
    command, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    pages = pages_of(command)
    version = subprocess.run([command, "--version"], check=True, capture_output=True, text=True).stdout.split("(")[0].strip()
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("pgdr.1", man(pages, version)), ("pgdr.bash", bash(pages)), ("_pgdr", zsh(pages)), ("pgdr.fish", fish(pages))):
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
