"""Elements that URDF readers ignore: the axis of a joint that has none, the material of a collision."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TypeVar

from linkforge_compile.core import Robot
from linkforge_compile.core.models.joint import HAVE_NO_AXIS, HAVE_NO_LIMITS, Joint
from linkforge_compile.core.models.link import Collision, Link
from linkforge_compile.source.xml_tree import first_tag

_OF_JOINTS: Mapping[str, frozenset[str]] = {
    str(kind): frozenset(tag for tag, kinds in (("axis", HAVE_NO_AXIS), ("limit", HAVE_NO_LIMITS)) if kind in kinds)
    for kind in {*HAVE_NO_AXIS, *HAVE_NO_LIMITS}
}
_IN: Mapping[str, frozenset[str]] = {"collision": frozenset(("material",)), "link": frozenset(("gazebo",))}
PLACES = {"material": "a collision", "gazebo": "a link"}
"""In what an element has no effect, by its tag."""

_NAME = re.compile(r"""\sname\s*=\s*["']([^"']+)""")

P = TypeVar("P", Joint, Link, Collision)


def without_effect(tag: str, kind: str = "") -> frozenset[str]:
    """Return the tags that readers ignore in an element; `kind` is the type of a joint."""
    return _OF_JOINTS.get(kind, frozenset()) if tag == "joint" else _IN.get(tag, frozenset())


def leave_out(robot: Robot) -> None:
    """Remove these elements, which are raw XML there, from a robot.

    MuJoCo takes the color of a material that a visual only names from any other one of that name. So what declares
    such a material in a collision stays, and is a difference from specs without it.
    """
    visuals = (visual for link in robot.links for visual in link.visuals)
    named = frozenset(name for visual in visuals for text in visual.extra_elements if (name := _material_in(text)))
    robot.joints = [_without(joint, without_effect("joint", str(joint.type))) for joint in robot.joints]
    robot.links = [_without(_with_plain_collisions(link, named), without_effect("link")) for link in robot.links]


def _with_plain_collisions(link: Link, named: frozenset[str]) -> Link:
    collisions = [_without(one, without_effect("collision"), named) for one in link.collisions]
    return link if collisions == [*link.collisions] else replace(link, collisions=collisions)


def _material_in(text: str) -> str | None:
    """Return the name of the material that raw XML is; None for other elements."""
    found = _NAME.search(text) if first_tag(text) == "material" else None
    return found and found[1]


def _without(part: P, tags: frozenset[str], named: frozenset[str] = frozenset()) -> P:
    kept = [text for text in part.extra_elements if first_tag(text) not in tags or _material_in(text) in named]
    return part if len(kept) == len(part.extra_elements) else replace(part, extra_elements=kept)
