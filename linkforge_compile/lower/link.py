"""Links: their visuals, their collisions and their inertial."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkforge_compile.core.constants import DEFAULT_LINK_MASS
from linkforge_compile.core.fields import ABOVE_ZERO, NOT_NEGATIVE
from linkforge_compile.core.models.geometry import Geometry, Mesh, Transform
from linkforge_compile.core.models.link import (
    PHYSICS_TAGS,
    Collision,
    Inertial,
    InertiaTensor,
    Link,
    LinkPhysics,
    Visual,
)
from linkforge_compile.core.physics import inertial_of_shapes
from linkforge_compile.diagnostics.codes.model import (
    COPY_OF_NOTHING,
    DENSITY_WITH_INERTIA,
    INERTIA_OF_NOTHING,
    MASS_AND_DENSITY,
    NO_MASS,
    ORIGIN_WITHOUT_INERTIA,
    WRONG_KIND,
)
from linkforge_compile.lower.elements import lower_element, lower_fields, lower_origin
from linkforge_compile.lower.extra import common_kwargs, outer_extras_of
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.geometry import lower_geometry
from linkforge_compile.lower.material import lower_visual_material
from linkforge_compile.lower.numbers import NumberType, describe_node
from linkforge_compile.lower.scope import FileScope
from linkforge_compile.source import Key, SourceRef
from linkforge_compile.syntax.nodes import YamlFault, YamlMap, YamlScalar
from linkforge_compile.units import Dimension

_MASS, _MASS_TO_SPREAD = NumberType((Dimension.MASS,), NOT_NEGATIVE), NumberType((Dimension.MASS,), ABOVE_ZERO)
_DENSITY = NumberType((Dimension.DENSITY,), ABOVE_ZERO)

_UNSAID_PHYSICS = LinkPhysics()

Shapes = Sequence[Visual | None] | Sequence[Collision | None]


def lower_links(file: Fields, scope: FileScope) -> Iterator[tuple[str, Link | None]]:
    """Lower the links of a file, None for one that is lost."""
    return file.each("links", "link", lambda fields, name: _link(fields, name, scope))


def _link(fields: Fields, name: str, scope: FileScope) -> Link | None:
    """Lower one link; a faulty part of it is left out, so None only for a name that no link may have."""
    valid = fields.name_is_valid(name, "link")
    visuals = [_visual(fields.map_at(node, "visual"), scope) for node in fields.items("visual")]
    collisions = _collisions(fields, visuals, scope)
    inertial, physics = _inertial(fields, collisions or visuals, scope), _physics(fields)
    shape_order = _shape_order(fields, visuals, collisions)
    if not valid:
        return None
    return Link(
        name,
        inertial,
        physics,
        tuple([visual for visual in visuals if visual]),
        tuple([collision for collision in collisions if collision]),
        shape_order=shape_order,
        source=_source(fields),
        **outer_extras_of(fields),
    )


def _source(link: Fields) -> SourceRef:
    """Return where a link was written; a key that is none may have been meant for the shapes that it does not have."""
    if not link.is_faulty:
        return link.ref
    lost = next(entry for entry in link.node if isinstance(entry.value, YamlFault))
    return replace(link.ref, node=YamlMap({"visual": lost, "collision": lost, **link.node.entries}, link.node.span))


def _shape_order(link: Fields, visuals: Shapes, collisions: Shapes) -> tuple[str, ...]:
    said = [name for name in link.node.entries if name in _OF_ORDER]
    if "shape_order" not in said and said != ["collision", "visual"]:
        return ()
    # Few links have an order of their own: a command's first line of work does not wait for what reads it.
    from linkforge_compile.lower.shape_order import lower_shape_order

    return lower_shape_order(link, visuals, collisions)


_OF_ORDER = ("visual", "collision", "shape_order")


def _physics(link: Fields) -> LinkPhysics:
    """Lower how a simulator treats a link in contact; what is unsaid or faulty is as the simulator has it."""
    unsaid, physics = _UNSAID_PHYSICS, link.map("physics")
    if physics is None:
        return unsaid
    lowered = physics.build(lambda: LinkPhysics(**lower_fields(LinkPhysics, physics), source=physics.ref))
    if lowered is None:
        return unsaid
    said = [name for name in PHYSICS_TAGS if physics.node.get(name) is not None]
    return replace(lowered, stated=[name for name in said if getattr(lowered, name) == getattr(unsaid, name)])


def _visual(shape: Fields | None, scope: FileScope) -> Visual | None:
    if shape is None:
        return None
    geometry, origin = lower_geometry(shape, scope), lower_origin(shape)
    material, name = lower_visual_material(shape, scope), shape.text("name")
    return Visual(geometry, origin, material, name, **common_kwargs(shape)) if geometry else None


def _collisions(link: Fields, visuals: list[Visual | None], scope: FileScope) -> list[Collision | None]:
    node = link.node.get("collision")
    if not isinstance(node, YamlScalar):
        return [_collision(link.map_at(shape, "collision"), scope) for shape in link.items("collision")]
    if node.text != "visual":
        link.report(
            WRONG_KIND,
            node,
            field="collision",
            expected="a shape, a list of them or 'visual'",
            found=describe_node(node),
        )
        return [None]
    if not visuals and not link.is_faulty:
        link.report(COPY_OF_NOTHING, node, owner=link.title)
    return [Collision(one.geometry, one.origin, source=one.source) if one else None for one in visuals]


def _collision(shape: Fields | None, scope: FileScope) -> Collision | None:
    if shape is None:
        return None
    geometry, origin, name = lower_geometry(shape, scope), lower_origin(shape), shape.text("name")
    return Collision(geometry, origin, name, **common_kwargs(shape)) if geometry else None


def _inertial(link: Fields, shapes: Shapes, scope: FileScope) -> Inertial | None:
    """Lower the inertial: as written, or computed from these shapes; without `inertial`, none."""
    inertial = link.map("inertial")
    if inertial is None and link.node.get("inertial") is None:
        return None
    # What is faulty has been told: a stand-in keeps the checks from telling of a link without mass as well.
    return (inertial and _written_or_computed(link, inertial, shapes, scope)) or Inertial(DEFAULT_LINK_MASS)


def _written_or_computed(link: Fields, inertial: Fields, shapes: Shapes, scope: FileScope) -> Inertial | None:
    written = inertial.node.get("inertia") is not None
    mass = inertial.number("mass", _MASS if written else _MASS_TO_SPREAD)
    density = inertial.number("density", _DENSITY)
    origin = lower_origin(inertial)
    if written:
        return _written(inertial, mass, origin)
    if (node := inertial.node.get("origin")) is not None:
        inertial.report(ORIGIN_WITHOUT_INERTIA, node, owner=inertial.title)
    elif _one_of_mass_and_density(inertial) and _has_shapes(link, inertial, shapes):
        return _computed(inertial, shapes, scope, mass, density)
    return None


def _written(inertial: Fields, mass: float | None, origin: Transform) -> Inertial | None:
    tensor = _tensor(inertial)
    if (density := inertial.node.get("density")) is not None:
        inertial.report(DENSITY_WITH_INERTIA, density, owner=inertial.title)
        return None
    if inertial.node.get("mass") is None:
        inertial.report_incomplete(NO_MASS, owner=inertial.title, choices="'mass'")
    if mass is None or tensor is None:
        return None
    return Inertial(mass, origin, tensor, **common_kwargs(inertial))


def _tensor(inertial: Fields) -> InertiaTensor | None:
    inertia = inertial.map("inertia")
    return lower_element(InertiaTensor, inertia) if inertia else None


def _one_of_mass_and_density(inertial: Fields) -> bool:
    mass, density = inertial.node.get("mass"), inertial.node.get("density")
    if mass is None and density is None:
        inertial.report_incomplete(NO_MASS, owner=inertial.title, choices="'mass' or 'density'")
    elif mass is not None and density is not None:
        inertial.report(MASS_AND_DENSITY, inertial.ref, Key("density"), owner=inertial.title)
    else:
        return True
    return False


def _has_shapes(link: Fields, inertial: Fields, shapes: Shapes) -> bool:
    if not shapes and not link.is_faulty:
        inertial.report(INERTIA_OF_NOTHING, inertial.ref, owner=inertial.title)
    return bool(shapes)


def _computed(
    inertial: Fields, shapes: Shapes, scope: FileScope, mass: float | None, density: float | None
) -> Inertial | None:
    """Compute mass, centre and tensor over all shapes together; None where one of them is faulty, or none there."""
    bodies: list[tuple[Geometry, Transform]] = [(shape.geometry, shape.origin) for shape in shapes if shape]

    def compute() -> Inertial | None:
        meshes = [geometry for geometry, _ in bodies if isinstance(geometry, Mesh)]
        read = {mesh: scope.meshes.solid(mesh, inertial.ref, inertial.sink) for mesh in meshes}
        solids = {mesh: solid for mesh, solid in read.items() if solid}
        if len(bodies) < len(shapes) or len(solids) < len(read) or (mass is None and density is None):
            return None
        computed = inertial_of_shapes(bodies, mass=mass, density=density, meshes=solids)
        return replace(computed, **common_kwargs(inertial))

    return inertial.build(compute)
