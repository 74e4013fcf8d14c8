"""Run xacro in a separate process, and trace its output to the places in the source."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Timer
from types import MappingProxyType
from typing import IO, NamedTuple, TypedDict

from linkforge_compile.importers.xacro.answers import XacroAnswers
from linkforge_compile.importers.xacro.process import MARK
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import Bounds, XmlAttribute, XmlComment, XmlContent, XmlDocument, XmlElement

MAX_SECONDS = 60
_MAX_CHARACTERS = 64 * 1024**2
_PROGRAM = Path(__file__).with_name("process.py")


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


class MacroCall(NamedTuple):
    """A call of a macro of a file: the values of its parameters, and the XML of its blocks in the order declared.

    `expressions` are further values, which xacro evaluates; they are ours.
    """

    macro: str
    values: Mapping[str, str]
    blocks: tuple[str, ...]
    expressions: Mapping[str, str] = MappingProxyType({})

    @property
    def request(self) -> dict[str, object]:
        # What the user wrote is data, in which xacro evaluates nothing.
        values = {name: _escaped(value) for name, value in self.values.items()} | dict(self.expressions)
        return {"macro": self.macro, "values": values, "blocks": [one.replace("$", _DOLLAR) for one in self.blocks]}


_DOLLAR = "\ufdd0"
"""Stands for `$` in a block, which xacro evaluates once more at each macro that passes it on."""


def _escaped(text: str) -> str:
    return re.sub(r"\$+(?=[{(])", r"$\g<0>", text)


def run_xacro(
    path: Path, arguments: Mapping[str, str], answers: XacroAnswers, call: MacroCall | None = None
) -> Expanded | Failed:
    """Expand a xacro file, or one call of a macro that it declares.

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
            _send(
                process.stdin,
                {"path": str(path.absolute()), "arguments": dict(arguments), "call": call and call.request},
            )
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


def _reply(question: _Answer, answers: XacroAnswers) -> str | bool | None:
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
    arguments = {name: parse_mark(place) for name, place in answer["arguments"].items()}
    wanted = tuple(answer["wanted"])
    if "text" in answer:
        text = answer["text"].replace(_DOLLAR, "$")
        return Expanded(text, files, read, arguments, wanted, tuple(answer["warnings"]))
    place, file = answer.get("place"), answer.get("file")
    return Failed(
        answer["error"],
        files,
        read,
        arguments,
        wanted,
        parse_mark(place) if place else None,
        Path(file) if file else None,
        answer.get("line"),
        answer.get("kind", ""),
        tuple(answer.get("expressions", ())),
        Path(missing) if (missing := answer.get("missing_file")) else None,
    )


def parse_mark(mark: str) -> Place:
    """Parse the mark of an element."""
    file, _, element = mark.partition(":")
    return Place(int(file), int(element))


_MARK = re.compile(rf'\s{MARK}(?:="[0-9:]*"|(?=-->))')
_FOLLOWS = f" {MARK}"

Find = Callable[[Place], XmlElement | None]
"""Returns the element at a place as written; None if its file cannot be read."""


def moved_back(document: XmlDocument, find: Find) -> XmlDocument:
    """Return a document without the marks of `process`, with the spans of the elements and attributes as written."""
    root = _moved(document.root, find, None)
    return XmlDocument(root, tuple(root if item is document.root else item for item in document.content))


class _Moved(XmlElement):
    """An element with the span of another; its attributes and raw text are given, not parsed."""

    _span: Span
    _attributes: Mapping[str, XmlAttribute]
    _raw: str

    @classmethod
    def to(cls, span: Span, attributes: Mapping[str, XmlAttribute], raw: str, expanded: XmlElement) -> _Moved:
        made = cls(*expanded)
        made._span, made._attributes, made._raw = span, attributes, raw
        return made

    def with_content(
        self, values: Mapping[str, str], content: tuple[XmlContent, ...], children: tuple[XmlElement, ...], text: str
    ) -> XmlElement:
        attributes = {name: XmlAttribute(name, values[name], old.bounds) for name, old in self._attributes.items()}
        changed = self._replace(values=values, content=content, children=children, text=text)
        return _Moved.to(self._span, attributes, self._raw, changed)

    @property
    def bounds(self) -> Bounds:
        return self._span, 0, 0

    @property
    def attributes(self) -> dict[str, XmlAttribute]:
        return dict(self._attributes)

    @property
    def raw(self) -> str:
        return self._raw


def _moved(element: XmlElement, find: Find, around: Span | None) -> XmlElement:
    mark = element.get(MARK)
    written = find(parse_mark(mark)) if mark else None
    span = written.span if written else around or element.span
    known = written.attributes if written else {}
    values = {name: value for name, value in element.values.items() if name != MARK}
    attributes = {
        name: XmlAttribute(name, value, known[name].bounds if name in known else (span, 0, 0))
        for name, value in values.items()
    }
    content = tuple(_content(item, find, span) for item in element.content)
    children = tuple(item for item in content if isinstance(item, XmlElement))
    expanded = element._replace(values=values, content=content, children=children)
    return _Moved.to(span, attributes, _MARK.sub("", element.raw), expanded)


def _content(item: XmlContent, find: Find, span: Span) -> XmlContent:
    if isinstance(item, XmlElement):
        return _moved(item, find, span)
    if isinstance(item, XmlComment):
        return XmlComment(item.text.removesuffix(_FOLLOWS), span, follows=item.text.endswith(_FOLLOWS))
    return item


_NO_YAML = "'{1}' is not YAML: {0} (line {2}, column {3})"

_MESSAGES = (
    (r"Undefined parameters \[(.*)\]", "the macro also takes {0}, which this call does not give"),
    (r'Invalid parameter "(.*)"', "the macro takes no '{0}'"),
    (r"Not enough blocks", "the macro takes a block more, an element inside of the call"),
    (r'Unused block "(.*)"', "the macro takes no block, found <{0}>"),
    (r'Undefined block "(.*)"', "no block of the macro is named '{0}'"),
    (r'Xacro conditional "(.*)" evaluated to "(.*)", which.*', "the condition is true or false, found '{1}'"),
    (r"unsupported operand type\(s\) for (\S+).*: .*'str'.*", "'{0}' takes numbers, found a text"),
    (r"can't multiply sequence by non-int of type 'float'", "'*' takes numbers, found a text"),
    (r"environment variable '(.*)' is not set", "the environment variable {0} is not set"),
    (
        r"Unknown substitution command \[(.*?)\].*",
        "'$({0})' is none of $(arg), $(find), $(dirname), $(env), $(optenv)",
    ),
    (r'while .* in ".*", line \d+, column \d+ (.*) in "(.*)", line (\d+), column (\d+)', _NO_YAML),
    (r"xacro:arg: missing attribute 'default'", "<xacro:arg> needs 'default', also where a value is given; write one"),
    (r"xacro:(\w+): missing attribute '(\w+)'", "<xacro:{0}> has no attribute '{1}'"),
)
"""Patterns of xacro's messages and our wording; other messages are shown as they are."""


def plain_message(reason: str, kind: str) -> str:
    """Return a message of xacro in plain words, as it is if there are none for it."""
    line = " ".join(reason.split())
    for pattern, words in _MESSAGES:
        if found := re.fullmatch(pattern, line):
            return words.format(*found.groups())
    return f"there is no key {line}" if kind == "KeyError" else line
