"""What a robot holds, and the questions that one may ask of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import KW_ONLY, dataclass, field
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.exceptions import RobotModelError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.graph import KinematicGraph, single_root
from linkforge_compile.core.models.index import Filing, Index, IndexField, Key, Renamable, Repeats, itself
from linkforge_compile.core.models.robot_fields import SemanticField, VersionStatedField
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.core.resolver import FileSystemResolver, IResourceResolver

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.material import Material
    from linkforge_compile.core.models.ros2_control import Ros2Control
    from linkforge_compile.core.models.semantic_parts import SemanticParts
    from linkforge_compile.core.models.sensor import Sensor
    from linkforge_compile.core.models.transmission import Transmission
    from linkforge_compile.source import SourceRef

PARENT: Final[Key[Joint]] = attrgetter("parent")
CHILD: Final[Key[Joint]] = attrgetter("child")
REFERENCE: Final[Key[GazeboElement]] = attrgetter("reference")


class _Drawn(NamedTuple):
    """A graph, and what it was drawn from."""

    links: Index[Link]
    joints: Index[Joint]
    renamings: int
    graph: KinematicGraph


def require_robot_name(name: str) -> None:
    """Refuse what no robot may be called.

    Raises:
        RobotValidationError: NAME_EMPTY, INVALID_NAME.

    """
    if not name:
        raise RobotValidationError(
            ValidationErrorCode.NAME_EMPTY, "Robot name cannot be empty", "RobotName", name, field=("name",)
        )
    if not is_valid_name(name):
        raise RobotValidationError(
            ValidationErrorCode.INVALID_NAME, "Invalid name format", "RobotName", name, field=("name",)
        )


@dataclass
class Inventory:
    """The parts of a robot, each kind in the order in which it was added, and look-ups by name.

    The collections are tuples to whoever compares or adds them, and answer to names as well (see Index);
    assigning one rebuilds its index. Two links or two joints of one name are refused, by assignment too.
    Sensors, transmissions and ros2_controls of one name can be held, so that a faulty robot can be read and
    checked; adding and merging refuse them.
    """

    name: str
    version: str = IR_VERSION
    materials: dict[str, Material] = field(default_factory=dict)
    metadata: dict[str, object] = field(default_factory=dict)
    resource_resolver: IResourceResolver = field(default_factory=FileSystemResolver, compare=False)
    links: IndexField[Link] = IndexField(Filing("link"), distinct=True)
    joints: IndexField[Joint] = IndexField(Filing("joint"), distinct=True)
    sensors: IndexField[Sensor] = IndexField(Filing("sensor"))
    transmissions: IndexField[Transmission] = IndexField(Filing("transmission"))
    ros2_controls: IndexField[Ros2Control] = IndexField(Filing("ros2_control"))
    gazebo_elements: IndexField[GazeboElement] = IndexField(Filing("gazebo element", REFERENCE, Repeats.KEPT))
    semantic: SemanticField = SemanticField()
    extra_elements: IndexField[str] = IndexField(Filing("extra element", itself, Repeats.KEPT))
    _: KW_ONLY
    extra_attributes: Sequence[tuple[str, str]] | Mapping[str, str] = ()
    version_stated: VersionStatedField = VersionStatedField()
    source: SourceRef | None = field(default=None, compare=False, repr=False)
    _version_stated: bool = field(init=False, repr=False, compare=False)
    _semantic: SemanticParts = field(init=False, repr=False, compare=False)
    _drawn: _Drawn | None = field(default=None, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_robot_name(self.name)
        self.extra_attributes = attribute_pairs(self.extra_attributes)

    def get_link(self, name: str) -> Link | None:
        """Return the link of that name, None if there is none."""
        return self.links.get(name)

    def link(self, name: str) -> Link:
        """Return the link of that name.

        Raises:
            RobotValidationError: NOT_FOUND if there is none.

        """
        return self.links[name]

    def has_link(self, name: str) -> bool:
        """Tell whether there is a link of that name."""
        return name in self.links

    def get_joint(self, name: str) -> Joint | None:
        """Return the joint of that name, None if there is none."""
        return self.joints.get(name)

    def joint(self, name: str) -> Joint:
        """Return the joint of that name.

        Raises:
            RobotValidationError: NOT_FOUND if there is none.

        """
        return self.joints[name]

    def has_joint(self, name: str) -> bool:
        """Tell whether there is a joint of that name."""
        return name in self.joints

    def get_sensor(self, name: str) -> Sensor | None:
        """Return the sensor of that name, None if there is none."""
        return self.sensors.get(name)

    def sensor(self, name: str) -> Sensor:
        """Return the sensor of that name.

        Raises:
            RobotValidationError: NOT_FOUND if there is none.

        """
        return self.sensors[name]

    def has_sensor(self, name: str) -> bool:
        """Tell whether there is a sensor of that name."""
        return name in self.sensors

    def get_transmission(self, name: str) -> Transmission | None:
        """Return the transmission of that name, None if there is none."""
        return self.transmissions.get(name)

    def transmission(self, name: str) -> Transmission:
        """Return the transmission of that name.

        Raises:
            RobotValidationError: NOT_FOUND if there is none.

        """
        return self.transmissions[name]

    def has_transmission(self, name: str) -> bool:
        """Tell whether there is a transmission of that name."""
        return name in self.transmissions

    def get_ros2_control(self, name: str) -> Ros2Control | None:
        """Return the hardware component of that name, None if there is none."""
        return self.ros2_controls.get(name)

    def ros2_control(self, name: str) -> Ros2Control:
        """Return the hardware component of that name.

        Raises:
            RobotValidationError: NOT_FOUND if there is none.

        """
        return self.ros2_controls[name]

    def has_ros2_control(self, name: str) -> bool:
        """Tell whether there is a hardware component of that name."""
        return name in self.ros2_controls

    def get_gazebo_elements(self, reference: str | None = None) -> list[GazeboElement]:
        """Return the Gazebo elements about one link or joint; all of them for None."""
        if reference is None:
            return list(self.gazebo_elements)
        return list(self.gazebo_elements.where(REFERENCE, reference))

    @property
    def says_semantic(self) -> bool:
        """True once something semantic was assigned or added, be it an empty description."""
        return not self._semantic.silent

    def get_joints_for_link(self, link_name: str, as_parent: bool = True) -> list[Joint]:
        """Return the joints whose parent (or child) the link is, in the order of the joints."""
        return list(self.joints.where(PARENT if as_parent else CHILD, link_name))

    def get_child_joints(self, link_name: str) -> list[Joint]:
        """Return the joints whose parent the link is, in the order of the joints; none for an unknown link."""
        return self.get_joints_for_link(link_name)

    def get_parent_joint(self, link_name: str) -> Joint | None:
        """Return the first joint whose child the link is, None for a root and for an unknown link."""
        return next(self.joints.where(CHILD, link_name), None)

    def get_parent_link(self, link_name: str) -> Link | None:
        """Return the parent of the first joint whose child the link is, None for a root and for an unknown link."""
        joint = self.get_parent_joint(link_name)
        return self.get_link(joint.parent) if joint else None

    def get_child_links(self, link_name: str) -> list[Link]:
        """Return the children of the joints whose parent the link is, in the order of the joints.

        Raises:
            RobotValidationError: NOT_FOUND for a child that is no link of the robot.

        """
        return [self.link(joint.child) for joint in self.get_child_joints(link_name)]

    def get_root_link(self) -> Link:
        """Return the one link that is no joint's child.

        Raises:
            RobotValidationError: NO_ROOT, MULTIPLE_ROOTS, or NOT_FOUND for a joint without its links.

        """
        return self.link(single_root(self.graph))

    @property
    def root_link(self) -> Link:
        """The one link that is no joint's child; raises what `get_root_link` raises."""
        return self.get_root_link()

    @property
    def graph(self) -> KinematicGraph:
        """The links and joints as a graph, drawn anew when they have changed.

        Raises:
            RobotValidationError: NOT_FOUND for a joint without its links.

        """
        # Indices never change, so the same two of them, with nothing renamed since, are the same graph.
        drawn = self._drawn
        if (
            drawn is None
            or drawn.links is not self.links
            or drawn.joints is not self.joints
            or drawn.renamings != Renamable.renamings
        ):
            graph = KinematicGraph(self.links, self.joints)
            drawn = self._drawn = _Drawn(self.links, self.joints, Renamable.renamings, graph)
        return drawn.graph

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
        """Return the file behind a URI, as the robot's resolver finds it.

        Raises:
            FileNotFoundError: There is no such file.

        """
        return self.resource_resolver.resolve(uri, relative_to=relative_to)

    @contextmanager
    def unchanged_on_error(self) -> Iterator[None]:
        """Let the robot be as it was before the block where that raises, materials and metadata excepted."""
        before = dict(vars(self))  # collections never change in place, so this holds all of them
        try:
            yield
        except BaseException:
            vars(self).clear()
            vars(self).update(before)
            raise

    def __str__(self) -> str:
        return (
            f"Robot(name={self.name}, links={len(self.links)}, joints={len(self.joints)}, "
            f"dof={self.degrees_of_freedom})"
        )

    def summary(self) -> str:
        """Return a few lines about the robot: valid means one root and no cycle."""
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

    def __getstate__(self) -> dict[str, object]:
        return {**vars(self), "_drawn": None}
