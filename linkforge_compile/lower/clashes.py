"""Names of a module that are taken where it is used."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.names import MODULES_SHARE_NAMES, NAMES_OF_THIS_FILE
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.source import SourceRef


class Clash(NamedTuple):
    """A part of a module whose name another part has already.

    `part` is its kind and its final name, as messages say them. `owner` is the module that the first one came
    with, None for the file that uses both.
    """

    part: str
    owner: Instance | None
    first: SourceRef | None


def told_of_clashes(module: Instance, clashes: Iterable[Clash]) -> list[Diagnostic]:
    """Return what there is to tell of a module: once, at its prefix, for each module that it clashes with."""
    by_owner: dict[Instance | None, list[Clash]] = {}
    for clash in clashes:
        by_owner.setdefault(clash.owner, []).append(clash)
    return [_told(module, owner, each) for owner, each in by_owner.items()]


def _told(module: Instance, owner: Instance | None, clashes: list[Clash]) -> Diagnostic:
    part, more = clashes[0].part, len(clashes) - 1
    parts = f"{part} and {more} more" if more else part
    if owner is None:
        notes = [Note(f"{part} is here", first.span) for first in [clashes[0].first] if first]
        return NAMES_OF_THIS_FILE.at(module.entry, "prefix", module=module.name, parts=parts, notes=notes)
    notes = [Note(f"module '{owner.name}' is here", owner.entry.at("prefix"))] if owner.entry else []
    facts = {"first": owner.name, "second": module.name, "parts": parts}
    return MODULES_SHARE_NAMES.at(module.entry, "prefix", notes=notes, **facts)
