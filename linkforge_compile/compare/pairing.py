"""Which member of a list before is which of the list after."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.compare.likeness import likeness
from linkforge_compile.compare.raw_parts import RawElement
from linkforge_compile.core.models.collision_rules import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.models.planning import Chain, GroupState, JointProperty
from linkforge_compile.core.part import Inside


class Pair(NamedTuple):
    """A member of both lists, or of one; None for the list that lacks it. `key` says which, in a path."""

    key: str
    before: object | None
    after: object | None


def key_of(item: object) -> str:
    """Return what tells a member of a list apart; "" for one that only its place does."""
    match item:
        case str():
            return str(item)
        case Visual() | Collision() | SrdfSphere():
            return ""
        case GazeboElement():
            return item.reference or "robot"
        case CollisionPair():
            return "/".join(item.key)
        case GroupState():
            return f"{item.group}/{item.name}"
        case JointProperty():
            return f"{item.joint_name}/{item.property_name}"
        case LinkSphereApproximation():
            return item.link
        case Chain():
            return f"{item.base_link}/{item.tip_link}"
        case Inside() | RawElement():
            return f"{item.tag}/{item.name}" if item.name else item.tag
    name: str | None = getattr(item, "name", None)
    return name or ""


def paired(before: Iterable[object], after: Iterable[object]) -> Iterator[Pair]:
    """Yield the members in the order after, then those that are gone.

    Of those that have the same key, or none, equal ones belong together, then those of one name, then the nth ones.
    """
    were, are = _by_key(before), _by_key(after)
    for key, members in are.items():
        yield from _pairs(key, were.get(key, {}), members)
    for key, members in were.items():
        if key not in are:
            yield from _pairs(key, members, {})


def _by_key(items: Iterable[object]) -> dict[str, dict[int, object]]:
    """Return the members of each key by their places: among all for those without a key, else among their likes."""
    found: dict[str, dict[int, object]] = {}
    for item in items:
        likes = found.setdefault(key_of(item), {})
        likes[len(likes)] = item
    return found


def _pairs(key: str, before: Mapping[int, object], after: Mapping[int, object]) -> Iterator[Pair]:
    places = partners(before, after)
    taken = set(places.values())
    for place, item in after.items():
        yield Pair(_shown(key, place), before.get(places.get(place, -1)), item)
    for place, item in before.items():
        if place not in taken:
            yield Pair(_shown(key, place), item, None)


def _shown(key: str, place: int) -> str:
    return "/".join((*([key] if key else []), *([str(place)] if place or not key else [])))


def partners(before: Mapping[int, object], after: Mapping[int, object]) -> dict[int, int]:
    """Return by place after the place before, of members of one key."""
    if len(before) == len(after) == 1:
        return {0: 0}
    found: dict[int, int] = {}
    for trait_of in _TRAITS:
        taken = set(found.values())
        free: dict[Hashable, deque[int]] = {}
        for place, item in before.items():
            if place not in taken:
                free.setdefault(trait_of(item), deque()).append(place)
        for place, item in after.items():
            if place not in found and (places := free.get(trait_of(item))):
                found[place] = places.popleft()
    return found


def _name_of(item: object) -> Hashable:
    name: str | None = getattr(item, "name", None)
    # What has no name shares it with nobody.
    return id(item) if name is None else name


_TRAITS: Sequence[Callable[[object], Hashable]] = (likeness, _name_of, lambda _: None)
"""What members that belong together have in common, the closest tie first."""
