"""Follows a page of docs/ as a reader does: writes its files, runs its commands, and compares what they print.

Comments that a page does not show say what a block of code is:

    <!-- write: FILE -->             the block is a file
    <!-- append: FILE -->            the block goes to the end of a file, after a blank line unless it is indented
    <!-- replace in FILE: A => B --> text of a file is replaced; no block follows

A block of `console` has commands after `$ `, each with what it prints; a line `…` stands for any lines.
Blocks of `sh` are not run: they need a network or other programs.
"""

import re
import shlex
from pathlib import Path
from typing import NamedTuple

from tests.cli.in_process import linkforge

_STEP = re.compile(
    r"<!-- (?P<verb>write|append): (?P<file>\S+) -->\n+```\w*\n(?P<text>.*?)```"
    r"|<!-- replace in (?P<changed>\S+): (?P<old>.+?) => (?P<new>.+?) -->"
    r"|```console\n(?P<session>.*?)```",
    re.DOTALL,
)


class Command(NamedTuple):
    """A command of a page, what the page says that it prints, and what it printed."""

    line: str
    shown: str
    printed: str

    @property
    def is_as_shown(self) -> bool:
        parts = re.split(r"^…\n", self.shown, flags=re.MULTILINE)
        return re.fullmatch(".*?\n".join(map(re.escape, parts)), self.printed, re.DOTALL) is not None


def follow(page: str, folder: Path) -> list[Command]:
    """Take the steps of a page in a folder; return its commands."""
    commands = []
    for step in _STEP.finditer(page):
        if step["file"]:
            _write(folder / step["file"], step["text"], is_more=step["verb"] == "append")
        elif step["changed"]:
            _replace(folder / step["changed"], step["old"], step["new"])
        else:
            commands += [_run(*command, folder) for command in sessions(step["session"])]
    return commands


def renewed(page: str, commands: list[Command]) -> str:
    """Return the page with what its commands printed."""
    done, rest = "", page
    for command in commands:
        before, found, rest = rest.partition(f"$ {command.line}\n{command.shown}")
        assert found
        done += f"{before}$ {command.line}\n{command.shown if command.is_as_shown else command.printed}"
    return done + rest


def sessions(text: str) -> list[tuple[str, str]]:
    """Return each command of a block with what follows it."""
    return re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.MULTILINE)


def _write(file: Path, text: str, *, is_more: bool) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a" if is_more else "w", encoding="utf-8") as stream:
        stream.write(f"\n{text}" if is_more and not text.startswith(" ") else text)


def _replace(file: Path, old: str, new: str) -> None:
    text = file.read_text("utf-8")
    assert text.count(old) == 1, f"'{old}' is {text.count(old)} times in {file.name}"
    file.write_text(text.replace(old, new), "utf-8")


def _run(line: str, shown: str, folder: Path) -> Command:
    program, *words = shlex.split(line)
    assert program == "linkforge", f"'{line}' is not run: use a block of sh"
    done = linkforge(*words, cwd=folder)
    return Command(line, shown, done.stdout + done.stderr)
