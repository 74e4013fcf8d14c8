"""Building a link call by call: its shapes, its mass, its sensors, and the joint to its parent."""

from __future__ import annotations

from dataclasses import replace
from types import TracebackType
from typing import Any, Protocol, Self, runtime_checkable

from linkforge_compile.core.builders.joint_draft import JointDraft
from linkforge_compile.core.builders.link_draft import Triple, pose
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.geometry import IDENTITY, Geometry, Material, Mesh, Transform
from linkforge_compile.core.models.link import Collision, Inertial, InertiaTensor, Link, LinkPhysics, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.physics import Solid, calculate_inertia, inertial_of_shapes


@runtime_checkable
class IComposer(Protocol):
    """A builder that holds a robot under construction and the links that are not finished yet."""

    robot: Robot

    def link(self, name: str, parent: str | None = None, joint_name: str | None = None) -> LinkBuilder:
        """Begin a link."""
        ...

    def material(self, name: str, color: tuple[float, float, float, float] | None = None) -> IComposer:
        """Define a material that links may name."""
        ...

    def build(self, validate: bool = True) -> Robot:
        """Finish all links and return the robot."""
        ...

    def register_link_builder(self, builder: LinkBuilder) -> None:
        """Remember a link that is to be finished before the robot is."""
        ...

    def push_parent(self, name: str) -> None:
        """Make a link the parent of links that name none."""
        ...

    def pop_parent(self, name: str | None = None) -> None:
        """Take that link off again; None for the one that was made parent last."""
        ...


class LinkBuilder(JointDraft):
    """A link under construction, made by `RobotBuilder.link` or `child`; every call returns it.

    It joins the robot when it is committed: by `commit`, `root`, `child` or `build`, by the robot's own `build`, or
    at the end of a `with` block, inside of which it is the parent of the links that name none. A call after that
    raises RuntimeError.
    """

    def __init__(self, builder: IComposer, name: str, parent: str | None = None, joint_name: str | None = None) -> None:
        super().__init__(name, parent, joint_name)
        self._builder = builder
        self._mass: float | None = None
        self._inertia: InertiaTensor | None = None
        self._inertial_origin: Transform | None = None
        self._visuals: list[Visual] = []
        self._collisions: list[Collision] = []
        self._physics = LinkPhysics()
        self._gazebo: dict[str, Any] = {}  # fields of GazeboElement
        self._in_context = False
        builder.register_link_builder(self)

    def __enter__(self) -> Self:
        # The links inside are children of this one: the robot must have a link of its name by then.
        self._builder.robot.add_link(Link(self._link_name))
        self._in_context = True
        self._builder.push_parent(self._link_name)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._builder.pop_parent(self._link_name)
        if error is None:
            self._commit()

    def visual(
        self,
        geometry: Geometry,
        xyz: Triple = (0, 0, 0),
        rpy: Triple = (0, 0, 0),
        material: str | Material | None = None,
        name: str | None = None,
    ) -> Self:
        """Add a shape to look at, at `xyz` [m] turned by `rpy` [rad] in the link frame.

        Raises:
            RobotValidationError: NOT_FOUND for a material that is named but not defined.

        """
        self._check_not_committed()
        self._visuals.append(Visual(geometry, pose(xyz, rpy), self._material(material), name))
        return self

    def _material(self, material: str | Material | None) -> Material | None:
        if not isinstance(material, str):
            return material
        defined = self._builder.robot.materials.get(material)
        if defined is None:
            raise RobotValidationError.not_found(
                f"Material '{material}' not found. Did you call builder.material('{material}', ...) first?",
                "Material",
                material,
            )
        return defined

    def collision(
        self,
        geometry: Geometry | None = None,
        xyz: Triple | None = None,
        rpy: Triple | None = None,
        name: str | None = None,
    ) -> Self:
        """Add a shape to touch; None for the last visual's, with its pose if neither xyz nor rpy is given.

        Raises:
            RobotValidationError: GENERIC_FAILURE where there is no visual to take the shape from.

        """
        self._check_not_committed()
        origin = pose(xyz, rpy)
        if geometry is None:
            if not self._visuals:
                raise RobotValidationError(
                    ValidationErrorCode.GENERIC_FAILURE,
                    "Cannot infer collision geometry: no visuals defined",
                    target="LinkBuilder",
                    value=self._link_name,
                )
            geometry = self._visuals[-1].geometry
            if xyz is None and rpy is None:
                origin = self._visuals[-1].origin
        self._collisions.append(Collision(geometry, origin, name))
        return self

    def mass(
        self,
        value: float,
        origin_xyz: Triple | None = None,
        origin_rpy: Triple | None = None,
        inertia: InertiaTensor | None = None,
    ) -> Self:
        """Give the mass [kg], and its centre [m] with the axes of the tensor [rad] in the link frame.

        An inertia that is not given is computed from the collisions, or the visuals if there are none; a centre that is
        not given is theirs. Without shapes the inertia is the stability floor. A mesh is read for it when the
        link joins the robot, which refuses one that is no watertight file that the robot's resolver finds.
        """
        self._check_not_committed()
        self._mass = value
        self._inertia = inertia or self._inertia
        if origin_xyz is not None or origin_rpy is not None:
            self._inertial_origin = pose(origin_xyz, origin_rpy)
        return self

    def inertia(  # noqa: PLR0917 the contract's signature
        self, ixx: float, iyy: float, izz: float, ixy: float = 0, ixz: float = 0, iyz: float = 0
    ) -> Self:
        """Give the tensor about the centre of mass [kg·m²]; it counts only together with a mass."""
        self._check_not_committed()
        self._inertia = InertiaTensor(ixx, iyy, izz, ixy, ixz, iyz)
        return self

    def physics(self, **properties: Any) -> Self:  # Any: each field has a type of its own
        """Set fields of LinkPhysics (self_collide, gravity, mu, mu2, kp, kd), others on a GazeboElement."""
        self._check_not_committed()
        known = {name: properties.pop(name) for name in field_specs(LinkPhysics) if name in properties}
        self._physics = replace(self._physics, **known)
        self._gazebo.update(properties)
        return self

    def child(self, name: str, joint_name: str | None = None) -> LinkBuilder:
        """Commit this link and begin a child of it."""
        self._commit()
        return LinkBuilder(self._builder, name, parent=self._link_name, joint_name=joint_name)

    def commit(self) -> IComposer:
        """Add the link to the robot and return the robot's builder.

        Raises:
            RobotModelError: What the robot or its parts refuse; the robot is as it was by then.

        """
        self._commit()
        return self._builder

    def root(self) -> IComposer:
        """Commit the link as the root.

        Raises:
            RobotValidationError: GENERIC_FAILURE if it has a parent.

        """
        if self._parent:
            raise RobotValidationError(
                ValidationErrorCode.GENERIC_FAILURE,
                f"Link '{self._link_name}' has a parent '{self._parent}' and cannot be root",
                target="LinkBuilder",
            )
        return self.commit()

    def build(self) -> Robot:
        """Commit the link and return the whole robot."""
        self._commit()
        return self._builder.build()

    def _commit(self) -> None:
        if self._committed:
            return
        robot = self._builder.robot
        link = Link(self._link_name, self._inertial(), self._physics, self._visuals, self._collisions)
        joint = self._make_joint()
        transmission = self._make_transmission(joint) if joint else None
        control = self._make_control(joint, robot.ros2_controls) if joint else None
        gazebo = [GazeboElement(reference=self._link_name, **self._gazebo)] if self._gazebo else []
        if joint:
            robot.require_parent(joint)
        robot.add_parts(
            links=[] if self._in_context else [link],
            sensors=self._sensors,
            gazebo_elements=gazebo,
            joints=[joint] if joint else [],
            transmissions=[transmission] if transmission else [],
        )
        if self._in_context:
            robot.add_link(link, overwrite=True)
        if control:
            robot.update_ros2_control(control)
        self._committed = True

    def _inertial(self) -> Inertial | None:
        if self._mass is None:
            return None
        shapes = [(shape.geometry, shape.origin) for shape in self._collisions or self._visuals]
        if self._inertia is not None or not shapes:
            inertia = self._inertia or InertiaTensor.stability_floor()
            return Inertial(self._mass, self._inertial_origin or IDENTITY, inertia)
        solids = self._solids([geometry for geometry, _ in shapes])
        if len(shapes) == 1 and not solids:
            ((geometry, origin),) = shapes
            return Inertial(self._mass, self._inertial_origin or origin, calculate_inertia(geometry, self._mass))
        body = inertial_of_shapes(shapes, mass=self._mass, meshes=solids)
        return replace(body, origin=self._inertial_origin) if self._inertial_origin else body

    def _solids(self, geometries: list[Geometry]) -> dict[Mesh, Solid]:
        if not any(isinstance(geometry, Mesh) for geometry in geometries):
            return {}
        from linkforge_compile.core.meshes import solids_of

        return solids_of(geometries, self._builder.robot.resource_resolver)
