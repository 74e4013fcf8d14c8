"""Merge the parameters of the controller manager that modules state: a robot has one manager."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER, Controller
from linkforge_compile.core.part import FrozenMap
from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.names import MODULES_DISAGREE

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.expand.instance import Instance


class ManagerMerger:
    """Merges the entries of modules into that of the file, whose own parameters win; modules may not disagree."""

    def __init__(self, robot: Robot, sink: Diagnostics) -> None:
        self._robot = robot
        self._sink = sink
        self._stated_by: dict[str, tuple[Instance, Controller]] = {}

    def move(self, component: Robot, module: Instance) -> None:
        """Move the parameters of a module's manager to that of the file."""
        manager = component.controllers.get(MANAGER)
        if manager is None:
            return
        component.controllers = [one for one in component.controllers if one.name != MANAGER]
        own = self._robot.controllers.get(MANAGER)
        if own is None:
            self._robot.add_parts(controllers=[manager])
        else:
            merged = own.with_fields(parameters=FrozenMap({**manager.parameters, **own.parameters}))
            self._robot.controllers = [merged if one is own else one for one in self._robot.controllers]
        for name, value in manager.parameters.items():
            if own is None or name not in own.parameters:
                self._stated_by[name] = module, manager
            elif name in self._stated_by and own.parameters[name] != value:
                self._report(name, module, manager)

    def _report(self, name: str, module: Instance, manager: Controller) -> None:
        first, first_manager = self._stated_by[name]
        stated = ((first, first_manager), (module, manager))
        notes = [
            Note(f"that of module '{one.name}' is here", its.source.at("parameters", name))
            for one, its in stated
            if its.source
        ]
        facts = {"first": first.name, "second": module.name, "parameter": name}
        self._sink.report(MODULES_DISAGREE.at(module.entry, notes=notes, **facts))
