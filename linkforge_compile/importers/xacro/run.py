"""Run xacro on a file in a separate process with a time limit."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Timer
from typing import IO, NamedTuple, Protocol, TypedDict

MAX_SECONDS = 60
_MAX_CHARACTERS = 64 * 1024**2
_PROGRAM = Path(__file__).with_name("process.py")


class Answers(Protocol):
    """Answers the questions of the xacro process."""

    def find(self, name: str) -> Path | None:
        """Return the folder of a package, None if it is not found."""
        ...

    def may_read(self, path: Path) -> bool:
        """Whether a file or folder may be read."""
        ...


class Place(NamedTuple):
    """An element: the index of its file among the expanded ones, and its index there in document order."""

    file: int
    element: int


@dataclass(frozen=True)
class Expanded:
    """The result of expanding a file: XML in which every element is marked with its place.

    `files` are the expanded xacro files, the first one first, `read` the other files that were read. `arguments` has
    the place of each `<xacro:arg>`, `wanted` the names in `$(arg NAME)`, and `warnings` those of xacro.
    """

    text: str
    files: tuple[Path, ...]
    read: tuple[Path, ...]
    arguments: Mapping[str, Place]
    wanted: tuple[str, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Failed:
    """The reason why a file was not expanded.

    `reason` is the message of the exception of the class `kind`, None if xacro is not installed. The last of the
    `expressions` failed while the others, from the outside in, were evaluated. `missing` is a file that does not
    exist. `place` is the element at which xacro stopped, `line` a line of `file` with malformed XML; None if unknown.
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


def run_xacro(path: Path, arguments: Mapping[str, str], answers: Answers) -> Expanded | Failed:
    """Expand a xacro file.

    xacro evaluates the expressions of the file as Python code, so running it means trusting the file like a program.
    """
    command = [sys.executable, "-P", "-B", "-X", "utf8", str(_PROGRAM)]
    pipe, null = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=null, text=True, encoding="utf-8") as process:
        assert process.stdin, "it is a pipe"
        assert process.stdout, "it is a pipe"
        timer = Timer(MAX_SECONDS, process.kill)
        timer.start()
        try:
            _send(process.stdin, {"path": str(path.absolute()), "arguments": dict(arguments)})
            answer = _receive(process.stdout)
            while answer is not None and not answer.keys().isdisjoint(("find", "may_read")):
                _send(process.stdin, _reply(answer, answers))
                answer = _receive(process.stdout)
        except BrokenPipeError:
            answer = None
        finally:
            timed_out = not timer.is_alive()
            timer.cancel()
            process.kill()
    if answer is None:
        reason = f"it took more than {MAX_SECONDS} s" if timed_out else "it took too much memory, or gave too much"
        return Failed(reason)
    return _outcome(answer)


def _reply(question: _Answer, answers: Answers) -> str | bool | None:
    if "may_read" in question:
        return answers.may_read(Path(question["may_read"]))
    folder = answers.find(question["find"])
    return None if folder is None else str(folder.absolute())


def _send(stream: IO[str], message: object) -> None:
    stream.write(json.dumps(message) + "\n")
    stream.flush()


def _receive(stream: IO[str]) -> _Answer | None:
    line = stream.readline(_MAX_CHARACTERS)
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
    """Parse the mark of an element."""
    file, _, element = mark.partition(":")
    return Place(int(file), int(element))
