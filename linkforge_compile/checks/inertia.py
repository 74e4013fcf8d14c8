"""Masses and inertias that a rigid body can have."""

from __future__ import annotations

import math
from collections.abc import Iterator

from linkforge_compile.core.models.link import InertiaTensor
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.physics import (
    IMPOSSIBLE_INERTIA,
    INDEFINITE_INERTIA,
    ZERO_INERTIA,
)

ROUNDING = 1e-6
"""How far a moment may pass its bound, as a part of the largest: tensors are often written with six digits."""

ROUNDED_AWAY = 1e-12
"""What part of the largest moment the arithmetic may leave where there is none."""

TURNS = 60
"""Enough turns of the axes for any tensor; five rounds of three do for most."""


def check_inertia(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A body with mass resists turning about every axis, and about none more than about the other two together.

    The principal moments of any body are above 0 [kg·m²], and the largest is at most the sum of the other
    two: it reaches that for a flat plate. Physics engines refuse other tensors, change them or blow up.
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
            yield fault.at(link.source, "inertial", "inertia", link=link.name, mass=f"{link.mass:g}", moments=shown)


def _inertia_fault(moments: tuple[float, float, float]) -> Code | None:
    small, middle, large = moments
    if small == large == 0:
        return ZERO_INERTIA
    if small <= 0:
        return INDEFINITE_INERTIA
    if large > small + middle + ROUNDING * large:
        return IMPOSSIBLE_INERTIA
    return None


def principal_moments(inertia: InertiaTensor) -> tuple[float, float, float]:
    """Return the eigenvalues of the tensor, smallest first [kg·m²]; exactly 0 for what only rounding left over.

    Turns the axes until the products vanish (Jacobi), which keeps small moments exact where a closed formula
    loses them in the rounding of the large ones.
    """
    xx, yy, zz = inertia.ixx, inertia.iyy, inertia.izz
    xy, xz, yz = inertia.ixy, inertia.ixz, inertia.iyz
    for _ in range(TURNS):
        if abs(xy) + abs(xz) + abs(yz) <= 1e-15 * (abs(xx) + abs(yy) + abs(zz)):
            break
        # One turn about z removes xy; then the axes change places, so that each product has its turn.
        angle = math.atan2(math.copysign(2 * xy, xy * (xx - yy)), abs(xx - yy)) / 2
        sine, cosine = math.sin(angle), math.cos(angle)
        xx, yy = (
            cosine * cosine * xx + 2 * sine * cosine * xy + sine * sine * yy,
            sine * sine * xx - 2 * sine * cosine * xy + cosine * cosine * yy,
        )
        xz, yz = cosine * xz + sine * yz, cosine * yz - sine * xz
        xx, yy, zz, xy, xz, yz = yy, zz, xx, yz, 0.0, xz
    scale = ROUNDED_AWAY * max(abs(xx), abs(yy), abs(zz))
    small, middle, large = sorted([moment if abs(moment) > scale else 0.0 for moment in (xx, yy, zz)])
    return small, middle, large
