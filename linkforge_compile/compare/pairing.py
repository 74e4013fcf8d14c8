"""Pair the members of two lists: which one before corresponds to which one after."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.compare.fields import RawElement, match_key
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.models.srdf import (
    Chain,
    CollisionPair,
    GroupState,
    JointProperty,
    LinkSphereApproximation,
    SrdfSphere,
)
from linkforge_compile.core.part import Inside


class Pair(NamedTuple):
    """A member of two lists, None for the list that lacks it; `key` identifies it in a path."""

    key: str
    before: object | None
    after: object | None


def key_of_member(item: object) -> str:
    """Return the name that identifies a member of a list; empty where only its index does."""
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


def pair_members(before: Iterable[object], after: Iterable[object]) -> Iterator[Pair]:
    """Yield the members in the order after, then the removed ones.

    Members with the same key are paired if they are equal, else by name, else by index.
    """
    were, are = _group_by_key(before), _group_by_key(after)
    for key, members in are.items():
        yield from _pairs_of_key(key, were.get(key, {}), members)
    for key, members in were.items():
        if key not in are:
            yield from _pairs_of_key(key, members, {})


def _group_by_key(items: Iterable[object]) -> dict[str, dict[int, object]]:
    """Return the members of each key, by their index among them."""
    found: dict[str, dict[int, object]] = {}
    for item in items:
        members = found.setdefault(key_of_member(item), {})
        members[len(members)] = item
    return found


def _pairs_of_key(key: str, before: Mapping[int, object], after: Mapping[int, object]) -> Iterator[Pair]:
    partners = find_partners(before, after)
    for index, item in after.items():
        yield Pair(_path_key(key, index), before.get(partners.get(index, -1)), item)
    paired = set(partners.values())
    for index, item in before.items():
        if index not in paired:
            yield Pair(_path_key(key, index), item, None)


def _path_key(key: str, index: int) -> str:
    return "/".join((*([key] if key else []), *([str(index)] if index or not key else [])))


def find_partners(before: Mapping[int, object], after: Mapping[int, object]) -> dict[int, int]:
    """Return the indices before by the indices after, for members of the same key."""
    if len(before) == len(after) == 1:
        return {0: 0}
    found: dict[int, int] = {}
    for criterion in _CRITERIA:
        paired = set(found.values())
        free: dict[Hashable, deque[int]] = {}
        for index, item in before.items():
            if index not in paired:
                free.setdefault(criterion(item), deque()).append(index)
        for index, item in after.items():
            if index not in found and (candidates := free.get(criterion(item))):
                found[index] = candidates.popleft()
    return found


def _name_or_identity(item: object) -> Hashable:
    name: str | None = getattr(item, "name", None)
    return id(item) if name is None else name


_CRITERIA: Sequence[Callable[[object], Hashable]] = (match_key, _name_or_identity, lambda _: None)
"""What members must share to be paired, the strictest first."""
