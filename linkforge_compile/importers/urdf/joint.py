"""Joints of URDF, in the units of their motion."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from linkforge_compile.core.models.joint import (
    HAVE_NO_AXIS,
    NEED_LIMITS,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics.codes.importing import ENDS_KEPT_RAW
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError, number_of
from linkforge_compile.importers.urdf.elements import read_element, read_numbers, require_numbers
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.importers.urdf.geometry import read_origin
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Motion

TYPES_OF_JOINTS = tuple(map(str, JointType))
_AXES: Mapping[tuple[float | None, ...], str] = {
    tuple(sign * (letter == name) for letter in "xyz"): f"{'-' if sign < 0 else ''}{name}"
    for name in "xyz"
    for sign in (1.0, -1.0)
}


def read_joint(joint: ElementReader, joints: Collection[str], blocks: Blocks) -> YamlMap:
    """Read a joint, whose name is taken; `blocks` has what a simulator is told about it.

    `joints` are the names of all joints: what names another cannot be said.
    """
    kind = joint.required_text("type")
    if kind.text not in TYPES_OF_JOINTS:
        raise joint.cannot_represent(f"there is no type of joint named '{kind.text}'")
    joint_type = JointType(kind.text)
    motion = joint_type.motion
    parent, child = joint.required("parent", _link), joint.required("child", _link)
    return joint.map(
        type=kind,
        parent=parent,
        child=child,
        origin=joint.child("origin", read_origin),
        axis=None if joint_type in HAVE_NO_AXIS else _axis_of(joint),
        limits=None if joint_type is JointType.FIXED else _limits_of(joint, joint_type),
        dynamics=_part(joint, JointDynamics, motion),
        mimic=joint.child("mimic", lambda mimic: _mimic(mimic, motion, joints)),
        safety_controller=_part(joint, JointSafetyController, motion),
        calibration=_part(joint, JointCalibration, motion),
        gazebo=blocks.beside(joint.element.get("name") or ""),
    )


def _part(joint: ElementReader, kind: type[Element], motion: Motion) -> YamlNode | None:
    return joint.child(kind.TAG, lambda part: read_element(part, kind, motion))


def _link(end: ElementReader) -> YamlNode:
    link = end.required_text("link")
    end.pass_rest_up()
    return link


def _axis_of(joint: ElementReader) -> YamlNode | None:
    """Read the axis; URDF's is x where nothing is said, and the language wants it said."""
    return joint.essential_child("axis", _axis) if joint.has_child("axis") else joint.draft.text("x", joint.span)


def _axis(axis: ElementReader) -> YamlNode:
    xyz = axis.numbers("xyz", 3)
    axis.pass_rest_up()
    if xyz is None:
        return axis.draft.text("x", axis.span)
    letter = _AXES.get(tuple(map(number_of, (axis.element.get("xyz") or "").split())))
    return axis.draft.text(letter, xyz) if letter else xyz


def _limits_of(joint: ElementReader, joint_type: JointType) -> YamlNode | None:
    take = joint.essential_child if joint_type in NEED_LIMITS else joint.child
    return take("limit", lambda limit: _limits(limit, joint_type))


def _limits(limit: ElementReader, joint_type: JointType) -> YamlNode:
    lower, upper = (number_of(limit.element.get(name) or "0") for name in ("lower", "upper"))
    crossed: tuple[str, ...] = ()
    if lower is not None and upper is not None and lower > upper:
        limit.draft.diagnostics.append(ENDS_KEPT_RAW.at(limit.span, lower=f"{lower:g}", upper=f"{upper:g}"))
        crossed = ("lower", "upper")
    if joint_type not in NEED_LIMITS:
        require_numbers(limit, JointLimits)
    # Limits that must be there are no better raw: the joint would have none. What they lack is told when compiled.
    return limit.map(**read_numbers(limit, JointLimits, joint_type.motion, without=crossed))


def _mimic(mimic: ElementReader, motion: Motion, joints: Collection[str]) -> YamlNode:
    joint = mimic.attribute("joint")
    if joint.value not in joints:
        raise CannotRepresentError(f"there is no joint named '{joint.value}'", joint.span)
    return mimic.map(
        joint=mimic.draft.text(joint.value, joint.span),
        **read_numbers(mimic, JointMimic, motion),
    )
