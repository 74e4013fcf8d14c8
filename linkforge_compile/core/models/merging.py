"""Steps of merging one robot into another: prefixes, materials without clashes, the connecting joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.material import Material
    from linkforge_compile.core.models.robot_parts import RobotParts

_KINDS = ("links", "joints", "sensors", "transmissions", "ros2_controls", "gazebo_elements")


def prefixed_parts(robot: RobotParts, prefix: str) -> dict[str, list[Any]]:  # Any: each kind has a class of its own
    """Return the parts of a robot by kind, with the prefix on their names and on the names that they refer to.

    Raises:
        RobotModelError: INVALID_NAME where the prefix makes a name that no part may have.

    """
    return {kind: [part.with_prefix(prefix) for part in getattr(robot, kind)] for kind in _KINDS}


def prefixed_materials(robot: RobotParts, prefix: str) -> dict[str, Material]:
    """Return the materials of a robot with the prefix on their names."""
    return {prefix + name: material.with_prefix(prefix) for name, material in robot.materials.items()}


def select_new_materials(added: Mapping[str, Material], own: Mapping[str, Material]) -> dict[str, Material]:
    """Return those of the added materials that are not among a robot's own, and those of its own that move.

    A material that both have is written after the links only if it is in both, so that their order does not matter.

    Raises:
        RobotValidationError: DUPLICATE_NAME for two different materials of one name.

    """
    for name, material in added.items():
        if name in own and own[name] != material:
            raise RobotValidationError(
                ValidationErrorCode.DUPLICATE_NAME,
                f"Duplicate material name: '{name}', for two different materials",
                target="Material",
                value=name,
            )
    return {
        name: replace(own[name], after_links=False) if name in own else material
        for name, material in added.items()
        if name not in own or own[name].after_links > material.after_links
    }


def complete_joint(connecting: Joint, joint: Joint) -> Joint:
    """Return the connecting joint with those fields of `joint` for which merging has no argument."""
    return replace(
        joint,
        name=connecting.name,
        type=connecting.type,
        parent=connecting.parent,
        child=connecting.child,
        origin=connecting.origin,
        axis=connecting.axis,
        limits=connecting.limits,
    )
