"""Runs xacro on a file, in a process of its own that ends after a time whatever the file does."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Timer
from typing import IO, NamedTuple, Protocol, TypedDict

MOST_SECONDS = 60
_MOST_CHARACTERS = 64 * 1024**2
_PROGRAM = Path(__file__).with_name("process.py")


class Asked(Protocol):
    """What xacro asks on its way."""

    def find(self, name: str) -> Path | None:
        """Return the folder of a package, None where it is nowhere."""
        ...

    def may_read(self, path: Path) -> bool:
        """Whether a file or folder may be read."""
        ...


class Place(NamedTuple):
    """An element: the file, as a position among those that were expanded, and its number there in document order."""

    file: int
    element: int


@dataclass(frozen=True)
class Expanded:
    """What xacro made of a file: XML in which every element is marked with its place.

    `files` are the xacro files that were expanded, the first one first, `read` the others that were read. `arguments`
    has each `<xacro:arg>`, `wanted` the names in `$(arg NAME)`, and `warnings` what xacro said.
    """

    text: str
    files: tuple[Path, ...]
    read: tuple[Path, ...]
    arguments: Mapping[str, Place]
    wanted: tuple[str, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Failed:
    """Why there is no expansion.

    `reason` is None where xacro is not installed, and `kind` the class of the exception that says it. The last of the
    `expressions` failed, which each of the others led to; `missing` is a file that is not there. `place` is the element
    at which xacro stopped, `line` a line of `file` where XML is malformed; None where nobody knows.
    """

    reason: str | None
    files: tuple[Path, ...] = ()
    read: tuple[Path, ...] = ()
    arguments: Mapping[str, Place] | None = None
    wanted: tuple[str, ...] = ()
    place: Place | None = None
    file: Path | None = None
    line: int | None = None
    kind: str = ""
    expressions: tuple[str, ...] = ()
    missing: Path | None = None


class _Answer(TypedDict, total=False):
    find: str
    may_read: str
    missing: bool
    text: str
    error: str
    kind: str
    expressions: list[str]
    missing_file: str | None
    file: str
    line: int | None
    files: list[str]
    read: list[str]
    arguments: dict[str, str]
    wanted: list[str]
    warnings: list[str]
    place: str | None


def run_xacro(path: Path, arguments: Mapping[str, str], asked: Asked) -> Expanded | Failed:
    """Expand a xacro file.

    xacro computes the expressions of the file in Python: whoever runs it trusts the file as he trusts a program.
    """
    command = [sys.executable, "-P", "-B", "-X", "utf8", str(_PROGRAM)]
    pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=nothing, text=True, encoding="utf-8") as process:
        assert process.stdin, "it is a pipe"
        assert process.stdout, "it is a pipe"
        timer = Timer(MOST_SECONDS, process.kill)
        timer.start()
        try:
            _say(process.stdin, {"path": str(path.absolute()), "arguments": dict(arguments)})
            answer = _heard(process.stdout)
            while answer is not None and not answer.keys().isdisjoint(("find", "may_read")):
                _say(process.stdin, _reply(answer, asked))
                answer = _heard(process.stdout)
        except BrokenPipeError:
            answer = None
        finally:
            is_late = not timer.is_alive()
            timer.cancel()
            process.kill()
    if answer is None:
        return Failed(f"it took more than {MOST_SECONDS} s" if is_late else "it took too much memory, or gave too much")
    return _outcome(answer)


def _reply(question: _Answer, asked: Asked) -> str | bool | None:
    if "may_read" in question:
        return asked.may_read(Path(question["may_read"]))
    folder = asked.find(question["find"])
    return None if folder is None else str(folder.absolute())


def _say(stream: IO[str], message: object) -> None:
    stream.write(json.dumps(message) + "\n")
    stream.flush()


def _heard(stream: IO[str]) -> _Answer | None:
    line = stream.readline(_MOST_CHARACTERS)
    if not line.endswith("\n"):
        return None
    answer: _Answer = json.loads(line)
    return answer


def _outcome(answer: _Answer) -> Expanded | Failed:
    if answer.get("missing"):
        return Failed(None)
    files, read = tuple(map(Path, answer["files"])), tuple(map(Path, answer["read"]))
    arguments = {name: place_of(place) for name, place in answer["arguments"].items()}
    wanted = tuple(answer["wanted"])
    if "text" in answer:
        return Expanded(answer["text"], files, read, arguments, wanted, tuple(answer["warnings"]))
    place, file = answer.get("place"), answer.get("file")
    return Failed(
        answer["error"],
        files,
        read,
        arguments,
        wanted,
        place_of(place) if place else None,
        Path(file) if file else None,
        answer.get("line"),
        answer.get("kind", ""),
        tuple(answer.get("expressions", ())),
        Path(missing) if (missing := answer.get("missing_file")) else None,
    )


def place_of(mark: str) -> Place:
    """Read the mark of an element."""
    file, _, element = mark.partition(":")
    return Place(int(file), int(element))
