"""The kinematic tree of a robot: link under link, each with the joint above it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_depth_first
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.robot import Robot


class TreeRow(NamedTuple):
    """A link in the tree, the joint above it, None for a root, and how many joints are above it.

    - `mass`: [kg], None for a link without inertia.
    - `modules`: the names of the modules that the link is in, the outermost first.
    - `is_again`: the link has another row, and this joint closes a loop or is a second joint to the link.
    - `hidden`: how many rows are below it that `cut_below` left out.
    """

    link: str
    joint: Joint | None
    depth: int
    mass: float | None
    modules: tuple[str, ...]
    is_again: bool = False
    hidden: int = 0


def tree_rows(robot: Robot) -> list[TreeRow]:
    """Return the links of a robot depth first: below the roots, then those to which only a loop leads."""
    above, below = parent_joints(robot.joints), child_joints(robot.joints)
    names = [link.name for link in robot.links]
    rows = []
    for visit in walk_depth_first((*(name for name in names if name not in above), *names), below):
        link = robot.get_link(visit.link)
        mass = link.inertial.mass if link and link.inertial else None
        modules = link.source.modules if link and link.source else ()
        rows.append(TreeRow(visit.link, visit.joint, visit.depth, mass, modules, visit.is_again))
    return rows


def cut_below(rows: Iterable[TreeRow], depth: int) -> list[TreeRow]:
    """Return the rows down to a depth; the last ones have the number of rows below them."""
    kept: list[TreeRow] = []
    for row in rows:
        if row.depth <= depth:
            kept.append(row)
        else:
            kept[-1] = kept[-1]._replace(hidden=kept[-1].hidden + 1)
    return kept


def tree_document(robot: Robot, rows: Iterable[TreeRow]) -> dict[str, object]:
    """Return the tree as values for JSON, with numbers in SI units and None for absent ones."""
    return {"version": 1, "name": robot.name, "links": list(map(_link_document, rows))}


def _link_document(row: TreeRow) -> dict[str, object]:
    document = {
        "name": row.link,
        "parent": row.joint.parent if row.joint else None,
        "depth": row.depth,
        "mass": row.mass,
        "modules": list(row.modules),
        "joint": dict(_joint_document(row.joint)) if row.joint else None,
    }
    marks = {"again": True} if row.is_again else {}
    return {**document, **marks, **({"hidden": row.hidden} if row.hidden else {})}


def _joint_document(joint: Joint) -> Iterator[tuple[str, object]]:
    yield "name", joint.name
    yield "type", str(joint.type)
    yield "axis", _list(joint.axis)
    yield "origin", {"xyz": _list(joint.origin.xyz), "rpy": _list(joint.origin.rpy)}
    limits, mimic = joint.limits, joint.mimic
    bounds = ("lower", "upper", "effort", "velocity")
    yield "limits", {name: getattr(limits, name) for name in bounds} if limits else None
    ratio = mimic and {"joint": mimic.joint, "multiplier": mimic.multiplier, "offset": mimic.offset}
    yield "mimic", ratio


def _list(vector: Vector3 | None) -> list[float] | None:
    return list(vector) if vector else None
