"""Building a robot call by call."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from linkforge_compile.core.builders.link_builder import IComposer, LinkBuilder
from linkforge_compile.core.builders.semantic_builder import SemanticBuilder
from linkforge_compile.core.builders.shapes import Triple, pose, unit_axis
from linkforge_compile.core.constants import CONTROL_TYPE_SYSTEM, SRDF_REASON_ADJACENT
from linkforge_compile.core.exceptions import RobotModelError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.joint import JointLimits, JointType
from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control


class RobotBuilder:
    """A robot under construction: a new one of that name, or one that exists already."""

    def __init__(self, name: str | None = None, robot: Robot | None = None) -> None:
        if robot is None and name is None:
            raise RobotModelError("Either name or robot must be provided")
        self.robot = Robot(name or "") if robot is None else robot
        self._unfinished: list[LinkBuilder] = []
        self._parents: list[str] = []

    def register_link_builder(self, builder: LinkBuilder) -> None:
        """Remember a link that is to be finished before the robot is."""
        self._unfinished.append(builder)

    def push_parent(self, name: str) -> None:
        """Make a link the parent of links that name none."""
        self._parents.append(name)

    def pop_parent(self, name: str | None = None) -> None:
        """Take that link off again; None for the one that was made parent last."""
        if name is None:
            del self._parents[-1:]
        elif name in self._parents:
            del self._parents[len(self._parents) - 1 - self._parents[::-1].index(name)]

    def link(self, name: str, parent: str | None = None, joint_name: str | None = None) -> LinkBuilder:
        """Begin a link; `joint_name` is `PARENT_to_NAME` if it is None.

        Without a parent, inside the `with` block of another link, it is a child of that one.
        """
        if parent is None and self._parents:
            parent = self._parents[-1]
        return LinkBuilder(self, name, parent=parent, joint_name=joint_name)

    def attach(  # noqa: PLR0917 the contract's signature
        self,
        component: Robot | IComposer,
        at_link: str,
        joint_name: str | None = None,
        prefix: str = "",
        joint_type: JointType = JointType.FIXED,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
        axis: Triple | None = None,
        limits: tuple[float, float] | None = None,
        disable_collision: bool = False,
        reason: str = SRDF_REASON_ADJACENT,
    ) -> RobotBuilder:
        """Merge another robot at a link of this one: see Robot.merge.

        The links of a component that is still being built are finished first, where LinkForge leaves them out.
        The joint is called `LINK_to_ROOT` where it has no name; its axis may be of any length, its limits are
        (lower, upper). With `disable_collision`, planning ignores collisions between the two links that it joins.
        """
        other = component if isinstance(component, Robot) else component.build(validate=False)
        root = prefix + other.root_link.name
        self.robot.merge(
            component=other,
            at_link=at_link,
            joint_name=joint_name or f"{at_link}_to_{root}",
            prefix=prefix,
            joint_type=joint_type,
            origin=pose(xyz, rpy),
            axis=None if axis is None else unit_axis(axis),
            limits=None if limits is None else JointLimits(lower=limits[0], upper=limits[1]),
        )
        if disable_collision:
            self.robot.disable_collisions(at_link, root, reason=reason)
        return self

    def material(self, name: str, color: tuple[float, float, float, float] | None = None) -> RobotBuilder:
        """Define a material, red, green, blue and opacity from 0 to 1, that links may name."""
        self.robot.materials[name] = Material(name, Color(*color) if color else None)
        return self

    def ros2_control(
        self,
        name: str,
        hardware_plugin: str,
        control_type: str = CONTROL_TYPE_SYSTEM,
        parameters: dict[str, Any] | None = None,
    ) -> RobotBuilder:
        """Add a piece of hardware that links may give their joints to."""
        texts = {key: str(value) for key, value in (parameters or {}).items()}
        self.robot.add_ros2_control(Ros2Control(name, control_type, hardware_plugin, parameters=texts))
        return self

    @property
    def semantic(self) -> SemanticBuilder:
        """The builder of the SRDF part: `builder.semantic.group("arm", links=["upper", "lower"])`."""
        return SemanticBuilder(self)

    def clone(self) -> RobotBuilder:
        """Finish all links and return a builder with a robot of its own."""
        self._finish_links()
        return RobotBuilder(robot=deepcopy(self.robot))

    def build(self, validate: bool = True) -> Robot:
        """Finish all links and return the robot.

        Raises:
            RobotValidationError: With `validate`, HAS_CYCLE, NO_ROOT or MULTIPLE_ROOTS.

        """
        self._finish_links()
        if validate:
            if self.robot.has_cycle:
                raise RobotValidationError(
                    ValidationErrorCode.HAS_CYCLE,
                    "Robot kinematic chain contains a cycle (not supported in URDF)",
                    target="KinematicTree",
                )
            self.robot.get_root_link()
        return self.robot

    def _finish_links(self) -> None:
        for builder in self._unfinished:
            builder.commit()
        self._unfinished.clear()

    def export_urdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Finish all links and return the robot as URDF; `validate` as for `build`. See Robot.export_urdf."""
        return self.build(validate).export_urdf(validate=validate, pretty_print=pretty_print)

    def export_srdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Finish all links and return the semantic part as SRDF; `validate` as for `build`."""
        return self.build(validate).export_srdf(validate=validate, pretty_print=pretty_print)
