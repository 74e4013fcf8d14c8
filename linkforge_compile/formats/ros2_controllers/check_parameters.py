"""Parameters of controllers that their class does not have, or that ROS 2 does not read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.core.sourced_text import place_of_parameter, place_of_parameter_name
from linkforge_compile.diagnostics.codes.formats import LIST_OF_SEVERAL_TYPES, UNKNOWN_PARAMETER, WRONG_PARAMETER
from linkforge_compile.formats.ros2_controllers.parameters import PARAMETERS, find_misfits
from linkforge_compile.formats.ros2_controllers.view import typed_parameters

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import Controller
    from linkforge_compile.diagnostics import Diagnostic


def check_parameters(controller: Controller, declared_by: str, named: Iterable[str]) -> Iterator[Diagnostic]:
    """Report the parameters that a class does not declare, or declares with another type."""
    owner = "the controller manager" if declared_by == MANAGER else f"a {declared_by}"
    declared = PARAMETERS.get(declared_by)
    misfits = find_misfits(controller.parameters, declared, named) if declared is not None else ()
    for path, expected, value, near in misfits:
        if isinstance(value, list | tuple) and not _has_one_type(value):
            continue  # an error by itself
        *outer, name = path
        if expected is None:
            inside = f" in '{'.'.join(outer)}'" if outer else ""
            place = place_of_parameter_name(controller.source, "parameters", *path)
            yield UNKNOWN_PARAMETER.at(*place, name=name, owner=owner, inside=inside, near=near)
        else:
            name, found = ".".join(path), _shown(value)
            place = place_of_parameter(controller.source, "parameters", *path)
            yield WRONG_PARAMETER.at(*place, name=name, owner=owner, expected=expected, found=found)


def _shown(value: object) -> str:
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value) if isinstance(value, int | float) else "a map" if isinstance(value, Mapping) else "a list"


def check_lists(controller: Controller) -> Iterator[Diagnostic]:
    """A list has items of one type, and no lists or maps: the parser of rcl refuses the whole file."""
    for path, value in _values(typed_parameters(controller), ()):
        if isinstance(value, list) and not _has_one_type(value):
            place, name = place_of_parameter(controller.source, "parameters", *path), ".".join(path)
            yield LIST_OF_SEVERAL_TYPES.at(*place, controller=controller.name, parameter=name)


def _has_one_type(items: Sequence[object]) -> bool:
    """Whether a list is one that ROS 2 has a type for."""
    integers = all(isinstance(item, int) and not isinstance(item, bool) for item in items)
    return integers or any(all(isinstance(item, type_) for item in items) for type_ in (str, bool, float))


def _values(parameters: Mapping[str, object], path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], object]]:
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            yield from _values(value, (*path, name))
        else:
            yield (*path, name), value
