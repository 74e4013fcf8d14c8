"""What differs in an order that means something; that of what has a name means nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import count

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.pairing import partners
from linkforge_compile.compare.words import plain, shortened, told
from linkforge_compile.core.models.link import Link, Visual
from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.core.models.shape_order import COLLISION, VISUAL, shown_colors
from linkforge_compile.core.models.transmission import Transmission

_LONGEST = 200
"""Characters of each of two orders that are shown."""


def order_differences(path: tuple[str, ...], before: object, after: object) -> Iterator[Difference]:
    """Yield in what orders two values of a place differ, which no field of theirs says."""
    match before, after:
        case (Transmission(), Transmission()):
            yield from _ends(path, before, after)
        case (Link(), Link()):
            yield from _recolored(path, before, after)
        case (Material(), Material()) if path[0] == "materials" and before.after_links != after.after_links:
            was, now = ("behind the links" if one.after_links else "before the links" for one in (before, after))
            here = (*path, "after_links")
            yield Difference(Kind.CHANGED, here, before.after_links, after.after_links, f"{was} → {now}")


def _ends(path: tuple[str, ...], before: Transmission, after: Transmission) -> Iterator[Difference]:
    """Yield where the ends of a transmission changed places, which have different parts in it."""
    for what, one, other in (
        ("joints", before.joints, after.joints),
        ("actuators", before.actuators, after.actuators),
    ):
        were, are = [end.name for end in one], [end.name for end in other]
        if sorted(were) == sorted(are):
            yield from _told((*path, what), were, are)


def _recolored(path: tuple[str, ...], before: Link, after: Link) -> Iterator[Difference]:
    """Yield the shapes that MuJoCo shows in another color since another visual comes before them."""
    if before.shapes == after.shapes:
        return
    were, are = _own_colors(before), _own_colors(after)
    same = {
        (kind, now): (kind, was)
        for kind, old, new in (
            (VISUAL, before.visuals, after.visuals),
            (COLLISION, before.collisions, after.collisions),
        )
        for now, was in partners(dict(enumerate(old)), dict(enumerate(new))).items()
    }
    # What a visual says of its own color is told there, so it counts as said of it before.
    as_now = {**were, **{was: are[now] for now, was in same.items()}}
    shown_before, shown_if_told, shown = map(_shown_colors, (were, as_now, are))
    for now, was in same.items():
        old_color, color = shown_before[was], shown[now]
        if color not in (old_color, shown_if_told[was]):
            kind, place = now
            text = f"color {told(old_color)} → {told(color)} in MuJoCo, that of the visual before it"
            yield Difference(Kind.CHANGED, (*path, kind, str(place)), plain(old_color), plain(color), text)


def _own_colors(link: Link) -> dict[tuple[str, int], Color | None]:
    """Return the color that each shape says, by its kind and place there, in the order in which they are written."""
    places = {VISUAL: count(), COLLISION: count()}
    colors: dict[tuple[str, int], Color | None] = {}
    for shape in link.shapes:
        kind, material = (VISUAL, shape.material) if isinstance(shape, Visual) else (COLLISION, None)
        colors[kind, next(places[kind])] = material.color if material else None
    return colors


def _shown_colors(own: Mapping[tuple[str, int], Color | None]) -> dict[tuple[str, int], Color | None]:
    return dict(zip(own, shown_colors(own.values()), strict=True))


def _told(path: tuple[str, ...], were: Sequence[str], are: Sequence[str]) -> Iterator[Difference]:
    if were != are:
        was, now = (shortened(", ".join(names), _LONGEST) for names in (were, are))
        yield Difference(Kind.CHANGED, path, plain(were), plain(are), f"in the order {was} → {now}")
