"""The order in which a finished robot says what a spec nests under a name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from operator import attrgetter
from typing import TypeVar

from linkforge_compile.core.models.srdf import SemanticRobotDescription

T = TypeVar("T")


def side_by_side(semantic: SemanticRobotDescription) -> SemanticRobotDescription:
    """Return it with the states of one group, the pairs of one first link and the remarks on one joint side by side.

    A file nests them under that name, so its own are so already; a module may say more about a name that the file
    which uses it has spoken of. The names keep the order in which they first come.
    """
    return replace(
        semantic,
        group_states=_gathered(semantic.group_states, attrgetter("group")),
        disabled_collisions=_gathered(semantic.disabled_collisions, attrgetter("link1")),
        enabled_collisions=_gathered(semantic.enabled_collisions, attrgetter("link1")),
        joint_properties=_gathered(semantic.joint_properties, attrgetter("joint_name")),
    )


def _gathered(members: Iterable[T], name_of: Callable[[T], str]) -> tuple[T, ...]:
    gathered: dict[str, list[T]] = {}
    for member in members:
        gathered.setdefault(name_of(member), []).append(member)
    return tuple(member for members_of_one in gathered.values() for member in members_of_one)
