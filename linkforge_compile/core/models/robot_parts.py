"""The parts of a robot by kind, look-up by name and in its tree, and steps of merging two robots."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import Any, overload

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.exceptions import RobotModelError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.controller import Controller
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.geometry import Material
from linkforge_compile.core.models.graph import KinematicGraph, child_joints, parent_joints, single_root
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.named_table import KeySpec, NamedTable, OnDuplicate, PartList, TableField, itself
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.models.srdf import SemanticRobotDescription
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.core.naming import is_valid_name, require_name
from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.core.resolver import FileSystemResolver, IResourceResolver
from linkforge_compile.source import Sourced


class _Tree:
    """The graph of some links and joints, computed when it is needed."""

    def __init__(self, links: NamedTable[Link], joints: NamedTable[Joint]) -> None:
        self._links, self._joints, self._renamings = links, joints, Link.renamings

    def is_of(self, links: NamedTable[Link], joints: NamedTable[Joint]) -> bool:
        return self._links is links and self._joints is joints and self._renamings == Link.renamings

    @cached_property
    def graph(self) -> KinematicGraph:
        return KinematicGraph(self._links, self._joints)

    @cached_property
    def above(self) -> Mapping[str, Joint]:
        return parent_joints(self._joints)

    @cached_property
    def below(self) -> Mapping[str, Sequence[Joint]]:
        return child_joints(self._joints)


def require_robot_name(name: str) -> None:
    """Refuse a name that no robot may have.

    Raises:
        RobotValidationError: NAME_EMPTY, INVALID_NAME.

    """
    require_name(name, "Robot name", "RobotName")
    if not is_valid_name(name):
        code, message = ValidationErrorCode.INVALID_NAME, "Invalid name format"
        raise RobotValidationError(code, message, "RobotName", name, field=("name",))


class SemanticField:
    """The field `semantic`: the description under the robot's name, an empty one where None was assigned."""

    @overload
    def __get__(self, robot: None, owner: type) -> None: ...
    @overload
    def __get__(self, robot: RobotParts, owner: type) -> SemanticRobotDescription: ...
    def __get__(self, robot: RobotParts | None, owner: type) -> SemanticRobotDescription | None:
        if robot is None:
            return None  # the field's default, to dataclasses
        description: SemanticRobotDescription | None = vars(robot)["semantic"]
        if description is None:
            return SemanticRobotDescription(robot.name)
        if description.robot_name != robot.name:
            description = vars(robot)["semantic"] = description.with_fields(robot_name=robot.name)
        return description

    def __set__(self, robot: RobotParts, description: SemanticRobotDescription | None) -> None:
        vars(robot)["semantic"] = description


@dataclass
class RobotParts(Sourced):
    """The parts of a robot, each kind in the order in which they were added.

    The collections are tuples with look-up by name (see NamedTable), and accept any iterable. Two links or two joints
    of one name are refused, by assignment too. Sensors, transmissions, ros2_controls and controllers of one name can be
    assigned, so that a faulty robot can be read and checked; adding and merging refuse them.
    """

    name: str
    version: str = IR_VERSION
    materials: dict[str, Material] = field(default_factory=dict)
    metadata: dict[str, object] = field(default_factory=dict)
    resource_resolver: IResourceResolver = field(default_factory=FileSystemResolver, compare=False)
    links: TableField[Link] = TableField(KeySpec("link"), distinct=True)
    joints: TableField[Joint] = TableField(KeySpec("joint"), distinct=True)
    sensors: TableField[Sensor] = TableField(KeySpec("sensor"))
    transmissions: TableField[Transmission] = TableField(KeySpec("transmission"))
    ros2_controls: TableField[Ros2Control] = TableField(KeySpec("ros2_control"))
    gazebo_elements: TableField[GazeboElement] = TableField(
        KeySpec("gazebo element", attrgetter("reference"), OnDuplicate.KEEP)
    )
    semantic: SemanticField = SemanticField()
    extra_elements: TableField[str] = TableField(KeySpec("extra element", itself, OnDuplicate.KEEP))
    _: KW_ONLY
    extra_attributes: Sequence[tuple[str, str]] | Mapping[str, str] = ()
    controllers: TableField[Controller] = TableField(KeySpec("controller"))
    version_stated: bool = field(default=False, compare=False)

    def __post_init__(self) -> None:
        require_robot_name(self.name)
        self.extra_attributes = attribute_pairs(self.extra_attributes)
        self._last_tree: _Tree | None = None

    def __getstate__(self) -> dict[str, object]:
        """Return the state for copies and pickles: lists of its own, without what can be computed."""
        state = {name: copy(value) if isinstance(value, PartList) else value for name, value in vars(self).items()}
        return {**state, "_last_tree": None}

    # Of each kind: the part of a name or None; the part, or NOT_FOUND; whether there is one.

    def get_link(self, name: str) -> Link | None:
        return self.links.get(name)

    def link(self, name: str) -> Link:
        return self.links.require(name)

    def has_link(self, name: str) -> bool:
        return self.links.get(name) is not None

    def get_joint(self, name: str) -> Joint | None:
        return self.joints.get(name)

    def joint(self, name: str) -> Joint:
        return self.joints.require(name)

    def has_joint(self, name: str) -> bool:
        return self.joints.get(name) is not None

    def get_sensor(self, name: str) -> Sensor | None:
        return self.sensors.get(name)

    def sensor(self, name: str) -> Sensor:
        return self.sensors.require(name)

    def has_sensor(self, name: str) -> bool:
        return self.sensors.get(name) is not None

    def get_transmission(self, name: str) -> Transmission | None:
        return self.transmissions.get(name)

    def transmission(self, name: str) -> Transmission:
        return self.transmissions.require(name)

    def has_transmission(self, name: str) -> bool:
        return self.transmissions.get(name) is not None

    def get_ros2_control(self, name: str) -> Ros2Control | None:
        return self.ros2_controls.get(name)

    def ros2_control(self, name: str) -> Ros2Control:
        return self.ros2_controls.require(name)

    def has_ros2_control(self, name: str) -> bool:
        return self.ros2_controls.get(name) is not None

    def get_gazebo_elements(self, reference: str | None = None) -> list[GazeboElement]:
        """Return the Gazebo elements about one link or joint; all of them for None."""
        return [element for element in self.gazebo_elements if reference is None or element.reference == reference]

    @property
    def is_version_written(self) -> bool:
        """True if the version is stated, or not the default."""
        return self.version_stated or self.version != IR_VERSION

    @property
    def has_semantic(self) -> bool:
        """True once a description was assigned, be it an empty one, or something semantic was added."""
        return vars(self)["semantic"] is not None

    def add_parts(
        self,
        *,
        links: Iterable[Link] = (),
        joints: Iterable[Joint] = (),
        sensors: Iterable[Sensor] = (),
        transmissions: Iterable[Transmission] = (),
        ros2_controls: Iterable[Ros2Control] = (),
        gazebo_elements: Iterable[GazeboElement] = (),
        controllers: Iterable[Controller] = (),
    ) -> None:
        """Add parts of several kinds, all of them or none; the parts that they refer to need not exist.

        Of all but Gazebo elements, a name that is taken raises DUPLICATE_NAME.
        """
        self._extend(
            self._select_new(
                links=links,
                joints=joints,
                sensors=sensors,
                transmissions=transmissions,
                ros2_controls=ros2_controls,
                gazebo_elements=gazebo_elements,
                controllers=controllers,
            )
        )

    def _select_new(self, **parts: Iterable[Any]) -> dict[str, Sequence[Any]]:  # Any: each kind has a class of its own
        """Return those parts of each kind that are to be added; raise DUPLICATE_NAME for a name that is taken."""
        return {kind: self._list_of(kind).select_new(added) for kind, added in parts.items()}

    def _extend(self, parts: Mapping[str, Sequence[Any]]) -> None:
        for kind, added in parts.items():
            self._list_of(kind).extend(added)

    def _list_of(self, kind: str) -> PartList[Any]:
        parts: PartList[Any] = vars(self)[kind]
        return parts

    @property
    def _tree(self) -> _Tree:
        tree = self._last_tree
        if tree is None or not tree.is_of(self.links, self.joints):
            tree = self._last_tree = _Tree(self.links, self.joints)
        return tree

    @property
    def graph(self) -> KinematicGraph:
        """The links and joints as a graph, made anew when they have changed; NOT_FOUND for a joint without links."""
        return self._tree.graph

    def get_joints_for_link(self, link_name: str, as_parent: bool = True) -> list[Joint]:
        """Return the joints whose parent (or child) the link is, in the order of the joints."""
        if as_parent:
            return self.get_child_joints(link_name)
        return [joint for joint in self.joints if joint.child == link_name]

    def get_child_joints(self, link_name: str) -> list[Joint]:
        """Return the joints whose parent the link is, in the order of the joints; none for an unknown link."""
        return list(self._tree.below.get(link_name, ()))

    def get_parent_joint(self, link_name: str) -> Joint | None:
        """Return the first joint whose child the link is, None for a root and for an unknown link."""
        return self._tree.above.get(link_name)

    def get_parent_link(self, link_name: str) -> Link | None:
        """Return the parent of the first joint whose child the link is, None for a root or unknown link."""
        joint = self.get_parent_joint(link_name)
        return self.get_link(joint.parent) if joint else None

    def get_child_links(self, link_name: str) -> list[Link]:
        """Return the children of the joints whose parent the link is; raise NOT_FOUND for one that is no link."""
        return [self.link(joint.child) for joint in self.get_child_joints(link_name)]

    def get_root_link(self) -> Link:
        """Return the one link that is no joint's child; raise NO_ROOT, MULTIPLE_ROOTS, or what `graph` raises."""
        return self.link(single_root(self.graph))

    @property
    def root_link(self) -> Link:
        """The one link that is no joint's child; raises what `get_root_link` raises."""
        return self.get_root_link()

    @property
    def has_cycle(self) -> bool:
        """True if some link is its own ancestor."""
        return self.graph.has_cycle()

    @property
    def total_mass(self) -> float:
        """The sum of the masses of all links [kg]."""
        return sum(link.mass for link in self.links)

    @property
    def degrees_of_freedom(self) -> int:
        """The sum over all joints, those that mimic another included; planar counts 2, floating 6."""
        return sum(joint.degrees_of_freedom for joint in self.joints)

    def resolve_resource(self, uri: str, relative_to: Path | None = None) -> Path:
        """Return the file of a URI by the robot's resolver; raise FileNotFoundError if there is none."""
        return self.resource_resolver.resolve(uri, relative_to=relative_to)

    def __str__(self) -> str:
        return (
            f"Robot(name={self.name}, links={len(self.links)}, joints={len(self.joints)}, "
            f"dof={self.degrees_of_freedom})"
        )

    def summary(self) -> str:
        """Return a few lines about the robot; it is valid with one root and no cycle."""
        valid = False
        try:
            roots = self.graph.get_root_links()
            root = roots[0] if len(roots) == 1 else f"{len(roots)} roots"
            valid = len(roots) == 1 and not self.has_cycle
        except RobotModelError:
            root = "Unknown"
        lines = [
            f"Robot Summary: {self.name}",
            f"  Status: {'VALID' if valid else 'INVALID'}",
            f"  Root: {root}",
            f"  Topology: {len(self.links)} links, {len(self.joints)} joints ({self.degrees_of_freedom} DOF)",
        ]
        if self.sensors:
            lines.append(f"  Functional: {len(self.sensors)} sensors, {len(self.transmissions)} transmissions")
        if self.ros2_controls:
            lines.append(f"  Hardware: {len(self.ros2_controls)} ros2_control blocks")
        if self.gazebo_elements:
            lines.append(f"  Simulation: {len(self.gazebo_elements)} gazebo tags")
        return "\n".join(lines)


_KINDS = ("links", "joints", "sensors", "transmissions", "ros2_controls", "gazebo_elements", "controllers")


def prefixed_parts(robot: RobotParts, prefix: str) -> dict[str, list[Any]]:  # Any: each kind has a class of its own
    """Return the parts of a robot by kind, with the prefix on their names and references; raise INVALID_NAME."""
    return {kind: [part.with_prefix(prefix) for part in getattr(robot, kind)] for kind in _KINDS}


def prefixed_materials(robot: RobotParts, prefix: str) -> dict[str, Material]:
    """Return the materials of a robot with the prefix on their names."""
    return {prefix + name: material.with_prefix(prefix) for name, material in robot.materials.items()}


def select_new_materials(added: Mapping[str, Material], own: Mapping[str, Material]) -> dict[str, Material]:
    """Return the added materials that a robot lacks, and those of its own that move.

    A material that both have is written after the links only if it is in both, so that their order does not matter.

    Raises:
        RobotValidationError: DUPLICATE_NAME for two different materials of one name.

    """
    for name, material in added.items():
        if name in own and own[name] != material:
            message = f"Duplicate material name: '{name}', for two different materials"
            raise RobotValidationError(ValidationErrorCode.DUPLICATE_NAME, message, "Material", name)
    return {
        name: own[name].with_fields(after_links=False) if name in own else material
        for name, material in added.items()
        if name not in own or own[name].after_links > material.after_links
    }
