"""Joints as URDF writes them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint, JointMimic
from linkforge_compile.core.part import Element
from linkforge_compile.formats.element import attributes, elements, leaf_at, numbers_leaf, placed
from linkforge_compile.formats.urdf.link import origin
from linkforge_compile.formats.xml_text import NOTHING, Xml


class JointView(NamedTuple):
    """`<joint>`; its parts are nothing where they are not stated."""

    attributes: Xml
    origin: Xml
    parent: str
    child: str
    axis: Xml
    limit: Xml
    dynamics: Xml
    mimic: Xml
    safety_controller: Xml
    calibration: Xml
    elements: Xml


def joint_views(joints: Iterable[Joint], version: str | None) -> tuple[JointView, ...]:
    return tuple(
        JointView(
            attributes(joint, name=joint.name, type=joint.type),
            origin(joint.origin, version),
            placed(joint.parent, joint.source, "parent"),
            placed(joint.child, joint.source, "child"),
            _axis(joint),
            _part(joint.limits),
            _part(joint.dynamics),
            _mimic(joint.mimic),
            _part(joint.safety_controller),
            _part(joint.calibration),
            elements(joint),
        )
        for joint in joints
    )


def _axis(joint: Joint) -> Xml:
    axis = joint.axis_as_written or joint.axis
    return leaf_at("axis", joint.source, "axis", xyz=axis) if axis else NOTHING


def _part(part: Element | None) -> Xml:
    """Return an element whose fields are attributes; urdfdom refuses a `<dynamics>` that states neither of its two."""
    return numbers_leaf(part) if part else NOTHING


def _mimic(mimic: JointMimic | None) -> Xml:
    return numbers_leaf(mimic, joint=mimic.joint) if mimic else NOTHING
