"""Read joints of URDF, in the units of their motion."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.core.models.joint import HAVE_NO_AXIS, NEED_LIMITS, Joint, JointLimits, JointType
from linkforge_compile.diagnostics.codes.importing import ENDS_KEPT_RAW
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.importers.urdf.elements import Names, read_element, read_numbers, require_numbers
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.syntax import YamlMap, YamlNode

JOINT_TYPES = tuple(map(str, JointType))
_AXES: Mapping[tuple[float | None, ...], str] = {
    tuple(sign * (letter == name) for letter in "xyz"): f"{'-' if sign < 0 else ''}{name}"
    for name in "xyz"
    for sign in (1.0, -1.0)
}


def read_joint(joint: ElementReader, names: Names, blocks: Blocks) -> YamlMap:
    """Read a joint whose name is taken, with the Gazebo blocks about it; `names` has those of all joints."""
    kind = joint.required_text("type")
    if kind.text not in JOINT_TYPES:
        raise joint.cannot_represent(f"there is no type of joint named '{kind.text}'")
    joint_type = JointType(kind.text)
    return read_element(
        joint,
        Joint,
        joint_type.motion,
        names=names,
        type=lambda _: kind,
        axis=lambda joint: None if joint_type in HAVE_NO_AXIS else _axis_of(joint),
        limits=lambda joint: None if joint_type is JointType.FIXED else _limits_of(joint, joint_type),
        gazebo=lambda joint: blocks.take(joint.element.get("name") or ""),
    )


def _axis_of(joint: ElementReader) -> YamlNode | None:
    """Read the axis; a URDF without one means x, but the language requires it."""
    return joint.essential_child("axis", _axis) if joint.has_child("axis") else joint.draft.text("x", joint.span)


def _axis(axis: ElementReader) -> YamlNode:
    xyz = axis.numbers("xyz", 3)
    axis.pass_rest_up()
    if xyz is None:
        return axis.draft.text("x", axis.span)
    word = _AXES.get(tuple(map(number_of, (axis.element.get("xyz") or "").split())))
    return axis.draft.text(word, xyz) if word else xyz


def _limits_of(joint: ElementReader, joint_type: JointType) -> YamlNode | None:
    if joint_type in NEED_LIMITS:
        return joint.essential_child("limit", lambda limit: _limits(limit, joint_type))
    return joint.child("limit", lambda limit: _limits(limit, joint_type))


def _limits(limit: ElementReader, joint_type: JointType) -> YamlNode:
    lower, upper = (number_of(limit.element.get(name) or "0") for name in ("lower", "upper"))
    reversed_ends: tuple[str, ...] = ()
    if lower is not None and upper is not None and lower > upper:
        limit.draft.diagnostics.append(ENDS_KEPT_RAW.at(limit.span, lower=f"{lower:g}", upper=f"{upper:g}"))
        reversed_ends = ("lower", "upper")
    if joint_type not in NEED_LIMITS:
        require_numbers(limit, JointLimits)
    # If a joint needs limits, incomplete ones are read, and compiling the spec reports what they lack.
    return limit.map(**read_numbers(limit, JointLimits, joint_type.motion, without=reversed_ends))
