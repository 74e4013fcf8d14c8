"""Compare two robots whose files lie in different folders: let the same file have the same path in both."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import is_dataclass, replace
from functools import partial
from typing import Any

from linkforge_compile.compare.fields import compared_fields
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface


def with_folders(robot: Robot, folders: Mapping[str, str]) -> Robot:
    """Return a robot with absolute paths below some folders, in texts and meshes, moved to other folders.

    `folders` are absolute, the new ones by the old ones. Only fields that are compared are complete in the result.
    """
    moved = {old: new for old, new in folders.items() if old != new}
    if not moved:
        return robot
    choices = "|".join(map(re.escape, sorted(moved, key=len, reverse=True)))
    # As `package_paths` of an import finds them, so that `/opt/arm` is not in `/opt/arm2` or `/data/opt/arm`.
    pattern = re.compile(rf"(?:(?<=file://)|(?<![\w./-]))(?:{choices})(?![\w.-])")
    return with_texts(robot, partial(pattern.sub, lambda match: moved[match[0]]))


def with_texts(robot: Robot, change: Callable[[str], str]) -> Robot:
    """Return a robot with all texts in it changed. Only fields that are compared are complete in the result."""
    found = _map_texts(robot, change)
    assert isinstance(found, Robot)
    return found


def _map_texts(value: object, change: Callable[[str], str]) -> object:
    """Return a value with all texts in it changed; the value itself if no text changes."""
    match value:
        case _ if is_dataclass(value) and not isinstance(value, type):
            old = {name: getattr(value, name) for name in compared_fields(value)}
            new = {name: _map_texts(item, change) for name, item in old.items()}
            changes = {name: item for name, item in new.items() if item is not old[name]}
            return replace(value, **changes) if changes else value
        case Interface():
            fields: dict[str, Any] = {name: _map_texts(getattr(value, name), change) for name in compared_fields(value)}
            is_changed = any(item is not getattr(value, name) for name, item in fields.items())
            return Interface(str(value), source=value.source, **fields) if is_changed else value
        case str():
            text = change(value)
            return value if text == value else text
        case Mapping():
            entries = {name: _map_texts(item, change) for name, item in value.items()}
            return entries if any(item is not value[name] for name, item in entries.items()) else value
        case tuple() | list():
            items = tuple(_map_texts(item, change) for item in value)
            return items if any(one is not other for one, other in zip(items, value, strict=True)) else value
    return value
