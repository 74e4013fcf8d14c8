"""Names and values of controllers that ROS 2 refuses, and those of which only one could be written."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.core.models.controller_kinds import kind_of, path_of_field, stated_field
from linkforge_compile.core.sourced_text import place_of_parameter
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.formats import (
    NO_NAME_OF_A_NODE,
    ONE_OF_SEVERAL,
    STATED_TWICE,
)
from linkforge_compile.formats.ros2_controllers.check_parameters import check_lists
from linkforge_compile.formats.ros2_controllers.complete import has_faulty_names
from linkforge_compile.source import Key

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
"""The names of nodes that rmw accepts."""


def check_refused(robot: Robot, completed: Iterable[Controller]) -> Iterator[Diagnostic]:
    """ROS 2 reads the names and parameters of all controllers, which are written as the spec states them."""
    for controller in robot.controllers:
        yield from check_lists(controller)
        if controller.name != MANAGER:
            yield from _check_stated_once(controller)
    manager = robot.controllers.get(MANAGER)
    for controller in completed:
        yield from _check_name(controller)
        if manager:
            yield from _check_names_of_values(manager, controller)
            yield from _check_loaded_class(manager, controller)
        if not has_faulty_names(robot, controller):
            yield from _check_single_fields(controller)


def _check_name(controller: Controller) -> Iterator[Diagnostic]:
    """The name of a controller is that of its node."""
    if not _NODE.fullmatch(controller.name):
        yield NO_NAME_OF_A_NODE.at(controller.source, controller=controller.name)


def _check_single_fields(controller: Controller) -> Iterator[Diagnostic]:
    """A field of which a class has one name, such as the joint of a gripper, has no others."""
    for field in sorted(kind_of(controller.type).single):
        first, *others = getattr(controller, field) or ("",)
        for place, item in enumerate(others, start=1):
            if item == first:
                continue  # LF4160
            facts = {"type": controller.type, "field": field, "item": item, "controller": controller.name}
            yield ONE_OF_SEVERAL.at(controller.source, *path_of_field(controller, field), place, **facts)


def _check_stated_once(controller: Controller) -> Iterator[Diagnostic]:
    """A field is not a parameter as well, of which one would have no effect."""
    for field, name in kind_of(controller.type).parameters.items():
        stated = stated_field(controller, field)
        if stated and name in controller.parameters:
            notes = [Note(f"`{stated}` is here", controller.source.at(stated))] if controller.source else []
            facts = {"controller": controller.name, "parameter": name, "owner": "", "conflict": _and_field(stated)}
            yield STATED_TWICE.at(controller.source, "parameters", Key(name), notes=notes, **facts)


def _and_field(field: str) -> str:
    return f"and `{field}` for the same; remove one of them"


def _check_names_of_values(manager: Controller, controller: Controller) -> Iterator[Diagnostic]:
    """The manager has a map under the name of a controller, and no value, for which there is no place in the file."""
    for key, value in manager.parameters.items():
        if key == controller.name and value is not None and not isinstance(value, Mapping):
            notes = [Note("the controller is here", controller.source.span)] if controller.source else []
            place = place_of_parameter(manager.source, "parameters", key)
            conflict = "which is a value and no map of its parameters; remove it, or rename the controller"
            owner = f" of '{MANAGER}'"
            yield STATED_TWICE.at(*place, notes=notes, controller=key, parameter=key, owner=owner, conflict=conflict)


def _check_loaded_class(manager: Controller, controller: Controller) -> Iterator[Diagnostic]:
    """The class of a controller is not another one in the parameters of the manager."""
    stated = manager.parameters.get(controller.name)
    for key, value in stated.items() if isinstance(stated, Mapping) else ():
        if key == "type" and value != controller.type:
            notes = [Note("`type` is here", controller.source.at("type"))] if controller.source else []
            place = place_of_parameter(manager.source, "parameters", controller.name, key)
            owner, conflict = f" of '{MANAGER}'", _and_field("type")
            yield STATED_TWICE.at(
                *place, notes=notes, controller=controller.name, parameter="type", owner=owner, conflict=conflict
            )
