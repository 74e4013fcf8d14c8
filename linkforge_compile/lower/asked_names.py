"""The names that `link('x')` and `joint('x')` ask for, judged once all names of a file and its modules are there."""

from __future__ import annotations

from collections.abc import Iterable

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import UNKNOWN_JOINT, UNKNOWN_LINK
from linkforge_compile.expand.assembly import NameReference


def check_name_lookups(
    references: Iterable[NameReference], robot: Robot, unresolved: UnresolvedNames, sink: Diagnostics
) -> None:
    """Report every name that neither the file has nor its modules; `robot` has the names as the file sees them."""
    known = {"link": (robot.links.names, UNKNOWN_LINK), "joint": (robot.joints.names, UNKNOWN_JOINT)}
    for reference in references:
        names, code = known[reference.kind]
        if reference.name not in names and reference.name not in unresolved:
            why = unresolved.deleted.notes(reference.name)
            near = () if why else names
            sink.report(code.at(reference.where, name=reference.name, near=near, notes=why))
