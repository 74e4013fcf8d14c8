"""Robots: adding parts, joining two robots, copying one, and writing it out."""

from __future__ import annotations

from collections.abc import Iterable
from copy import deepcopy
from itertools import combinations
from pathlib import Path
from typing import Any, Self

from linkforge_compile.core.constants import SRDF_REASON_ADJACENT
from linkforge_compile.core.exceptions import RobotGeneratorError, RobotValidationError
from linkforge_compile.core.models.gazebo import GazeboElement, content_key
from linkforge_compile.core.models.geometry import IDENTITY, Transform, Vector3
from linkforge_compile.core.models.graph import refuse_cycles, tree_root
from linkforge_compile.core.models.joint import Joint, JointLimits, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.named_table import NAME
from linkforge_compile.core.models.robot_parts import (
    RobotParts,
    prefixed_materials,
    prefixed_parts,
    require_robot_name,
    select_new_materials,
)
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.models.srdf import (
    Chain,
    JointProperty,
    PlanningGroup,
    SemanticRobotDescription,
    chain_between,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.transmission import Transmission


class Robot(RobotParts):
    """A robot: `<robot name>` of URDF, and `semantic` for that of SRDF.

    It is mutable; of its parts, only links are. Every method that adds something either adds all of it, or leaves
    the robot as it was and raises RobotValidationError: DUPLICATE_NAME for a name that is taken, NOT_FOUND for
    a link, joint or group that the addition refers to and the robot lacks.
    """

    @property
    def folder(self) -> Path | None:
        """The folder of the file in which it was written, where relative paths start; None without a file."""
        path = self.source.span.file.path if self.source else None
        return path.parent if path else None

    def add_link(self, link: Link, overwrite: bool = False) -> None:
        """Add a link; with `overwrite` it replaces one of the same name."""
        if overwrite and self.has_link(link.name):
            self.links = [link if other.name == link.name else other for other in self.links]
        else:
            self.add_parts(links=[link])

    def add_joint(self, joint: Joint) -> None:
        """Add a joint between two links of the robot."""
        new = self._select_new(joints=[joint])
        self.require_parent(joint)
        self._require("links", joint.child, f"Child link '{joint.child}'", "ChildLink", "child")
        self._extend(new)

    def require_parent(self, joint: Joint) -> None:
        """Refuse a joint whose parent is no link of the robot: NOT_FOUND."""
        self._require("links", joint.parent, f"Parent link '{joint.parent}'", "ParentLink", "parent")

    def add_sensor(self, sensor: Sensor) -> None:
        """Add a sensor to a link of the robot."""
        new = self._select_new(sensors=[sensor])
        self._require("links", sensor.link_name, f"Link '{sensor.link_name}'", "LinkName", "link")
        self._extend(new)

    def add_transmission(self, transmission: Transmission) -> None:
        """Add a transmission for joints of the robot; actuators are names of its own."""
        new = self._select_new(transmissions=[transmission])
        self._require_joints(joint.name for joint in transmission.joints)
        self._extend(new)

    def add_ros2_control(self, ros2_control: Ros2Control) -> None:
        """Add a hardware component for joints of the robot."""
        new = self._select_new(ros2_controls=[ros2_control])
        self._require_joints(joint.name for joint in ros2_control.joints)
        self._extend(new)

    def update_ros2_control(self, ros2_control: Ros2Control) -> None:
        """Replace the hardware component of the same name, without checks; add it if there is none."""
        if self.has_ros2_control(ros2_control.name):
            self.ros2_controls = [
                ros2_control if other.name == ros2_control.name else other for other in self.ros2_controls
            ]
        else:
            self.add_ros2_control(ros2_control)

    def add_gazebo_element(self, element: GazeboElement) -> None:
        """Add settings of a simulator for a link or joint of the robot, or for the robot."""
        reference = element.reference
        if reference is not None and not self.has_link(reference):
            self._require("joints", reference, f"Gazebo reference '{reference}'", "GazeboReference", "reference")
        self.add_parts(gazebo_elements=[element])

    def _require(self, kind: str, name: str, what: str, target: str, *field: str) -> None:
        if self._list_of(kind).get(name) is None:
            raise RobotValidationError.not_found(f"{what} not found", target, name, *field)

    def _require_joints(self, names: Iterable[str]) -> None:
        for name in names:
            self._require("joints", name, f"Joint '{name}'", "JointName", "joints", name)

    def add_semantic(self, description: SemanticRobotDescription) -> Self:
        """Add the entries of a description; the parts that they name need not exist.

        A collision pair that exists, whatever the order of its links, and a link without default collisions are not
        added again. Group states are identified by group and name, sphere approximations by link, joint properties by
        joint and property.
        """
        if not description.is_empty:
            self.semantic = self.semantic.merge_with(description)
        return self

    def _add_entries(self, **entries: Any) -> Self:  # Any: each collection has entries of its own class
        return self.add_semantic(SemanticRobotDescription(**entries))

    def add_group(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        links: list[str] | None = None,
        joints: list[str] | None = None,
        chains: list[Chain] | None = None,
        subgroups: list[str] | None = None,
        base_link: str | None = None,
        tip_link: str | None = None,
    ) -> Self:
        """Add a planning group of parts of the robot; `base_link` and `tip_link` make one chain more.

        Raises:
            RobotValidationError: INVALID_VALUE for one of base_link and tip_link without the other; VALUE_EMPTY for a
                group of nothing.

        """
        all_chains = (*(chains or ()), *chain_between(name, base_link, tip_link))
        group = PlanningGroup(name, links or (), joints or (), all_chains, subgroups or ())
        for link in (*group.links, *(end for chain in group.chains for end in (chain.base_link, chain.tip_link))):
            self.link(link)
        for joint in group.joints:
            self.joint(joint)
        for subgroup in group.subgroups:
            if subgroup not in self.semantic.groups:
                message = f"Subgroup '{subgroup}' not found"
                raise RobotValidationError.not_found(message, "Subgroup", subgroup, "subgroups")
        return self._add_entries(groups=[group])

    def disable_collisions(self, link1: str, link2: str, reason: str = SRDF_REASON_ADJACENT) -> Self:
        """Let planning ignore collisions between two links; a pair that is disabled already stays as it is."""
        return self._disable_pairs([(link1, link2)], reason)

    def disable_all_collisions(self, links: list[str], reason: str = SRDF_REASON_ADJACENT) -> Self:
        """Let planning ignore collisions between any two of the links; INVALID_VALUE for one listed twice."""
        for link in links:
            self.link(link)
        return self._disable_pairs(combinations(links, 2), reason)

    def _disable_pairs(self, pairs: Iterable[tuple[str, str]], reason: str) -> Self:
        disabled = [CollisionPair(self.link(one).name, self.link(other).name, reason) for one, other in pairs]
        return self._add_entries(disabled_collisions=disabled)

    def enable_collisions(self, link1: str, link2: str, reason: str | None = None) -> Self:
        """Let planning check two links for collisions although that is disabled by default; once a pair."""
        pair = CollisionPair(self.link(link1).name, self.link(link2).name, reason)
        return self._add_entries(enabled_collisions=[pair])

    def disable_default_collisions(self, link: str) -> Self:
        """Let planning ignore all collisions of a link that are not enabled one by one."""
        return self._add_entries(no_default_collision_links=[self.link(link).name])

    def add_joint_property(self, joint_name: str, property_name: str, value: str) -> Self:
        """Add a property of a joint that planners know by name."""
        return self._add_entries(joint_properties=[JointProperty(self.joint(joint_name).name, property_name, value)])

    def approximate_link_collision(self, link: str, spheres: list[SrdfSphere]) -> Self:
        """Approximate a link's shape in collisions by spheres."""
        return self._add_entries(link_sphere_approximations=[LinkSphereApproximation(self.link(link).name, spheres)])

    def merge(  # noqa: PLR0917 the contract's signature
        self,
        component: Robot,
        at_link: str | None,
        joint_name: str | None,
        prefix: str = "",
        joint_type: JointType = JointType.FIXED,
        origin: Transform | None = None,
        axis: Vector3 | None = None,
        limits: JointLimits | None = None,
        *,
        joint: Joint | None = None,
    ) -> Robot:
        """Add all parts of another robot under a prefix, and the joint from `at_link` to its root link.

        The joint's own name gets no prefix; `origin` is identity where it is None. From `joint` come the fields
        without an argument here: dynamics, mimic, safety controller, calibration, source, axis as written, extras.
        Without `at_link` nothing connects the two, and the arguments about the joint are not read.
        The component stays as it is. Its name, version, metadata and resolver are not taken over.

        Raises:
            RobotValidationError: NOT_FOUND for `at_link` or for a joint of the component without its links;
                NO_ROOT, MULTIPLE_ROOTS or HAS_CYCLE for its tree; DUPLICATE_NAME for two parts of one name or two
                different materials of one name; what Joint raises for the connecting one.

        """
        if at_link is not None:
            self._require("links", at_link, f"Attachment link '{at_link}'", "Attach", "parent")
        parts = prefixed_parts(component, prefix)
        # Links of one name are reported as such, and not as the cycle that they make.
        self._select_new(links=parts["links"])
        if at_link is None:
            refuse_cycles(parts["links"], parts["joints"])
        else:
            # The connecting joint comes from a link that is none of theirs, so it makes no cycle.
            root = tree_root(parts["links"], parts["joints"])
            connecting = Joint(joint_name or "", joint_type, at_link, root, origin or IDENTITY, axis, limits)
            parts["joints"].append(_with_rest_of(joint, connecting) if joint else connecting)
        self._add_component(component, prefix, parts)
        return self

    def _add_component(self, component: Robot, prefix: str, parts: dict[str, list[Any]]) -> None:
        """Add parts, materials, raw XML and semantic entries of a component, all of them or none."""
        new_materials = select_new_materials(prefixed_materials(component, prefix), self.materials)
        new_parts = self._select_new(**parts, extra_elements=component.extra_elements)
        own_attributes = dict(self.extra_attributes)
        extra_attributes = {**own_attributes, **dict(component.extra_attributes), **own_attributes}
        update_materials = self.materials.update
        if component.has_semantic:
            self.add_semantic(component.semantic.with_prefix(prefix))  # the last that can be refused
        self._extend(new_parts)
        update_materials(new_materials)
        self.extra_attributes = tuple(extra_attributes.items())

    def prefix_all(self, prefix: str) -> None:
        """Put a prefix before the names of the robot and its parts, and wherever they refer to one another.

        Extra elements, metadata and files stay as they are; an empty prefix changes nothing.

        Raises:
            RobotModelError: INVALID_NAME where the prefix makes a name that is not allowed.

        """
        if not prefix:
            return
        require_robot_name(prefix + self.name)
        materials = prefixed_materials(self, prefix)
        parts = prefixed_parts(self, prefix)
        semantic = self.semantic.with_prefix(prefix) if self.has_semantic else None
        for kind, prefixed in parts.items():  # links first: they are refused if two were renamed to one name
            setattr(self, kind, prefixed)
        self.materials = materials
        self.semantic = semantic
        self.name = prefix + self.name

    def clone(self) -> Robot:
        """Return a robot of its own with equal parts, metadata and resolver."""
        return deepcopy(self)

    def normalized(self) -> Robot:
        """Return a clone with parts sorted by name, so that equality does not depend on their order.

        Gazebo elements are sorted by reference and then by content; materials and metadata are mappings, and the order
        of visuals and collisions is kept, for it has a meaning.
        """
        robot = self.clone()
        robot.links = sorted(robot.links, key=NAME)
        robot.joints = sorted(robot.joints, key=NAME)
        robot.sensors = sorted(robot.sensors, key=NAME)
        robot.transmissions = sorted((part.normalized() for part in robot.transmissions), key=NAME)
        robot.ros2_controls = sorted((part.normalized() for part in robot.ros2_controls), key=NAME)
        robot.gazebo_elements = sorted(robot.gazebo_elements, key=content_key)
        robot.controllers = sorted(robot.controllers, key=NAME)
        if robot.has_semantic:
            robot.semantic = robot.semantic.normalized()
        return robot

    def export_urdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Return the robot as URDF; with `validate`, only if no check finds an error.

        Raises:
            RobotGeneratorError: With `validate`, the errors that were found, a line each.

        """
        # LinkForge has exporting as a method, so this one module of core imports packages above it.
        from linkforge_compile.formats.render import render_urdf

        if validate:
            self._refuse_errors()
        return render_urdf(self, pretty=pretty_print)

    def export_srdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Return the semantic description as SRDF; with `validate`, only if no check finds an error.

        Raises:
            RobotGeneratorError: With `validate`, the errors that were found, a line each.

        """
        from linkforge_compile.formats.render import render_srdf

        if validate:
            self._refuse_errors()
        return render_srdf(self, pretty=pretty_print)

    def _refuse_errors(self) -> None:
        from linkforge_compile.checks import check
        from linkforge_compile.diagnostics import Severity, UnresolvedNames

        errors = [found.message for found in check(self, UnresolvedNames()) if found.severity is Severity.ERROR]
        if errors:
            raise RobotGeneratorError("\n".join(errors))


def _with_rest_of(joint: Joint, connecting: Joint) -> Joint:
    """Return the connecting joint with the fields of another one that `merge` has no arguments for."""
    names = ("name", "type", "parent", "child", "origin", "axis", "limits")
    return joint.with_fields(**{name: getattr(connecting, name) for name in names})
