"""Links: shapes, the inertial as written or computed from the shapes, and the order of the shapes in the output."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkforge_compile.core.constants import DEFAULT_LINK_MASS
from linkforge_compile.core.fields import ABOVE_ZERO, NOT_NEGATIVE
from linkforge_compile.core.models.geometry import Geometry, Mesh, Transform
from linkforge_compile.core.models.link import (
    COLLISION,
    KINDS,
    PAIRS,
    USUAL_PHYSICS,
    VISUAL,
    Collision,
    Inertial,
    InertiaTensor,
    Link,
    LinkPhysics,
    Visual,
    grouped,
    in_pairs,
)
from linkforge_compile.core.physics import inertial_of_shapes
from linkforge_compile.diagnostics import notes_of
from linkforge_compile.diagnostics.codes.model import (
    COPY_OF_NOTHING,
    DENSITY_WITH_INERTIA,
    INERTIA_OF_NOTHING,
    MASS_AND_DENSITY,
    NO_MASS,
    ORIGIN_WITHOUT_INERTIA,
    SHAPE_ORDER_COUNT,
    UNKNOWN_CHOICE,
)
from linkforge_compile.diagnostics.entry_fixes import leave_out
from linkforge_compile.lower.elements import extras_of, lower_element, lower_pose, outer_extras_of
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import EXTENT, EXTENT_OF_GROUND, NumberType
from linkforge_compile.lower.shapes import FileScope, lower_geometry, lower_visual_material
from linkforge_compile.source import Key, SourceRef
from linkforge_compile.source.provenance import join_links, overrides_of
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlScalar
from linkforge_compile.units import Dimension

_MASS, _MASS_TO_SPREAD = NumberType((Dimension.MASS,), NOT_NEGATIVE), NumberType((Dimension.MASS,), ABOVE_ZERO)
_DENSITY = NumberType((Dimension.DENSITY,), ABOVE_ZERO)

Shapes = Sequence[Visual | None] | Sequence[Collision | None]


def lower_links(file: Fields, scope: FileScope) -> Iterator[tuple[str, Link | None]]:
    """Lower the links of a file, None for one with a faulty name; other faulty parts of a link are omitted."""
    return file.each("links", "link", lambda fields, name: _lower_link(fields, name, scope))


def _lower_link(fields: Fields, name: str, scope: FileScope) -> Link | None:
    is_valid = fields.name_is_valid(name, "link")
    extent = _extent_of_shapes(fields)
    visuals = [_lower_visual(fields.map_at(node, "visual"), scope, extent) for node in fields.items("visual")]
    collisions = _lower_collisions(fields, visuals, scope, extent)
    inertial = _lower_inertial(fields, collisions or visuals, scope)
    physics = fields.map("physics")
    lowered_physics = lower_element(LinkPhysics, physics) if physics else None
    shape_order = _lower_shape_order(fields, visuals, collisions)
    if not is_valid:
        return None
    link = Link(
        name,
        inertial,
        lowered_physics or USUAL_PHYSICS,
        [visual for visual in visuals if visual],
        [collision for collision in collisions if collision],
        shape_order=shape_order,
        **outer_extras_of(fields),
    )
    return link.with_source(_source_of(fields))


def _source_of(link: Fields) -> SourceRef:
    """Return where a link was written; a field that could not be read may be the shapes that it does not have."""
    if not link.is_faulty:
        return link.ref
    fault = next(entry for entry in link.node if isinstance(entry.value, YamlFault))
    return replace(link.ref, node=YamlMap({"visual": fault, "collision": fault, **link.node.entries}, link.node.span))


# Shapes


def _extent_of_shapes(link: Fields) -> NumberType:
    """Return which sizes are plausible; a link of mass 0 is Bullet's ground, which may be very wide."""
    inertial = link.node.get("inertial")
    mass = inertial.child("mass") if inertial else None
    is_ground = isinstance(mass, YamlScalar) and mass.value == 0 and mass.value is not False
    return EXTENT_OF_GROUND if is_ground else EXTENT


def _lower_visual(shape: Fields | None, scope: FileScope, extent: NumberType) -> Visual | None:
    if shape is None:
        return None
    geometry, material = lower_geometry(shape, scope, extent), lower_visual_material(shape, scope)
    return lower_element(Visual, shape, geometry=geometry, material=material)


def _lower_collisions(
    link: Fields, visuals: list[Visual | None], scope: FileScope, extent: NumberType
) -> list[Collision | None]:
    """Lower `collision`: a shape, a list of them, or `visual` for the shapes of the visuals."""
    node = link.node.get("collision")
    if not isinstance(node, YamlScalar):
        shapes = (link.map_at(shape, "collision") for shape in link.items("collision"))
        return [
            lower_element(Collision, shape, geometry=lower_geometry(shape, scope, extent)) if shape else None
            for shape in shapes
        ]
    if node.text != "visual":
        link.report_wrong_kind(node, "collision", "a shape, a list of them or 'visual'")
        return [None]
    if not visuals and not link.is_faulty:
        link.report(COPY_OF_NOTHING, node, owner=link.title)
    return [
        Collision(visual.geometry, visual.origin).with_source(visual.source) if visual else None for visual in visuals
    ]


# The inertial


def _lower_inertial(link: Fields, shapes: Shapes, scope: FileScope) -> Inertial | None:
    """Lower the inertial as written, or computed from these shapes; a substitute for a faulty one."""
    inertial = link.map("inertial")
    if inertial is None and link.node.get("inertial") is None:
        return None
    # The fault is reported: with the substitute, checks do not report a link without mass as well.
    return (inertial and _written_or_computed(link, inertial, shapes, scope)) or Inertial(DEFAULT_LINK_MASS)


def _written_or_computed(link: Fields, inertial: Fields, shapes: Shapes, scope: FileScope) -> Inertial | None:
    is_written = inertial.node.get("inertia") is not None
    mass = inertial.number("mass", _MASS if is_written else _MASS_TO_SPREAD)
    density = inertial.number("density", _DENSITY)
    if is_written:
        return _as_written(inertial, mass)
    lower_pose(inertial)
    if (node := inertial.node.get("origin")) is not None:
        inertial.report(ORIGIN_WITHOUT_INERTIA, node, owner=inertial.title)
    elif _has_mass_or_density(inertial):
        if shapes:
            return _computed(inertial, shapes, scope, mass, density)
        if not link.is_faulty:
            inertial.report(INERTIA_OF_NOTHING, inertial.ref, owner=inertial.title)
    return None


def _as_written(inertial: Fields, mass: float | None) -> Inertial | None:
    inertia = inertial.map("inertia")
    tensor = lower_element(InertiaTensor, inertia) if inertia else None
    lowered = lower_element(Inertial, inertial, mass=mass, inertia=tensor)
    if (density := inertial.node.get("density")) is not None:
        inertial.report(DENSITY_WITH_INERTIA, density, owner=inertial.title)
        return None
    if inertial.node.get("mass") is None:
        inertial.report_incomplete(NO_MASS, owner=inertial.title, choices="'mass'")
    return lowered


def _has_mass_or_density(inertial: Fields) -> bool:
    mass, density = inertial.node.get("mass"), inertial.node.get("density")
    if mass is None and density is None:
        inertial.report_incomplete(NO_MASS, owner=inertial.title, choices="'mass' or 'density'")
    elif mass is not None and density is not None:
        fixes = [leave_out(inertial.ref, key) for key in ("mass", "density")]
        inertial.report(MASS_AND_DENSITY, inertial.ref, Key("density"), fixes=fixes, owner=inertial.title)
    else:
        return True
    return False


def _computed(
    inertial: Fields, shapes: Shapes, scope: FileScope, mass: float | None, density: float | None
) -> Inertial | None:
    """Compute mass, centre and tensor of all shapes together; None where one of them is faulty or not found."""
    bodies: list[tuple[Geometry, Transform]] = [(shape.geometry, shape.origin) for shape in shapes if shape]

    def compute() -> Inertial | None:
        meshes = [geometry for geometry, _ in bodies if isinstance(geometry, Mesh)]
        read = {mesh: scope.meshes.solid(mesh, inertial.ref, inertial.sink) for mesh in meshes}
        solids = {mesh: solid for mesh, solid in read.items() if solid}
        if len(bodies) < len(shapes) or len(solids) < len(read) or (mass is None and density is None):
            return None
        computed = inertial_of_shapes(bodies, mass=mass, density=density, meshes=solids)
        return replace(computed, **extras_of(inertial)).with_source(inertial.ref)

    return inertial.build(compute)


# The order of the shapes


def _lower_shape_order(link: Fields, visuals: Shapes, collisions: Shapes) -> tuple[str, ...]:
    """Return the kinds of the shapes in the order of the output, () for the usual order: visuals first.

    It is that of `shape_order`, else that of the keys. None among the shapes is a faulty one.
    """
    keys = [name for name in link.node.entries if name in KINDS]
    if "shape_order" not in link.node.entries and keys != [COLLISION, VISUAL]:
        return ()
    counts = {VISUAL: len(visuals), COLLISION: len(collisions)}
    kinds = [kind for kind in dict.fromkeys((*keys, *KINDS)) for _ in range(counts[kind])]
    # The number of shapes that a faulty link should have is unknown.
    is_whole = not link.is_faulty and None not in (*visuals, *collisions)
    order = tuple(_written_shape_order(link, kinds, is_whole=is_whole) or kinds)
    return () if order[:1] == (VISUAL,) and order == grouped(order) else order


def _written_shape_order(link: Fields, kinds: Sequence[str], *, is_whole: bool) -> Sequence[str] | None:
    """Return the order that `shape_order` gives to these kinds, None for no order or a faulty one."""
    node = link.node.get("shape_order")
    match node:
        case None | YamlFault():
            return None
        case YamlScalar() if node.text == PAIRS:
            return in_pairs(kinds)
        case YamlList():
            return _listed_shape_order(link, node, kinds) if is_whole else None
    link.report_wrong_kind(node, "shape_order", f"'{PAIRS}' or a list of the words '{VISUAL}' and '{COLLISION}'")
    return None


def _listed_shape_order(link: Fields, node: YamlList, kinds: Sequence[str]) -> Sequence[str] | None:
    words = [link.text_at(item, "shape_order") for item in node]
    for item, word in zip(node, words, strict=True):
        if word is not None and word not in KINDS:
            link.report(UNKNOWN_CHOICE, item, near=KINDS, field="shape_order", choices=", ".join(KINDS), name=word)
    listed = [word for word in words if word in KINDS]
    if len(listed) < len(words):
        return None
    if sorted(listed) == sorted(kinds):
        return listed
    parts = [link.node, *(part for kind in KINDS if (part := link.node.get(kind)))]
    overrides = overrides_of([change for part in parts for change in part.span.changes], node.span)
    facts = {"owner": link.title, "expected": _count_words(kinds), "found": _count_words(listed)}
    notes = notes_of(join_links(overrides))
    fault = SHAPE_ORDER_COUNT.at(SourceRef(node, None, link.trail), notes=notes, **facts)
    link.sink.report(fault.replacing("", PAIRS))
    return None


def _count_words(kinds: Sequence[str]) -> str:
    counts = {kind: kinds.count(kind) for kind in KINDS}
    return " and ".join(f"{count} {kind}{'' if count == 1 else 's'}" for kind, count in counts.items())
