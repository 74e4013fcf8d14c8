"""Building robots in Python, call by call: `RobotBuilder("arm").link("base").visual(box(1, 1, 1)).mass(2.0)…`."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from linkforge_compile.core.builders.link_builder import IComposer, LinkBuilder
from linkforge_compile.core.builders.link_draft import Triple, pose, unit_axis
from linkforge_compile.core.constants import CONTROL_TYPE_SYSTEM, SRDF_REASON_ADJACENT, SRDF_VJOIN_FIXED
from linkforge_compile.core.exceptions import RobotModelError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Box, Capsule, Color, Cylinder, Material, Mesh, Sphere, Vector3
from linkforge_compile.core.models.joint import JointLimits, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    VirtualJoint,
    chain_between,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere

__all__ = [
    "IComposer",
    "LinkBuilder",
    "RobotBuilder",
    "SemanticBuilder",
    "box",
    "capsule",
    "cylinder",
    "mesh",
    "sphere",
]


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


class SemanticBuilder:
    """The SRDF part of a robot under construction; links and joints that it names may be added later.

    A second entry of one name raises DUPLICATE_NAME, except collision pairs and links without default collisions.
    """

    def __init__(self, builder: IComposer) -> None:
        self._builder = builder

    def done(self) -> IComposer:
        """Return to the robot's builder."""
        return self._builder

    def group(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        links: list[str] | None = None,
        joints: list[str] | None = None,
        chains: list[Chain] | None = None,
        subgroups: list[str] | None = None,
        base_link: str | None = None,
        tip_link: str | None = None,
    ) -> SemanticBuilder:
        """Define a planning group; `base_link` and `tip_link`, always both, make one chain more."""
        all_chains = (*(chains or ()), *chain_between(name, base_link, tip_link))
        group = PlanningGroup(name, links or (), joints or (), all_chains, subgroups or ())
        return self._add(SemanticRobotDescription(groups=(group,)))

    def group_state(self, name: str, group: str, values: dict[str, float | tuple[float, ...]]) -> SemanticBuilder:
        """Name positions of a group's joints [rad] or [m]; a tuple for joints of several degrees of freedom."""
        return self._add(SemanticRobotDescription(group_states=(GroupState(name, group, values),)))

    def end_effector(self, name: str, group: str, parent_link: str, parent_group: str | None = None) -> SemanticBuilder:
        """Declare a group an end effector, on a link of another group."""
        return self._add(SemanticRobotDescription(end_effectors=(EndEffector(name, group, parent_link, parent_group),)))

    def passive_joint(self, name: str) -> SemanticBuilder:
        """Declare a joint that nothing drives."""
        return self._add(SemanticRobotDescription(passive_joints=(PassiveJoint(name),)))

    def virtual_joint(
        self, name: str, child_link: str, parent_frame: str = "world", joint_type: str = SRDF_VJOIN_FIXED
    ) -> SemanticBuilder:
        """Connect the robot's root link to a frame outside of the robot."""
        joint = VirtualJoint(name, joint_type, parent_frame, child_link)
        return self._add(SemanticRobotDescription(virtual_joints=(joint,)))

    def disable_collisions(self, link1: str, link2: str, reason: str = SRDF_REASON_ADJACENT) -> SemanticBuilder:
        """Let planning ignore collisions between two links."""
        return self._add(SemanticRobotDescription(disabled_collisions=(CollisionPair(link1, link2, reason),)))

    def enable_collisions(self, link1: str, link2: str, reason: str | None = None) -> SemanticBuilder:
        """Let planning look for collisions between two links although it is disabled by default."""
        return self._add(SemanticRobotDescription(enabled_collisions=(CollisionPair(link1, link2, reason),)))

    def disable_default_collisions(self, link: str) -> SemanticBuilder:
        """Let planning ignore all collisions of a link that are not enabled one by one."""
        return self._add(SemanticRobotDescription(no_default_collision_links=(link,)))

    def joint_property(self, joint_name: str, property_name: str, value: str) -> SemanticBuilder:
        """Set a property of a joint that planners know by name."""
        return self._add(SemanticRobotDescription(joint_properties=(JointProperty(joint_name, property_name, value),)))

    def approximate_link_collision(self, link: str, spheres: list[SrdfSphere]) -> SemanticBuilder:
        """Approximate a link's shape in collisions by spheres."""
        return self._add(SemanticRobotDescription(link_sphere_approximations=(LinkSphereApproximation(link, spheres),)))

    def _add(self, description: SemanticRobotDescription) -> SemanticBuilder:
        self._builder.robot.add_semantic(description)
        return self


def box(x: float, y: float, z: float) -> Box:
    """Return a cuboid by its full extents [m]."""
    return Box(Vector3(x, y, z))


def cylinder(radius: float, length: float) -> Cylinder:
    """Return a cylinder about its z axis [m]."""
    return Cylinder(radius, length)


def sphere(radius: float) -> Sphere:
    """Return a sphere [m]."""
    return Sphere(radius)


def capsule(radius: float, length: float) -> Capsule:
    """Return a cylinder about its z axis with half spheres beyond its length [m]."""
    return Capsule(radius, length)


def mesh(resource: str, scale: Triple = (1.0, 1.0, 1.0)) -> Mesh:
    """Return the shape in a file, a URI or a path."""
    return Mesh(resource, Vector3(*scale))
