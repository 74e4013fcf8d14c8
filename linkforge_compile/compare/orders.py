"""Compare the orders that have a meaning: ends of transmissions, shapes of a link, materials after links."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.pairing import find_partners
from linkforge_compile.compare.words import describe, shorten, to_plain
from linkforge_compile.core.models.geometry import Color, Material
from linkforge_compile.core.models.link import COLLISION, VISUAL, Link, Visual, shown_colors
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
            was, now = ("behind the links" if one.after_links else "before the links" for one in (before, after))
            here = (*path, "after_links")
            yield Difference(Kind.CHANGED, here, before.after_links, after.after_links, f"{was} → {now}")


def _reordered_ends(path: tuple[str, ...], before: Transmission, after: Transmission) -> Iterator[Difference]:
    """Yield where joints or actuators of a transmission changed places; the place decides their role in it."""
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
