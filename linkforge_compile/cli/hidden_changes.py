"""Mark the changes of an imported spec that overrides in the specs that use it hide."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from linkforge_compile.export_spec import UnknownPathError, explain
from linkforge_compile.export_spec.replacements import Replacement, replacements_in
from linkforge_compile.roots import identity

if TYPE_CHECKING:
    from linkforge_compile.compare import Difference
    from linkforge_compile.core import Robot
    from linkforge_compile.source import Span


def with_hidden_marked(
    differences: Iterable[Difference], imported: Robot, users: Iterable[Robot]
) -> tuple[Difference, ...]:
    """Return the differences of `imported` from what it was; a changed value names the overrides that hide it."""
    replacements = [one for user in users for one in replacements_in(user)]
    return tuple(_marked(one, imported, replacements) if one.kind == "changed" else one for one in differences)


def _marked(difference: Difference, imported: Robot, replacements: Sequence[Replacement]) -> Difference:
    # Explaining a value takes long, and most have no override.
    same_key = [one for one in replacements if one.key in difference.path]
    place = _written_place("/".join(difference.path), imported) if same_key else None
    if place is None:
        return difference
    hiding = [one.value for one in same_key if _is_in(place, one.replaced)]
    places = dict.fromkeys(f"{span.file.shown}:{span.line}" for span in hiding)
    if not places:
        return difference
    overrides = "override" if len(places) == 1 else "overrides"
    return replace(difference, text=f"{difference.text}, hidden by the {overrides} at {', '.join(places)}")


def _written_place(path: str, robot: Robot) -> Span | None:
    try:
        explanation = explain(robot, path)
    except UnknownPathError:
        return None
    return explanation.provenance.span if explanation.is_written and explanation.provenance else None


def _is_in(place: Span, other: Span) -> bool:
    """Whether a place lies in another one, which another compile has read."""
    file, other_file = place.file.path, other.file.path
    if file is None or other_file is None or identity(file) != identity(other_file):
        return False
    return other.start <= place.start and place.end <= other.end
