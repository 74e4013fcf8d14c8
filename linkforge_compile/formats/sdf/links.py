"""Links, joints and shapes in SDF."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from linkforge_compile.core.constants import LEAST_MASS, MIN_REASONABLE_INERTIA
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Geometry, Material, Mesh, Sphere
from linkforge_compile.core.models.joint import AXES, Joint, JointType
from linkforge_compile.core.models.link import Inertial, InertiaTensor, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.moments import possible_inertia, principal_moments
from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.kinematic_tree import WORLD
from linkforge_compile.formats.mesh_paths import find_file
from linkforge_compile.formats.sdf.elements import parent, pose, text
from linkforge_compile.formats.sdf.layout import MODEL, Layout
from linkforge_compile.formats.sdf.models import Models
from linkforge_compile.formats.sdf.part_names import NamedShape, PartNames
from linkforge_compile.formats.sdf.raw_sensors import sensor_elements
from linkforge_compile.formats.sdf.settings import (
    Settings,
    collision_elements,
    joint_physics,
    link_elements,
    shape_elements,
    spring_elements,
)
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import NOTHING, Xml


class Links:
    """Makes the views of the links that are bodies."""

    def __init__(self, layout: Layout, models: Models, uris: MeshUris) -> None:
        self._layout, self._models, self._settings, self._uris = layout, models, layout.settings, uris
        self.names = PartNames(layout)

    def view(self, link: Link, sensors: Mapping[str, list[View]]) -> View:
        """Return a link with the shapes and sensors of all that it holds; `sensors` are those of each link."""
        held = self._layout.held[link.name]
        return View(
            attributes=attributes_at(link.source, name=link.name),
            pose=self._models.place(link.name, self._models.of_link(link.name)),
            inertial=inertial_element(link, is_weightless=link.name in self._layout.weightless),
            settings=self._settings_of(link, held),
            visuals=[self._visual(each, link) for one in held for each in self.names.visuals[one.name]],
            collisions=[self._collision(each, link) for one in held for each in self.names.collisions[one.name]],
            sensors=[sensor for one in held for sensor in sensors.get(one.name, ())],
        )

    def _settings_of(self, link: Link, held: Iterable[Link]) -> Xml:
        of_gazebo = self._settings.get(link.name, ())
        sensors = (sensor_elements(self._settings.get(one.name, ()), one, link, self.names.collision) for one in held)
        return Xml("".join([link_elements(of_gazebo), *sensors]))

    def _visual(self, named: NamedShape, body: Link) -> Xml:
        of_gazebo = shape_elements("visual", self._settings.get(named.link.name, ()))
        own = named.shape.material if isinstance(named.shape, Visual) else None
        # A material of Gazebo's settings is in place of that of the visual.
        material = self._material(own) if own and "<material" not in of_gazebo else NOTHING
        return self._shape(named, body, Xml(material + of_gazebo))

    def _collision(self, named: NamedShape, body: Link) -> Xml:
        return self._shape(named, body, collision_elements(self._settings.get(named.link.name, ())))

    def _shape(self, named: NamedShape, body: Link, rest: Xml) -> Xml:
        link, shape, name = named
        origin = pose(shape.origin, relative_to=None if link is body else link.name)
        geometry = parent("geometry", self._geometry(shape.geometry))
        return Xml(f"<{shape.TAG}{attributes_at(shape.source, name=name)}>{origin}{geometry}{rest}</{shape.TAG}>")

    def _geometry(self, shape: Geometry) -> Xml:
        where = shape.source
        match shape:
            case Box(size=size):
                inner: Iterable[Xml] = (text("size", size, where, "size"),)
            case Sphere(radius=radius):
                inner = (text("radius", radius, where, "radius"),)
            case Cylinder(radius=radius, length=length) | Capsule(radius=radius, length=length):
                inner = (text("radius", radius, where, "radius"), text("length", length, where, "length"))
            case Mesh(scale=scale):
                uri = text("uri", self._uris.of(shape.resource), where, "file")
                inner = (uri, text("scale", scale if shape.is_scale_written else None, where, "scale"))
        return parent(shape.TAG, *inner)

    def _material(self, material: Material) -> Xml:
        """Return a material: a color is that of all light, and a texture the colors of a surface."""
        where, color = material.source, material.color
        rgba = color.to_tuple() if color else None
        colors = (text(tag, rgba, where, "color") for tag in ("ambient", "diffuse", "specular"))
        texture = self._uris.of(material.texture) if material.texture else None
        pbr = parent("pbr", parent("metal", text("albedo_map", texture, where, "texture")))
        return parent("material", *colors, pbr)


def inertial_element(link: Link, *, is_weightless: bool) -> Xml:
    """Return the mass properties of a link: the same numbers, unless no body can have them."""
    inertial = link.inertial
    if is_weightless or inertial is None:
        least = MIN_REASONABLE_INERTIA
        inertial = Inertial(LEAST_MASS, inertia=InertiaTensor(least, least, least))
    tensor, where = _accepted(inertial.inertia), inertial.inertia.source
    entries = (text(name, getattr(tensor, name), where, name) for name in InertiaTensor.ATTRIBUTE_ORDER)
    return parent(
        "inertial",
        pose(inertial.origin),
        text("mass", inertial.mass, inertial.source, "mass"),
        parent("inertia", *entries),
    )


def has_possible_inertia(link: Link) -> bool:
    """Whether a body can have the tensor of a link."""
    return _accepted(link.inertia) == link.inertia


def _accepted(inertia: InertiaTensor) -> InertiaTensor:
    """Return a tensor that Gazebo accepts: its closed formula for moments of one with products errs by 1e-8 of them."""
    has_products = inertia.ixy or inertia.ixz or inertia.iyz
    return possible_inertia(inertia, 1e-7 * principal_moments(inertia)[2] if has_products else 0.0)


_TYPES = {JointType.CONTINUOUS: "revolute"}


def joint_view(
    joint: Joint, layout: Layout, models: Models, settings: Settings, sensors: Sequence[View], *, has_mimic: bool
) -> View:
    """Return a joint; its frame is that of its child, as in URDF, so that the axis has the same numbers."""
    is_on_world, model = layout.is_world(joint.parent), models.of_joint(joint)
    above = models.link_in(model, joint.parent)
    return View(
        attributes=attributes_at(
            joint.source, name=layout.joint_names[joint.name], type=_TYPES.get(joint.type, joint.type)
        ),
        pose=pose(joint.origin, relative_to=MODEL if is_on_world else above),
        parent=text("parent", WORLD if is_on_world else above, joint.source, "parent"),
        child=text("child", models.link_in(model, joint.child), joint.source, "child"),
        axis=NOTHING if joint.type == JointType.FIXED else _axis(joint, models, settings, has_mimic=has_mimic),
        physics=joint_physics(settings),
        sensors=sensors,
    )


def _axis(joint: Joint, models: Models, settings: Settings, *, has_mimic: bool) -> Xml:
    """Return an axis; a missing limit is 0, as to URDF readers, and a continuous joint has none."""
    limits, dynamics, source = joint.limits, joint.dynamics, joint.source
    of_limits: list[Xml] = []
    if limits:
        if joint.type != JointType.CONTINUOUS:
            of_limits.append(text("lower", limits.lower or 0.0, limits.source, "lower"))
            of_limits.append(text("upper", limits.upper or 0.0, limits.source, "upper"))
        of_limits.append(text("effort", limits.effort, limits.source, "effort"))
        of_limits.append(text("velocity", limits.velocity, limits.source, "velocity"))
    of_dynamics = list(spring_elements(settings))
    if dynamics:
        of_dynamics.append(text("damping", dynamics.damping, dynamics.source, "damping"))
        of_dynamics.append(text("friction", dynamics.friction, dynamics.source, "friction"))
    return parent(
        "axis",
        text("xyz", joint.axis or AXES["x"], source, "axis"),
        parent("limit", *of_limits),
        parent("dynamics", *of_dynamics),
        _mimic(joint, models) if has_mimic else NOTHING,
    )


def _mimic(joint: Joint, models: Models) -> Xml:
    mimic = joint.mimic
    if mimic is None or (leader := models.leader(joint)) is None:
        return NOTHING
    source = mimic.source
    inner = (
        text("multiplier", mimic.multiplier, source, "multiplier"),
        text("offset", mimic.offset, source, "offset"),
        text("reference", 0.0, source),
    )
    return Xml(f"<mimic{attributes_at(source, joint=leader)}>{''.join(inner)}</mimic>")


def joint_frame(joint: Joint, layout: Layout, models: Models) -> Xml:
    """Return the frame of a joint that is none in SDF."""
    is_on_world = layout.is_world(joint.parent)
    attached_to = None if is_on_world else models.link_in(models.of_joint(joint), joint.parent)
    attributes = attributes_at(joint.source, name=layout.joint_names[joint.name], attached_to=attached_to)
    return Xml(f"<frame{attributes}>{pose(joint.origin)}</frame>")


def link_frame(name: str, layout: Layout, models: Models) -> Xml:
    """Return the frame of a link without a body: at its joint, and on what carries it if that is below it."""
    link, joint, model = layout.robot.links[name], layout.above.get(name), models.of_link(name)
    if name in layout.carriers:
        attributes = attributes_at(link.source, name=name, attached_to=layout.carriers[name])
        return Xml(f"<frame{attributes}>{models.place(name, model, is_frame=True)}</frame>")
    where = layout.joint_names[joint.name] if joint else MODEL
    return Xml(f"<frame{attributes_at(link.source, name=name, attached_to=where)}/>")


_PACKAGE, _MODEL = "package://", "model://"


class MeshUris:
    """Makes the URIs of files: `model://` for those of packages, or the files on this machine."""

    def __init__(self, robot: Robot, *, is_resolved: bool) -> None:
        self._robot, self._is_resolved = robot, is_resolved

    def of(self, resource: str) -> str:
        """Return the URI of a file; one that is not found on this machine is not resolved."""
        path = find_file(self._robot, resource) if self._is_resolved else None
        if path:
            return path.as_posix()  # Gazebo decodes no `%20` of a URI
        return _MODEL + resource.removeprefix(_PACKAGE) if resource.startswith(_PACKAGE) else resource
