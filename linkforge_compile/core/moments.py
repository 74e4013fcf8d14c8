"""Principal moments of inertia, and the nearest tensor that a body can have."""

from __future__ import annotations

import math
from dataclasses import replace

from linkforge_compile.core.models.link import InertiaTensor

ROUNDED_AWAY = 1e-12
"""A moment below this part of the largest one is a rounding error of 0."""

MAX_ROTATIONS = 60
"""Enough Jacobi rotations for any tensor; most need fifteen."""


def principal_moments(inertia: InertiaTensor) -> tuple[float, float, float]:
    """Return the eigenvalues of the tensor, smallest first [kg·m²]; exactly 0 for rounding errors.

    Jacobi rotations keep small moments exact where a closed formula loses them to the rounding of the large ones, and
    numpy is not always installed.
    """
    xx, yy, zz = inertia.ixx, inertia.iyy, inertia.izz
    xy, xz, yz = inertia.ixy, inertia.ixz, inertia.iyz
    for _ in range(MAX_ROTATIONS):
        if abs(xy) + abs(xz) + abs(yz) <= 1e-15 * (abs(xx) + abs(yy) + abs(zz)):
            break
        # A rotation about z removes xy; then the axes change places, for the next product.
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


def possible_inertia(inertia: InertiaTensor, least: float = 0.0) -> InertiaTensor:
    """Return the tensor itself if a body can have it, else with the least addition to all moments that makes it so.

    A body can have moments above `least` [kg·m²], none of which exceeds the sum of the others. The addition is the
    same about every axis, so that the principal axes stay.
    """
    small, middle, large = principal_moments(inertia)
    missing = max(large - middle - small, least - small)
    if missing <= ROUNDED_AWAY * large:
        return inertia
    missing *= 1 + ROUNDED_AWAY  # rounding must not leave it short
    return replace(inertia, ixx=inertia.ixx + missing, iyy=inertia.iyy + missing, izz=inertia.izz + missing)
