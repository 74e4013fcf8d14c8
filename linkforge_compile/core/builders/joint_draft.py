"""The joint of a link under construction: how it moves, its transmission and its ros2_control."""

from __future__ import annotations

from typing import Any, Self

from linkforge_compile.core import constants as default
from linkforge_compile.core.builders.link_draft import LinkDraft, Triple, pose, unit_axis
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import IDENTITY
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.models.named_table import NamedTable
from linkforge_compile.core.models.ros2_control import Ros2Control, Ros2ControlJoint
from linkforge_compile.core.models.transmission import Transmission


class JointDraft(LinkDraft):
    """The calls that describe the joint; without a parent there is none, and they have no effect."""

    def __init__(self, name: str, parent: str | None, joint_name: str | None) -> None:
        super().__init__(name)
        self._parent = parent
        self._joint_name = joint_name
        self._joint_type = JointType.FIXED
        self._joint_origin = IDENTITY
        self._joint_parts: dict[str, Any] = {}  # fields of Joint, none of which LinkForge gives to a fixed one
        self._transmission: dict[str, Any] | None = None  # arguments of Transmission.create_simple
        self._control: dict[str, Any] | None = None  # fields of Ros2ControlJoint
        self._control_system: str | None = None

    def at_origin(self, xyz: Triple = (0, 0, 0), rpy: Triple = (0, 0, 0)) -> Self:
        """Place this link's frame in its parent's, at `xyz` [m] turned by `rpy` [rad]."""
        self._check_not_committed()
        self._joint_origin = pose(xyz, rpy)
        return self

    def fixed(self, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None) -> Self:
        """Fix the link to its parent; here and below, None keeps the name and the pose as they are."""
        return self._set_joint(JointType.FIXED, name, xyz, rpy)

    def revolute(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        limits: tuple[float, float],
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float = default.DEFAULT_JOINT_EFFORT,
        velocity: float = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link turn about an axis of any length within (lower, upper) [rad], [N·m], [rad/s]."""
        bounds = JointLimits(lower=limits[0], upper=limits[1], effort=effort, velocity=velocity)
        return self._set_joint(JointType.REVOLUTE, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def continuous(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float | None = default.DEFAULT_JOINT_EFFORT,
        velocity: float | None = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link turn about an axis without end, [N·m], [rad/s]; its limits are 0 to 0, unused.

        One of effort and velocity that is None counts as 0; without both the joint has no limits.
        """
        bounds = None
        if effort is not None or velocity is not None:
            bounds = JointLimits(lower=0.0, upper=0.0, effort=effort or 0.0, velocity=velocity or 0.0)
        return self._set_joint(JointType.CONTINUOUS, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def prismatic(  # noqa: PLR0917 the contract's signature
        self,
        axis: Triple,
        limits: tuple[float, float],
        name: str | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        effort: float = default.DEFAULT_JOINT_EFFORT,
        velocity: float = default.DEFAULT_JOINT_VELOCITY,
    ) -> Self:
        """Let the link slide along an axis of any length within (lower, upper) [m], [N], [m/s]."""
        bounds = JointLimits(lower=limits[0], upper=limits[1], effort=effort, velocity=velocity)
        return self._set_joint(JointType.PRISMATIC, name, xyz, rpy, axis=unit_axis(axis), limits=bounds)

    def floating(self, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None) -> Self:
        """Let the link move freely."""
        return self._set_joint(JointType.FLOATING, name, xyz, rpy)

    def planar(
        self, axis: Triple, name: str | None = None, xyz: Triple | None = None, rpy: Triple | None = None
    ) -> Self:
        """Let the link move in the plane whose normal is the axis."""
        return self._set_joint(JointType.PLANAR, name, xyz, rpy, axis=unit_axis(axis))

    def dynamics(
        self, damping: float = default.DEFAULT_JOINT_DAMPING, friction: float = default.DEFAULT_JOINT_FRICTION
    ) -> Self:
        """Let the joint resist: [N·m·s/rad] and [N·m], or [N·s/m] and [N]."""
        return self._set_parts(dynamics=JointDynamics(damping, friction))

    def mimic(self, joint: str, multiplier: float = 1.0, offset: float = 0.0) -> Self:
        """Let the joint follow another: multiplier times its position plus offset [rad] or [m]."""
        return self._set_parts(mimic=JointMimic(joint, multiplier, offset))

    def safety(
        self,
        soft_lower: float | None = None,
        soft_upper: float | None = None,
        k_position: float | None = None,
        k_velocity: float = 0.0,
    ) -> Self:
        """Give the joint a safety controller; see JointSafetyController."""
        return self._set_parts(safety_controller=JointSafetyController(soft_lower, soft_upper, k_position, k_velocity))

    def calibration(self, rising: float | None = None, falling: float | None = None) -> Self:
        """Give the positions at which the joint's reference switch changes [rad] or [m]."""
        return self._set_parts(calibration=JointCalibration(rising, falling))

    def transmission(
        self,
        reduction: float = 1.0,
        interface: str = default.HW_IF_EFFORT,
        actuator: str | None = None,
        name: str | None = None,
    ) -> Self:
        """Drive the joint by an actuator; None for `actuator_LINK` and `trans_JOINT`."""
        self._check_not_committed()
        self._transmission = {
            "name": name,
            "actuator_name": actuator or f"actuator_{self._link_name}",
            "mechanical_reduction": reduction,
            "hardware_interfaces": [interface],
        }
        return self

    def ros2_control(
        self,
        command_interfaces: list[str],
        state_interfaces: list[str],
        parameters: dict[str, Any] | None = None,
        system_name: str | None = None,
    ) -> Self:
        """Let a ros2_control system move the joint; None for the first system that the robot has."""
        self._check_not_committed()
        self._control = {
            "command_interfaces": command_interfaces,
            "state_interfaces": state_interfaces,
            "parameters": {name: str(value) for name, value in (parameters or {}).items()},
        }
        self._control_system = system_name
        return self

    def _set_joint(
        self, joint_type: JointType, name: str | None, xyz: Triple | None, rpy: Triple | None, **parts: object
    ) -> Self:
        self._check_not_committed()
        self._joint_type = joint_type
        self._joint_parts.update(parts)
        self._joint_name = name or self._joint_name
        if xyz is not None or rpy is not None:
            self._joint_origin = pose(xyz, rpy)
        return self

    def _set_parts(self, **parts: object) -> Self:
        self._check_not_committed()
        self._joint_parts.update(parts)
        return self

    def _make_joint(self) -> Joint | None:
        if not self._parent:
            return None
        return Joint(
            name=self._joint_name or f"{self._parent}_to_{self._link_name}",
            type=self._joint_type,
            parent=self._parent,
            child=self._link_name,
            origin=self._joint_origin,
            **({} if self._joint_type is JointType.FIXED else self._joint_parts),
        )

    def _make_transmission(self, joint: Joint) -> Transmission | None:
        if self._transmission is None:
            return None
        name = self._transmission["name"] or f"trans_{joint.name}"
        return Transmission.create_simple(**{**self._transmission, "name": name, "joint_name": joint.name})

    def _make_control(self, joint: Joint, systems: NamedTable[Ros2Control]) -> Ros2Control | None:
        """Return the ros2_control system that is to move the joint, with the joint in it.

        Raises:
            RobotValidationError: VALUE_EMPTY if there are no systems, GENERIC_FAILURE if the named one is missing.

        """
        if self._control is None:
            return None
        if not systems:
            message = f"Joint '{joint.name}' requested ros2_control interfaces, but no global system exists."
            raise RobotValidationError.empty(message, "Ros2Control")
        system = systems.get(self._control_system) if self._control_system else systems[0]
        if system is None:
            message = (
                f"Joint '{joint.name}' requested ros2_control system '{self._control_system}', but it was not found."
            )
            raise RobotValidationError(ValidationErrorCode.GENERIC_FAILURE, message, "Ros2Control")
        return system.with_fields(joints=(*system.joints, Ros2ControlJoint(joint.name, **self._control)))
