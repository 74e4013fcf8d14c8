"""What differs in an order that means something; that of what has a name means nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.words import plain, shortened
from linkforge_compile.core.models.link import Link, Visual
from linkforge_compile.core.models.material import Material
from linkforge_compile.core.models.transmission import Transmission

_LONGEST = 200
"""Characters of each of two orders that are shown."""


def order_differences(path: tuple[str, ...], before: object, after: object) -> Iterator[Difference]:
    """Yield in what orders two values of a place differ, which no field of theirs says."""
    match before, after:
        case (Transmission(), Transmission()):
            yield from _ends(path, before, after)
        case (Link(), Link()):
            yield from _shapes(path, before, after)
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


def _shapes(path: tuple[str, ...], before: Link, after: Link) -> Iterator[Difference]:
    """Yield where collisions of a link come behind another visual, whose color they have in MuJoCo."""
    were, are = ([type(shape).__name__.lower() for shape in link.shapes] for link in (before, after))
    if sorted(were) == sorted(are) and _painters(before) != _painters(after):
        yield from _told((*path, "shape_order"), were, are)


def _painters(link: Link) -> Sequence[int | None]:
    """Return for each collision the place of the visual that colors it in MuJoCo, None for none."""
    painters: list[int | None] = []
    painter, visuals = None, 0
    for shape in link.shapes:
        if isinstance(shape, Visual):
            painter = visuals if shape.material and shape.material.color else painter
            visuals += 1
        else:
            painters.append(painter)
    return painters


def _told(path: tuple[str, ...], were: Sequence[str], are: Sequence[str]) -> Iterator[Difference]:
    if were != are:
        was, now = (shortened(", ".join(names), _LONGEST) for names in (were, are))
        yield Difference(Kind.CHANGED, path, plain(were), plain(are), f"in the order {was} → {now}")
