"""Show beside what is written what it becomes: values in SI, computed masses, and final names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from lsprotocol import types

from linkforge_compile.export_spec.explain import computed_from
from linkforge_compile.lsp.hover.values import in_si_of
from linkforge_compile.lsp.occurrences import DECLARING
from linkforge_compile.lsp.placed import Placed, placed_in
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.overview.joint_text import short
from linkforge_compile.source import Position, Span

_MAX_SHOWN = 3


class HintOptions(NamedTuple):
    """Which hints an editor wants; none unless it says so."""

    si: bool = False
    mass: bool = False
    names: bool = False

    @classmethod
    def of(cls, settings: object) -> HintOptions:
        """Return the options in the settings of an editor: `{"inlayHints": {"si": true}}`."""
        found = settings.get("inlayHints") if isinstance(settings, dict) else None
        wanted = found if isinstance(found, dict) else {}
        return cls(*(wanted.get(name) is True for name in cls._fields))


def inlay_hints(document: Document, start: Position, end: Position, options: HintOptions) -> list[types.InlayHint]:
    """Return the hints on the lines between two positions; one for all uses of the file and copies of a part."""
    if not any(options):
        return []
    labels: dict[tuple[Position, bool], tuple[Span, dict[str, None]]] = {}
    for one in placed_in(document, start, end):
        for text in _labels(one, options):
            place = labels.setdefault((one.span.end, one.key is None), (one.span, {}))
            place[1][text] = None
    return [_hint(document, span, list(texts)) for span, texts in labels.values()]


def _labels(one: Placed, options: HintOptions) -> Iterator[str]:
    if one.key is None:
        if options.si and (in_si := in_si_of(one.node)) and in_si != one.span.text:
            yield f"= {in_si}"
        return
    if one.path[:-1] in DECLARING:
        if options.names and one.use.prefix:
            yield f"{one.use.prefix}{one.path[-1]}"
        if options.mass and one.path[0] == "links":
            yield from _mass(one)


def _mass(one: Placed) -> Iterator[str]:
    robot, name = one.use.analysis.robot, f"{one.use.prefix}{one.path[-1]}"
    if robot is not None and computed_from(robot, ("links", name, "inertial")) is not None:
        inertial = robot.link(name).inertial
        assert inertial is not None, "it was computed"
        moments = (inertial.inertia.ixx, inertial.inertia.iyy, inertial.inertia.izz)
        yield f"{short(inertial.mass)} kg, inertia {', '.join(map(short, moments))} kg·m²"


def _hint(document: Document, span: Span, texts: list[str]) -> types.InlayHint:
    shown = [*texts[:_MAX_SHOWN], *(["…"] if len(texts) > _MAX_SHOWN else [])]
    return types.InlayHint(document.columns.range(span).end, ", ".join(shown), padding_left=True)
