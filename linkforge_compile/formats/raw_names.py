"""Raw XML of a robot that names a link, joint or material as another one is named."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import RAW_NAME_IS_TAKEN
from linkforge_compile.formats.element import raw_texts

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.material import Material


def check_raw_names(robot: Robot) -> Iterator[Diagnostic]:
    """No two links, joints or materials of a URDF have one name: urdfdom refuses the robot."""
    named: Mapping[str, Iterable[Link | Joint | Material]] = {
        "link": robot.links,
        "joint": robot.joints,
        "material": robot.materials.values(),
    }
    taken = {
        (tag, part.name): part.source.span if part.source else None for tag, parts in named.items() for part in parts
    }
    for text, source, path in raw_texts(robot, robot.source):
        place = source.at(*path) if source else None
        for tag, name in _named_in(text):
            if tag not in named:
                continue
            if (tag, name) not in taken:
                taken[tag, name] = place
                continue
            first = taken[tag, name]
            notes = [Note("the other is here", first)] if first else []
            yield RAW_NAME_IS_TAKEN.at(source, *path, tag=tag, name=name, notes=notes)


def _named_in(text: str) -> Iterator[tuple[str, str]]:
    """Yield the tag and name of each element of raw XML that has one."""
    from linkforge_compile.formats.raw import well_formed_nodes

    for node in well_formed_nodes(text):
        yield from ((node.tag, value) for key, value in node.attributes if key == "name")
