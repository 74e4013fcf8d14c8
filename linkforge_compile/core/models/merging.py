"""What joining one robot to another needs to know beforehand, so that it happens as a whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.core.prefixing import prefixed_copies

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement
    from linkforge_compile.core.models.inventory import Inventory
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.material import Material
    from linkforge_compile.core.models.ros2_control import Ros2Control
    from linkforge_compile.core.models.sensor import Sensor
    from linkforge_compile.core.models.srdf import SemanticRobotDescription
    from linkforge_compile.core.models.transmission import Transmission


class PrefixedParts(NamedTuple):
    """The parts of a robot under a prefix, its own no longer; `semantic` is None where it says nothing semantic."""

    materials: Mapping[str, Material]
    links: Sequence[Link]
    joints: Sequence[Joint]
    sensors: Sequence[Sensor]
    transmissions: Sequence[Transmission]
    ros2_controls: Sequence[Ros2Control]
    gazebo_elements: Sequence[GazeboElement]
    semantic: SemanticRobotDescription | None
    extra_elements: Sequence[str]
    extra_attributes: Sequence[tuple[str, str]]

    @classmethod
    def of(cls, robot: Inventory, prefix: str) -> PrefixedParts:
        """Return every part of the robot with the prefix on its name and on the names that it refers to.

        Raises:
            RobotModelError: INVALID_NAME where the prefix makes a name that no part may have.

        """
        return cls(
            materials={prefix + name: each.with_prefix(prefix) for name, each in robot.materials.items()},
            # Links may be changed in place: two robots never share one, and `with_prefix` makes a new one always.
            links=[link.with_prefix(prefix) for link in robot.links],
            joints=prefixed_copies(robot.joints, prefix),
            sensors=prefixed_copies(robot.sensors, prefix),
            transmissions=prefixed_copies(robot.transmissions, prefix),
            ros2_controls=prefixed_copies(robot.ros2_controls, prefix),
            gazebo_elements=prefixed_copies(robot.gazebo_elements, prefix),
            semantic=robot.semantic.with_prefix(prefix) if robot.says_semantic else None,
            extra_elements=robot.extra_elements.listed(),
            extra_attributes=attribute_pairs(robot.extra_attributes),
        )

    def materials_beside(self, own: Mapping[str, Material]) -> dict[str, Material]:
        """Return those of the materials that are new to a robot with its own, and those of its own that move.

        A material that both have stands behind the links if both say so: else it would depend on which comes first.

        Raises:
            RobotValidationError: DUPLICATE_NAME for two different materials of one name.

        """
        for name, material in self.materials.items():
            if name in own and own[name] != material:
                raise RobotValidationError(
                    ValidationErrorCode.DUPLICATE_NAME,
                    f"Duplicate material name: '{name}', for two different materials",
                    target="Material",
                    value=name,
                )
        return {
            name: replace(own[name], after_links=False) if name in own else material
            for name, material in self.materials.items()
            if name not in own or own[name].after_links > material.after_links
        }
