"""Raw XML and attributes of a URDF, which formats of other languages leave out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.exceptions import FieldPath
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.formats.element import Extended, place_of_attribute, raw_texts
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.parts import Held

_WITHOUT_LOSS = ("xmlns", "quat_xyzw")
"""Raw attributes that only a URDF needs: namespaces, and a turn that `rpy` has as well."""


class LostXml(NamedTuple):
    """The name of a part with raw XML, and where that was written."""

    name: str
    source: SourceRef | None
    path: FieldPath


def lost_xml(robot: Robot, parts: Iterable[Held]) -> Iterator[LostXml]:
    """Yield the first raw XML or attribute of the robot and of each part; `parts` has what is inside, too.

    What fixed joints have is an axis, limits or whether to keep the joint, none of which is a loss.
    """
    yield from _first(robot, robot.name, robot.source)
    for held in parts:
        if any(isinstance(part, Joint) and part.type == JointType.FIXED for part in (held.part, *held.around)):
            continue
        names = (getattr(part, "name", None) for part in (held.part, *reversed(held.around)))
        yield from _first(held.part, next(filter(None, names), robot.name), held.where)


def _first(part: Extended, name: str, where: SourceRef | None) -> Iterator[LostXml]:
    for _, place, keys in raw_texts(part, where):
        yield LostXml(name, place, keys)
        return
    for attribute, _ in attribute_pairs(part.extra_attributes):
        if not attribute.startswith(_WITHOUT_LOSS):
            source, *path = place_of_attribute(attribute, where)
            yield LostXml(name, source, (*path, attribute))
            return
