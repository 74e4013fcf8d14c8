"""Show values and where they come from, for each use of the file and each copy of a part."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.expand.values import find_name_origins
from linkforge_compile.export_spec import Explanation, UnknownPathError, explain
from linkforge_compile.export_spec.explanation_lines import name_lines, origin_lines
from linkforge_compile.lsp.hover.text import MAX_SHOWN, and_more, code, code_block
from linkforge_compile.lsp.placed import Placed, placed_at
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.source import Position, Span
from linkforge_compile.source.provenance import WORDS, Kind
from linkforge_compile.syntax import YamlNode, YamlScalar
from linkforge_compile.units import Quantity, parse_quantity


class Shown(NamedTuple):
    """A value and where it comes from; both are empty if nothing is to tell but what is written there."""

    value: str
    origins: tuple[str, ...]


def show_values(document: Document, at: Position) -> str:
    """Return the values of a position with their origins; "" if nothing is to tell but what is written there."""
    placed = list(placed_at(document, at))
    by_text: dict[Shown, list[str]] = {}
    for one in placed[:MAX_SHOWN]:
        shown = value_of(one, at)
        if shown.value:
            by_text.setdefault(shown, []).append(one.robot_path)
    lines = [_show(shown, paths, is_alone=len(placed) == 1) for shown, paths in by_text.items()]
    return "\n\n".join(filter(None, (*lines, and_more(len(placed) - MAX_SHOWN) if lines else "")))


def _show(shown: Shown, paths: list[str], *, is_alone: bool) -> str:
    label = "" if is_alone else f"{', '.join(map(code, paths))}: "
    return "\n\n".join(filter(None, (f"{label}{shown.value}", code_block(shown.origins))))


def value_of(one: Placed, at: Position) -> Shown:
    """Return the value of a node in SI and as written, and its origins but for the position itself and its uses."""
    if not isinstance(one.node, YamlScalar):
        explanation = _explained(one) if one.key is None else None
        return Shown(code(_value(explanation)), _origins(explanation, one, at)) if explanation else Shown("", ())
    if one.node.value is None:
        return Shown("", ())
    explanation = _explained(one)
    in_si, written = (_value(explanation) if explanation else "") or in_si_of(one.node), written_of(one.node)
    origins = _origins(explanation, one, at)
    if not origins and in_si in ("", written):
        return Shown("", ())
    is_short = not written or in_si == written or isinstance(one.node.value, int | float)
    value = code(in_si or written) if is_short else f"{code(written)} = {code(in_si)}"
    return Shown(value, origins)


def in_si_of(node: YamlNode) -> str:
    """Return the value of a quantity in SI units; "" for anything else."""
    value = quantity_of(node)
    return value.in_si if value else ""


def quantity_of(node: YamlNode) -> Quantity | None:
    """Return the quantity that a node is, written or computed; None for anything else."""
    if not isinstance(node, YamlScalar):
        return None
    if isinstance(node.value, Quantity):
        return node.value
    return parse_quantity(node.value) if isinstance(node.value, str) else None


def written_of(node: YamlScalar) -> str:
    """Return a value with the unit that it is written in; "" for a computed one without."""
    if isinstance(node.value, Quantity):
        return node.value.written or ""
    return node.text


def _value(explanation: Explanation) -> str:
    """Return the value of an explanation that is one line."""
    first, _, rest = explanation.text.partition("\n")
    return "" if rest else first.partition(": ")[2]


def _explained(one: Placed) -> Explanation | None:
    """Return the explanation of a value; None if it has no place in the finished robot."""
    if one.use.analysis.robot is None:
        return None
    try:
        return explain(one.use.analysis.robot, one.robot_path)
    except (UnknownPathError, RobotGeneratorError):
        return None


def _origins(explanation: Explanation | None, one: Placed, at: Position) -> tuple[str, ...]:
    if explanation is None or explanation.provenance is None:
        names = find_name_origins(one.node) if one.key is None else ()
        return tuple(line for name in names for line in name_lines(name))
    own = explanation.provenance.span
    is_here = own.start <= at <= own.end or (one.key is not None and one.key.span.end <= own.start)
    is_here = is_here and own.file is one.span.file

    def place_lines(what: str, place: Span) -> Iterator[str]:
        is_known = what == WORDS[Kind.USE].sentence or (is_here and place == own)
        if not is_known:
            yield f"{what} at {place}"

    return tuple(origin_lines(explanation, place_lines)) if explanation.is_written else ()
