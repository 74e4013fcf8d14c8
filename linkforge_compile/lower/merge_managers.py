"""Merge the parameters of the controller manager that modules state: a robot has one manager."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.controller import HARDWARE, MANAGER, kind_of_names, listed_names
from linkforge_compile.core.part import FrozenMap, SourcedText
from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.names import MODULES_DISAGREE

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.expand.instance import Instance

Path: TypeAlias = tuple[str, ...]
"""The names that lead to a parameter: of maps, then its own."""


class ManagerMerger:
    """Merges the entries of modules into that of the file.

    The file's own parameters win; modules may not disagree. Lists of names have those of all modules.
    """

    def __init__(self, robot: Robot, sink: Diagnostics) -> None:
        self._robot = robot
        self._sink = sink
        self._stated_by: dict[Path, tuple[Instance, str]] = {}

    def move(self, component: Robot, module: Instance) -> None:
        """Move the parameters of a module's manager to that of the file."""
        manager = component.controllers.get(MANAGER)
        if manager is None:
            return
        component.controllers = [one for one in component.controllers if one.name != MANAGER]
        own = self._robot.controllers.get(MANAGER)
        own_paths = {path for path, _ in _leaves(own.parameters)} if own else set()
        if own is None:
            self._robot.add_parts(controllers=[manager])
        else:
            self._report_conflicts(own.parameters, manager.parameters, module)
            merged = own.with_fields(parameters=_merged(own.parameters, manager.parameters))
            self._robot.controllers = [merged if one is own else one for one in self._robot.controllers]
        for path, _ in _leaves(manager.parameters):
            if path not in own_paths:
                self._stated_by[path] = module, path[-1]

    def _report_conflicts(self, own: Mapping[str, object], other: Mapping[str, object], module: Instance) -> None:
        values = dict(_leaves(own))
        for path, value in _leaves(other):
            if path not in self._stated_by or values.get(path, value) == value or kind_of_names(path):
                continue
            first, first_name = self._stated_by[path]
            notes = [
                Note(f"in module '{one.name}' it is {_shown(stated)}", name.source.node.span)
                for one, name, stated in ((first, first_name, values[path]), (module, path[-1], value))
                if isinstance(name, SourcedText) and name.source
            ]
            facts = {"first": first.name, "second": module.name, "parameter": ".".join(path)}
            self._sink.report(MODULES_DISAGREE.at(module.entry, notes=notes, **facts))


def _merged(own: Mapping[str, object], other: Mapping[str, object]) -> Mapping[str, object]:
    """Return the parameters of both, where `own` win; hardware in one of its lists is in no other one."""
    listed = [name for kind, name in listed_names(own) if kind == HARDWARE]
    return _merged_below(own, other, listed, ())


def _merged_below(
    own: Mapping[str, object], other: Mapping[str, object], listed: Collection[str], path: Path
) -> Mapping[str, object]:
    merged = dict(own)  # whose names keep their places
    for name, value in other.items():
        stated, inner, kind = own.get(name), (*path, name), kind_of_names((*path, name))
        if isinstance(stated, Mapping) and isinstance(value, Mapping):
            merged[name] = _merged_below(stated, value, listed, inner)
        elif kind:
            merged[name] = _joined(stated or (), value, listed if kind == HARDWARE else ())
        elif stated is None:
            merged[name] = value
    return FrozenMap(merged)


def _joined(own: object, other: object, listed: Collection[str]) -> object:
    """Return the names of both lists, without those of the other that are listed; `own` where one is no list."""
    if not (isinstance(own, tuple) and isinstance(other, tuple)):
        return own or other
    return (*own, *(name for name in other if name not in own and name not in listed))


def _shown(value: object) -> str:
    """Return a value as YAML has it."""
    return json.dumps(value, ensure_ascii=False)


def _leaves(parameters: Mapping[str, object], path: Path = ()) -> Iterator[tuple[Path, object]]:
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, (*path, name))
        else:
            yield (*path, name), value
