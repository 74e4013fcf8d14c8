"""Compare values that depend on several fields: poses, inertias, and orders that have a meaning."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import count

from linkforge_compile.compare.difference import Difference, Kind, Plain, describe, shorten, to_plain
from linkforge_compile.compare.fields import ANGLE, BARE, describe_change, describe_distance, describe_number
from linkforge_compile.compare.matching import find_partners
from linkforge_compile.core.models.geometry import Color, Material, Transform, Vector3
from linkforge_compile.core.models.link import COLLISION, VISUAL, InertiaTensor, Link, Visual, shown_colors
from linkforge_compile.core.models.transmission import Transmission

_MAX_ORDER = 200
"""Characters shown of each of two orders."""


def order_differences(path: tuple[str, ...], before: object, after: object) -> Iterator[Difference]:
    """Yield the differences in order between two values, which the comparison of their fields does not find."""
    match before, after:
        case (Transmission(), Transmission()):
            yield from _reordered_ends(path, before, after)
        case (Link(), Link()):
            yield from _recolored_shapes(path, before, after)
        case (Material(), Material()) if path[0] == "materials" and before.after_links != after.after_links:
            was, now = ("after the links" if one.after_links else "before the links" for one in (before, after))
            here = (*path, "after_links")
            yield Difference(Kind.CHANGED, here, before.after_links, after.after_links, f"{was} → {now}")


def _reordered_ends(path: tuple[str, ...], before: Transmission, after: Transmission) -> Iterator[Difference]:
    """Yield where joints or actuators of a transmission changed places, and so their roles."""
    for key, old, new in (("joints", before.joints, after.joints), ("actuators", before.actuators, after.actuators)):
        were, are = [end.name for end in old], [end.name for end in new]
        if were != are and sorted(were) == sorted(are):
            was, now = (shorten(", ".join(names), _MAX_ORDER) for names in (were, are))
            text = f"in the order {was} → {now}"
            yield Difference(Kind.CHANGED, (*path, key), to_plain(were), to_plain(are), text)


def _recolored_shapes(path: tuple[str, ...], before: Link, after: Link) -> Iterator[Difference]:
    """Yield the shapes that MuJoCo shows in another color because another visual precedes them."""
    if before.shapes == after.shapes:
        return
    were, are = _own_colors(before), _own_colors(after)
    same = {
        (kind, now): (kind, was)
        for kind, old, new in (
            (VISUAL, before.visuals, after.visuals),
            (COLLISION, before.collisions, after.collisions),
        )
        for now, was in find_partners(dict(enumerate(old)), dict(enumerate(new))).items()
    }
    # A change of a visual's own color is reported at the visual, so assume that color before as well.
    recolored = {**were, **{was: are[now] for now, was in same.items()}}
    shown_before, shown_if_recolored, shown = map(_shown_colors, (were, recolored, are))
    for now, was in same.items():
        old_color, color = shown_before[was], shown[now]
        if color not in (old_color, shown_if_recolored[was]):
            kind, place = now
            text = f"color {describe(old_color)} → {describe(color)} in MuJoCo, that of the visual before it"
            yield Difference(Kind.CHANGED, (*path, kind, str(place)), to_plain(old_color), to_plain(color), text)


def _own_colors(link: Link) -> dict[tuple[str, int], Color | None]:
    """Return the color that each shape states, by kind and index, in the order in which shapes are written."""
    places = {VISUAL: count(), COLLISION: count()}
    colors: dict[tuple[str, int], Color | None] = {}
    for shape in link.shapes:
        kind, material = (VISUAL, shape.material) if isinstance(shape, Visual) else (COLLISION, None)
        colors[kind, next(places[kind])] = material.color if material else None
    return colors


def _shown_colors(own: Mapping[tuple[str, int], Color | None]) -> dict[tuple[str, int], Color | None]:
    return dict(zip(own, shown_colors(own.values()), strict=True))


_ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def pose_differences(
    path: tuple[str, ...], before: Transform, after: Transform, tolerance: float
) -> Iterator[Difference]:
    """Yield how far a pose moved [m] and turned [rad], if by more than the tolerance."""
    shift = [new - old for old, new in zip(before.xyz, after.xyz, strict=True)]
    distance, angle = math.hypot(*shift), _angle_between(before.rpy, after.rpy)
    words = []
    if distance > tolerance:
        along = [
            f"{axis} {'+' if by > 0 else '-'}{describe_distance(abs(by))}"
            for axis, by in zip("xyz", shift, strict=True)
            if abs(by) > tolerance
        ]
        words.append(f"moved by {describe_distance(distance)}" + (f" ({', '.join(along)})" if along else ""))
    if angle > tolerance:
        words.append(f"turned by {describe_number(angle, ANGLE, 4)}")
    if words:
        yield Difference(Kind.CHANGED, path, _plain_pose(before), _plain_pose(after), ", ".join(words))


def _plain_pose(pose: Transform) -> dict[str, Plain]:
    return {"xyz": to_plain(pose.xyz), "rpy": to_plain(pose.rpy)}


def _angle_between(before: Vector3, after: Vector3) -> float:
    """Return the angle of the rotation between two orientations, given as rpy [rad]."""
    if before == after:
        return 0.0
    w, x, y, z = _quaternion(before)
    w2, x2, y2, z2 = _quaternion(after)
    cosine = w * w2 + x * x2 + y * y2 + z * z2
    sine = math.hypot(
        w * x2 - x * w2 - y * z2 + z * y2, w * y2 - y * w2 - z * x2 + x * z2, w * z2 - z * w2 - x * y2 + y * x2
    )
    return 2 * math.atan2(sine, abs(cosine))


def _quaternion(rpy: Vector3) -> tuple[float, float, float, float]:
    """Return (w, x, y, z) for rotations about the fixed axes x, y, z, in this order."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in rpy)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def tensor_differences(
    path: tuple[str, ...], before: InertiaTensor, after: InertiaTensor, tolerance: float
) -> Iterator[Difference]:
    """Yield the entries of a tensor that differ by more than the tolerance, relative to its largest entry."""
    pairs = {name: (getattr(before, name), getattr(after, name)) for name in _ENTRIES}
    largest = max(abs(entry) for pair in pairs.values() for entry in pair)
    changed = {name: pair for name, pair in pairs.items() if abs(pair[1] - pair[0]) > tolerance * largest}
    if changed:
        words = ", ".join(f"{name} {describe_change(*pair, BARE)}" for name, pair in changed.items())
        yield Difference(Kind.CHANGED, path, _plain_tensor(before), _plain_tensor(after), f"{words} kg*m^2")


def _plain_tensor(tensor: InertiaTensor) -> dict[str, Plain]:
    return {name: getattr(tensor, name) for name in _ENTRIES}
