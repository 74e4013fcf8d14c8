"""What `extra_inside` says of elements that no part makes by itself: laid into them once they are written.

A part's template places its marks, a line each, last in its element; so what is inside stands above.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TypeAlias

from linkforge_compile.core.part import Inside
from linkforge_compile.formats.element import InsideError, attributes, raw
from linkforge_compile.formats.marks import MARK as SOURCE_MARK
from linkforge_compile.formats.markup import MARK, Xml, escaped, is_closing, is_opening

Mark: TypeAlias = "tuple[str, str | None, str, list[str], list[Mark]]"
"""Tag and name of an element inside, its attributes as text, the lines of its elements, and what is inside of it."""

_ATTRIBUTE = re.compile(r'\s([^\s=]+)="([^"]*)"')


def marks_of(insides: Iterable[Inside]) -> Iterator[Xml]:
    """Yield a line for each, which `with_insides` takes out again.

    Raises:
        RobotGeneratorError: for raw XML that is not well-formed, and for what cannot be the name of an attribute.

    """
    return (Xml(MARK + json.dumps(_mark(one))) for one in insides)


def inside_key(tag: str, name: str | None) -> str:
    """Return the key by which `extra_inside` says an element: its tag, and its name if any."""
    return tag if name is None else f"{tag} {name}"


def _mark(one: Inside) -> Mark:
    lines = [line for line in raw(one).split("\n") if line]
    return one.tag, one.name, str(attributes(one)), lines, [_mark(inner) for inner in one.extra_inside]


def with_insides(text: str) -> str:
    """Return a rendered document with its marks laid into the elements that they speak of.

    Raises:
        InsideError: where there is no such element, or more than one, or it has the attribute already.

    """
    lines: list[str] = []
    starts: list[int] = []
    faults: list[InsideError] = []
    for line in filter(None, map(str.strip, text.split("\n"))):
        if line.startswith(MARK):
            mark: Mark = json.loads(line.removeprefix(MARK))
            try:
                _lay(lines, starts[-1], mark)
            except InsideError as error:
                error.mark, error.key = line, inside_key(mark[0], mark[1])
                faults.append(error)
            continue
        if is_closing(line):
            starts.pop()
        elif is_opening(line):
            starts.append(len(lines))
        lines.append(line)
    if faults:
        faults[0].others = tuple(faults[1:])
        raise faults[0]
    return "\n".join(lines)


def _lay(lines: list[str], start: int, mark: Mark) -> None:
    tag, name, extra, elements, insides = mark
    place = _place_of(lines, start, tag, name)
    lines[place] = _extended(lines[place], extra)
    for inner in insides:
        _lay(lines, place, inner)
    if elements:
        _fill(lines, place, elements)


def _fill(lines: list[str], place: int, elements: list[str]) -> None:
    """Put elements behind what the element at a place holds."""
    line = lines[place]
    if is_opening(line):
        depth = 1
        while depth:
            place += 1
            depth += is_opening(lines[place]) - is_closing(lines[place])
        lines[place:place] = elements
    elif line.endswith("/>"):
        lines[place : place + 1] = [f"{line[:-2]}>", *elements, f"</{_tag(line)}>"]
    else:
        # Text and elements side by side are one line: whatever stood between them would be text.
        text, end = line[: line.rindex("</")], line[line.rindex("</") :]
        lines[place] = "".join([text, *elements, end])


def _place_of(lines: Sequence[str], start: int, tag: str, name: str | None) -> int:
    """Return where the one element begins that stands in the one at `start` and has the tag, and the name if any."""
    there = dict(_children(lines, start))
    found = [place for place, child in there.items() if child == tag]
    if name is not None:
        found = [place for place in found if _is_named(lines[place], name)]
    said = inside_key(tag, name)
    if not found:
        known = ", ".join(dict.fromkeys(f"'{child}'" for child in there.values())) or "nothing"
        raise InsideError(f"there is no '{said}' inside of <{_tag(lines[start])}>, which has {known}")
    if len(found) > 1:
        raise InsideError(f"there are {len(found)} of '{said}'; say which by its name, as in '{tag} NAME'")
    return found[0]


def _children(lines: Sequence[str], start: int) -> Iterator[tuple[int, str]]:
    depth = 0
    for place in range(start + 1, len(lines) if is_opening(lines[start]) else start + 1):
        line = lines[place]
        depth -= is_closing(line)
        if depth < 0:
            return
        if not depth and not is_closing(line) and line[1] not in "!?":
            yield place, _tag(line)
        depth += is_opening(line)


def _tag(line: str) -> str:
    return re.split(r"[\s/>]", line[1:], maxsplit=1)[0]


def _is_named(line: str, name: str) -> bool:
    said = escaped(name)
    start, _, rest = SOURCE_MARK.sub("", line).partition(">")
    told = (value for attribute, value in _ATTRIBUTE.findall(start) if attribute in {"name", "link"})
    return said in told or rest.partition("</")[0] == said


def _extended(line: str, extra: str) -> str:
    """Return an element's first line with more attributes; a `>` in one of them is a reference."""
    start = line[: line.index(">")].removesuffix("/")
    known = {name for name, _ in _ATTRIBUTE.findall(start)}
    for name, _ in _ATTRIBUTE.findall(extra):
        if name in known:
            raise InsideError(f"the attribute '{name}' of <{_tag(line)}> is stated twice")
    return f"{start}{extra}{line[len(start) :]}"
