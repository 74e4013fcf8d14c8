"""Masses and inertias: those of a possible body, and of one like the shapes of its link."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator

from linkforge_compile.checks.bounding import MESH_SLACK, primitive_volume
from linkforge_compile.checks.mesh_files import RobotMeshes
from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.link import Inertial, InertiaTensor, Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.moments import principal_moments
from linkforge_compile.core.physics import inertial_of_shapes, rotated
from linkforge_compile.diagnostics import Code, Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.physics import (
    DENSE_LINK,
    FAR_CENTRE,
    FLATTER_THAN_A_PLATE,
    IMPOSSIBLE_INERTIA,
    INDEFINITE_INERTIA,
    LARGE_INERTIA,
    LIGHT_LINK,
    SMALL_INERTIA,
    TURNED_PRODUCTS,
    WIDE_INERTIA,
    ZERO_INERTIA,
)
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.units import UNITS, Dimension, units_of

ROUNDING = 1e-6
"""The tolerance on moments, relative to the largest: tensors are often written with six digits."""

NEARLY_FLAT = 0.01
"""A largest moment that exceeds the sum of the others by up to this part of it is that of a thin body, measured."""


def check_inertia(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The principal moments of inertia of a link with mass are above 0, and none exceeds the sum of the other two.

    The moments [kg·m²] of any rigid body are so; the largest equals that sum for a flat plate. Physics engines refuse
    other tensors, change them or blow up; up to one percent above the sum, as of a thin body, only MuJoCo does.
    Leave `inertia` out to have it computed from the shapes, or take the tensor from CAD in kg·m² about the
    centre of mass: products with the wrong sign and millimetres or grams are the usual causes.
    A frame without mass may have any tensor.
    """
    for link in robot.links:
        if not link.mass:
            continue
        fault = _inertia_fault(moments := principal_moments(link.inertia))
        if fault:
            shown = " ".join(f"{moment:.4g}" for moment in moments) + " kg·m²"
            small, middle, large = moments
            yield fault.at(
                link.source,
                "inertial",
                "inertia",
                link=link.name,
                mass=f"{link.mass:g}",
                moments=shown,
                excess=f"{100 * (large - small - middle) / large:.2g}" if large else "",
            )


def _inertia_fault(moments: tuple[float, float, float]) -> Code | None:
    small, middle, large = moments
    if small == large == 0:
        return ZERO_INERTIA
    if small <= 0:
        return INDEFINITE_INERTIA
    excess = large - small - middle
    if excess > NEARLY_FLAT * large:
        return IMPOSSIBLE_INERTIA
    return FLATTER_THAN_A_PLATE if excess > ROUNDING * large else None


LEAST_SHARE = 0.01
"""What part of the robot's mass a link has to have: small parts often get masses and tensors that only keep a solver
from failing, and markers for shapes.
"""

LIGHTEST, DENSEST = 1.0, 25_000.0
"""Bounds of what links are made of [kg/m³]: air weighs 1.2, osmium 22,600."""

WIDEST = 10.0
"""The radius of gyration of a body some 30 m wide [m]; no link is."""

LARGEST, SMALLEST = 100.0, 1e-3
"""Bounds of an inertia as a part of that of the box around the shapes: a body in that box has 3 at most."""

USUAL = 0.4
"""What part of the inertia of the box around it a body often has."""

TOO_LARGE = {
    UNITS[name].denominator / UNITS[name].numerator: name
    for name in units_of(Dimension.INERTIA)
    if name != Dimension.INERTIA.si_unit
}
"""The units of inertia that the language reads, by how much a number in one is too large in kg·m²."""

FARTHEST = 10.0
"""How many times the size of its shapes a centre of mass may lie outside of them."""


def check_density(robot: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A link is neither lighter than the air around it nor denser than any metal.

    Reported if its mass over the volume of its shapes is less than 1 kg/m³, or over the box around them more than
    25,000 kg/m³. Shapes in millimetres or a mass in grams or tonnes are the usual causes: write the units.
    Meshes are measured by some of their corners, if they are .stl, .obj or .dae files on this machine: for them the
    bounds are a hundredth and ten times of these. Links with less than a hundredth of the robot's mass are not checked.
    """
    for link, inertial in _bodies(robot):
        bounds = meshes.bounds(link)
        measured = [primitive_volume(shapes) for shapes in (link.visuals, link.collisions)]
        volumes = [volume for volume in measured if volume is not None]
        least, slack = min(volumes, default=None), 1.0
        if least is None and bounds and bounds.has_meshes:
            least, slack = bounds.volume or None, MESH_SLACK
        # The volume of a shape below 1e-108 m is 0.
        in_box = math.inf if least == 0 else inertial.mass / bounds.volume if bounds and bounds.volume else 0.0
        facts = {"link": link.name, "mass": f"{inertial.mass:g}"}
        if least and (density := inertial.mass / least) < LIGHTEST / slack**2:
            yield LIGHT_LINK.at(link.source, "inertial", "mass", notes=(), density=f"{density:.2g}", **facts)
        elif bounds and in_box > DENSEST * bounds.slack:
            yield DENSE_LINK.at(link.source, "inertial", "mass", notes=(), density=f"{in_box:.2g}", **facts)


def check_inertia_scale(robot: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """An inertia is about that of a body of the link's mass and size.

    Reported if it is more than a hundred times, or less than a thousandth, of that of a box around the link's shapes
    with its mass (a thousand times for meshes); if meshes cannot be measured, if it is that of a body 30 m wide. CAD
    programs give g·mm² or kg·mm², which are 1e9 and 1e6 times the number in kg·m²: write the unit, such as
    '350 kg*mm^2', or leave `inertia` out to have it computed. Links with less than a hundredth of the robot's mass are
    not checked.
    """
    for link, inertial in _bodies_with_a_tensor(robot):
        moment = (inertial.inertia.ixx + inertial.inertia.iyy + inertial.inertia.izz) / 2
        bounds = meshes.bounds(link)
        boxed = inertial.mass * bounds.box.diagonal * bounds.box.diagonal / 12 if bounds else 0.0
        if bounds and boxed:
            part = moment / boxed
            if part > LARGEST * bounds.slack:
                code, hint = LARGE_INERTIA, _unit_hint(part)
                fault = code.at(link.source, "inertial", "inertia", link=link.name, factor=_power(part), hint=hint)
                yield fault.with_fix(_with_unit(link, hint.rpartition(" ")[2]) if hint else None)
            elif 0 < part < SMALLEST:
                yield SMALL_INERTIA.at(link.source, "inertial", "inertia", link=link.name, factor=_power(part))
        elif moment > inertial.mass * WIDEST**2:
            size, mass = math.sqrt(12 * moment / inertial.mass), f"{inertial.mass:g}"
            yield WIDE_INERTIA.at(link.source, "inertial", "inertia", link=link.name, size=f"{size:.2g}", mass=mass)


def _power(factor: float) -> str:
    """Return a factor as people write it: 300, 3e4, 2e-5."""
    rounded = f"{factor:.0e}"
    if 1e-4 <= float(rounded) < 1e4:
        return f"{float(rounded):g}"
    return re.sub("e([+-])0*", lambda sign: "e-" if sign[1] == "-" else "e", rounded)


def _unit_hint(part: float) -> str:
    """Return a hint at the unit that the number is probably in, "" without one."""
    factor = min(TOO_LARGE, key=lambda factor: abs(math.log10(part / USUAL / factor)))
    return f"; write the unit if it is in {TOO_LARGE[factor]}" if 0.3 < part / USUAL / factor < 3 else ""


def _with_unit(link: Link, unit: str) -> Fix | None:
    """Return the fix that writes a unit after all moments of a link; None if one of them has its own."""
    moments = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    return _change_moments(
        link, f"write '{unit}'", moments, lambda text: f"{text} {unit}" if _NUMBER.fullmatch(text) else None
    )


def _negated(text: str) -> str | None:
    """Return a number or a quantity with the opposite sign; None for an expression or another text."""
    number = text.split(" ", maxsplit=1)[0]
    if not _NUMBER.fullmatch(number):
        return None
    return text[1:] if text.startswith("-") else f"-{text.removeprefix('+')}"


def _change_moments(link: Link, title: str, moments: Iterable[str], change: Callable[[str], str | None]) -> Fix | None:
    """Return the fix that changes the moments and products of a link that are written; None if one cannot be."""
    inertial = link.source.node.child("inertial") if link.source else None
    tensor = None if inertial is None else inertial.child("inertia")
    values = [] if tensor is None else [tensor.child(name) for name in moments]
    places = [value.span for value in values if value is not None]
    texts = [change(place.text or "") for place in places if not place.file.is_xml and place.origin is None]
    if not texts or len(texts) < len(places) or None in texts:
        return None
    return Fix(title, tuple(Edit(place, text) for place, text in zip(places, texts, strict=True) if text))


_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def check_centre_of_mass(robot: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """The centre of mass lies in or near the shapes of its link.

    Reported if it is ten times the size of the shapes away from them: millimetres instead of metres, or a pose in
    the frame of another link. `origin` is in the frame of the link. Meshes are measured as far as they are .stl,
    .obj or .dae files on this machine.
    """
    for link, inertial in _bodies_with_a_tensor(robot):
        box = bounds.box if (bounds := meshes.bounds(link)) else None
        if box and (distance := box.distance(inertial.origin.xyz)) > FARTHEST * box.diagonal > 0:
            size = f"{box.diagonal:.2g}"
            yield FAR_CENTRE.at(
                link.source, "inertial", "origin", link=link.name, distance=f"{distance:.3g}", size=size
            )


def check_signs_of_products(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The products of inertia have the signs of the tensor's entries, as URDF wants them: ixy = -∫ x·y dm.

    Some CAD programs give ∫ x·y dm. Reported if the tensor is that of the link's shapes but for the signs of
    its products: change all three. Links with meshes are not checked.
    """
    for link, inertial in _bodies_with_a_tensor(robot):
        shapes = [(shape.geometry, shape.origin) for shape in link.collisions or link.visuals]
        tensor = inertial.inertia
        if not shapes or not any(_products(tensor)) or any(isinstance(geometry, Mesh) for geometry, _ in shapes):
            continue
        try:
            computed = inertial_of_shapes(shapes, mass=inertial.mass).inertia
            is_turned = _has_negated_products(rotated(tensor, inertial.origin.rpy), computed)
        except RobotModelError:
            # The powers of 1e200 m and 1e-200 m are beyond a double.
            continue
        if is_turned:
            fault = TURNED_PRODUCTS.at(link.source, "inertial", "inertia", link=link.name)
            yield fault.with_fix(_change_moments(link, "change the signs", ("ixy", "ixz", "iyz"), _negated))


def _has_negated_products(tensor: InertiaTensor, computed: InertiaTensor) -> bool:
    """Return whether two tensors agree but for the signs of their products, which are not negligible."""
    moments = [getattr(tensor, name) - getattr(computed, name) for name in ("ixx", "iyy", "izz")]
    sums = [one + other for one, other in zip(_products(tensor), _products(computed), strict=True)]
    size = math.hypot(*_products(computed))
    trace = computed.ixx + computed.iyy + computed.izz
    return size > trace / 20 and math.hypot(*sums) < size / 3 and math.hypot(*moments) < trace / 3


def _products(tensor: InertiaTensor) -> tuple[float, float, float]:
    return tensor.ixy, tensor.ixz, tensor.iyz


def _bodies(robot: Robot) -> Iterator[tuple[Link, Inertial]]:
    """Yield the links whose mass is not negligible, without those whose inertial replaces a faulty one."""
    least = LEAST_SHARE * robot.total_mass
    for link in robot.links:
        inertial = link.inertial
        if inertial and inertial.mass > 0 and inertial.mass >= least and (inertial.source or not link.source):
            yield link, inertial


def _bodies_with_a_tensor(robot: Robot) -> Iterator[tuple[Link, Inertial]]:
    """Yield those of the links whose tensor was stated, not computed here."""
    for link, inertial in _bodies(robot):
        if inertial.source is None or inertial.source.node.child("inertia") is not None:
            yield link, inertial
