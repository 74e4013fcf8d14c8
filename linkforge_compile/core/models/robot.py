"""Robots: putting one together from parts and from other robots, copying it, and writing it out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from linkforge_compile.core.exceptions import RobotGeneratorError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import IDENTITY
from linkforge_compile.core.models.graph import refuse_cycles, tree_root
from linkforge_compile.core.models.index import NAME, Index
from linkforge_compile.core.models.inventory import require_robot_name
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.semantic_parts import SemanticParts
from linkforge_compile.core.models.semantic_robot import SemanticRobot

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement
    from linkforge_compile.core.models.geometry import Transform, Vector3
    from linkforge_compile.core.models.joint import JointLimits
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.merging import PrefixedParts
    from linkforge_compile.core.models.ros2_control import Ros2Control
    from linkforge_compile.core.models.sensor import Sensor
    from linkforge_compile.core.models.transmission import Transmission


_BESIDE_TREE: Final = ("sensors", "transmissions", "ros2_controls", "gazebo_elements", "extra_elements")
"""The collections that merging makes longer, beside links and joints."""


class Robot(SemanticRobot):
    """A robot: `<robot name>` of URDF, and `semantic` for that of SRDF.

    A container that changes, of parts that do not (a Link alone may). Every method that adds something either
    does so as a whole or raises and leaves the robot as it was.
    """

    def add_link(self, link: Link, overwrite: bool = False) -> None:
        """Add a link; with `overwrite` it takes the place of one of the same name.

        Raises:
            RobotValidationError: DUPLICATE_NAME without `overwrite`.

        """
        if overwrite and self.has_link(link.name):
            self.links = self.links.replaced(link)
        else:
            self.links = self.links.extended((link,))

    def add_joint(self, joint: Joint) -> None:
        """Add a joint between two links that are there.

        Raises:
            RobotValidationError: DUPLICATE_NAME; NOT_FOUND for its parent or child.

        """
        joints = self.joints.extended((joint,))
        _require(self.links, joint.parent, f"Parent link '{joint.parent}'", "ParentLink", "parent")
        _require(self.links, joint.child, f"Child link '{joint.child}'", "ChildLink", "child")
        self.joints = joints

    def add_sensor(self, sensor: Sensor) -> None:
        """Add a sensor to a link that is there.

        Raises:
            RobotValidationError: DUPLICATE_NAME; NOT_FOUND for its link.

        """
        sensors = self.sensors.extended((sensor,))
        _require(self.links, sensor.link_name, f"Link '{sensor.link_name}'", "LinkName", "link")
        self.sensors = sensors

    def add_transmission(self, transmission: Transmission) -> None:
        """Add a transmission for joints that are there; actuators are names of its own.

        Raises:
            RobotValidationError: DUPLICATE_NAME; NOT_FOUND for one of its joints.

        """
        transmissions = self.transmissions.extended((transmission,))
        for joint in transmission.joints:
            _require(self.joints, joint.name, f"Joint '{joint.name}'", "JointName", "joints", joint.name)
        self.transmissions = transmissions

    def add_ros2_control(self, ros2_control: Ros2Control) -> None:
        """Add a hardware component for joints that are there.

        Raises:
            RobotValidationError: DUPLICATE_NAME; NOT_FOUND for one of its joints.

        """
        ros2_controls = self.ros2_controls.extended((ros2_control,))
        for joint in ros2_control.joints:
            _require(self.joints, joint.name, f"Joint '{joint.name}'", "JointName", "joints", joint.name)
        self.ros2_controls = ros2_controls

    def update_ros2_control(self, ros2_control: Ros2Control) -> None:
        """Put a hardware component in the place of the one of its name, unseen; add it if there is none.

        Raises:
            RobotValidationError: NOT_FOUND for one of its joints, where it is added.

        """
        if self.has_ros2_control(ros2_control.name):
            self.ros2_controls = self.ros2_controls.replaced(ros2_control)
        else:
            self.add_ros2_control(ros2_control)

    def add_gazebo_element(self, element: GazeboElement) -> None:
        """Add settings of a simulator about a link or joint that is there, or about the robot.

        Raises:
            RobotValidationError: NOT_FOUND for its reference.

        """
        reference = element.reference
        if reference is not None and not self.has_link(reference):
            _require(self.joints, reference, f"Gazebo reference '{reference}'", "GazeboReference", "reference")
        self.gazebo_elements = self.gazebo_elements.extended((element,))

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

        The joint's own name takes no prefix; `origin` is identity where it is None. From `joint` it takes what
        has no argument here: dynamics, mimic, safety controller, calibration, source, the axis as written, extras.
        Without `at_link` nothing connects the two, and the arguments about the joint are not read.
        The component stays as it is. Its name, version, metadata and resolver are not taken over.

        Raises:
            RobotValidationError: NOT_FOUND for `at_link` or for a joint of the component without its links;
                NO_ROOT, MULTIPLE_ROOTS or HAS_CYCLE for its tree; DUPLICATE_NAME for two parts of one name or two
                different materials of one name; what Joint raises for the connecting one.

        """
        own_links = self.links
        if at_link is not None:
            _require(own_links, at_link, f"Attachment link '{at_link}'", "Attach", "parent")
        parts = _parts_under(component, prefix)
        links = own_links.extended(parts.links)  # of two links of one name, nobody could say which one a joint means
        joints = parts.joints
        if at_link is None:
            refuse_cycles(parts.links, parts.joints)
        else:
            # The connecting joint comes from a link that is none of theirs, so it makes no cycle.
            root = tree_root(parts.links, parts.joints)
            connecting = Joint(joint_name or "", joint_type, at_link, root, origin or IDENTITY, axis, limits)
            joints = (*joints, _with_rest_of(joint, connecting) if joint else connecting)
        self._take_in(parts, links, joints)
        return self

    def _take_in(self, parts: PrefixedParts, links: Index[Link], joints: Sequence[Joint]) -> None:
        materials = parts.materials_beside(self.materials)
        add_materials = self.materials.update
        # Links come first: they alone can still be refused as they are assigned, had two been renamed alike.
        grown: dict[str, Index[Any]] = {"links": links, "joints": self.joints.extended(joints)}
        for collection in _BESIDE_TREE:
            if added := getattr(parts, collection):
                grown[collection] = getattr(self, collection).extended(added)
        own = dict(self.extra_attributes)
        extra_attributes = (*own.items(), *(said for said in parts.extra_attributes if said[0] not in own))
        semantic = self._semantic.joined(parts.semantic) if parts.semantic else self._semantic
        # From here on the robot changes.
        for collection, longer in grown.items():
            setattr(self, collection, longer)
        add_materials(materials)
        self.extra_attributes = extra_attributes
        self._semantic = semantic

    def prefix_all(self, prefix: str) -> None:
        """Put a prefix before the robot's name, those of all its parts, and wherever they refer to one another.

        Extra elements, metadata and files stay as they are; an empty prefix changes nothing.

        Raises:
            RobotModelError: INVALID_NAME where the prefix makes a name that nothing may have.

        """
        if not prefix:
            return
        require_robot_name(prefix + self.name)
        parts = _parts_under(self, prefix)
        self.links = parts.links  # first, for they alone can be refused: two may have been renamed to one name
        self.joints = parts.joints
        self.sensors = parts.sensors
        self.transmissions = parts.transmissions
        self.ros2_controls = parts.ros2_controls
        self.gazebo_elements = parts.gazebo_elements
        self.materials = dict(parts.materials)
        self._semantic = SemanticParts(parts.semantic)
        self.name = prefix + self.name

    def clone(self) -> Robot:
        """Return a robot of its own with equal parts, metadata and resolver."""
        from copy import deepcopy

        return deepcopy(self)

    def normalized(self) -> Robot:
        """Return a clone with every kind of part sorted by name, so that equality does not depend on their order.

        Gazebo elements are sorted by reference and then by what they say; materials and metadata are mappings,
        and the order of visuals and collisions is kept, for it has a meaning.
        """
        robot = self.clone()
        robot.links = sorted(robot.links, key=NAME)
        robot.joints = sorted(robot.joints, key=NAME)
        robot.sensors = sorted(robot.sensors, key=NAME)
        robot.transmissions = sorted((part.normalized() for part in robot.transmissions), key=NAME)
        robot.ros2_controls = sorted((part.normalized() for part in robot.ros2_controls), key=NAME)
        robot.gazebo_elements = sorted(robot.gazebo_elements, key=_gazebo_order)
        if robot.says_semantic:
            robot.semantic = robot.semantic.normalized()
        return robot

    def export_urdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Return the robot as URDF; with `validate`, only if no check finds an error.

        Raises:
            RobotGeneratorError: With `validate`, the errors that were found, a line each.

        """
        # The contract makes exporting a method: here alone the core reaches up to the rooms that use it.
        from linkforge_compile.backends import render_urdf

        if validate:
            self._refuse_errors()
        return render_urdf(self, pretty=pretty_print)

    def export_srdf(self, validate: bool = True, pretty_print: bool = True) -> str:
        """Return what the robot says semantically as SRDF; with `validate`, only if no check finds an error.

        Raises:
            RobotGeneratorError: With `validate`, the errors that were found, a line each.

        """
        from linkforge_compile.backends import render_srdf

        if validate:
            self._refuse_errors()
        return render_srdf(self, pretty=pretty_print)

    def _refuse_errors(self) -> None:
        from linkforge_compile.checks import check
        from linkforge_compile.diagnostics import Severity, UnresolvedNames

        errors = [found.message for found in check(self, UnresolvedNames()) if found.severity is Severity.ERROR]
        if errors:
            raise RobotGeneratorError("\n".join(errors))


def _parts_under(robot: Robot, prefix: str) -> PrefixedParts:
    # Most robots are neither merged nor given a prefix.
    from linkforge_compile.core.models.merging import PrefixedParts

    return PrefixedParts.of(robot, prefix)


def _with_rest_of(joint: Joint, connecting: Joint) -> Joint:
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


def _require(parts: Index[Link] | Index[Joint], name: str, what: str, target: str, *field: str) -> None:
    if parts.get(name) is None:
        raise RobotValidationError(ValidationErrorCode.NOT_FOUND, f"{what} not found", target, name, field=field)


def _gazebo_order(element: GazeboElement) -> tuple[str, str]:
    """By reference, then by content: several elements may speak of one part."""
    content: dict[str, object] = {
        **{name: getattr(element, name) for name in element.__match_args__ if name not in {"reference", "plugins"}},
        "plugins": [(plugin.name, plugin.filename, _in_order(plugin.parameters)) for plugin in element.plugins],
        "extras": (element.extra_attributes, element.extra_elements, element.extra_inside),
    }
    return element.reference or "", repr(_in_order(content))


def _in_order(value: object) -> object:
    """Return a value with the items of every mapping in it sorted, since equality does not ask for their order."""
    if isinstance(value, Mapping):
        return sorted((name, _in_order(item)) for name, item in value.items())
    return [_in_order(item) for item in value] if isinstance(value, tuple | list) else value
