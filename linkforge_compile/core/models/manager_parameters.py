"""Parameters of a controller manager: the names in them of hardware and controllers, which take the prefix."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.part import FrozenMap
from linkforge_compile.core.sourced_text import SourcedText

HARDWARE, CONTROLLER = "ros2_control system", "controller"
"""What a name in the parameters is that of."""

_INITIAL_STATE = "hardware_components_initial_state"
_STATES = ("unconfigured", "inactive")
_OF_CONTROLLER = frozenset(("type", "params_file", "fallback_controllers", "node_options_args"))
"""What the manager has of each controller, under its name."""


class ListedName(NamedTuple):
    """A name in a list of the parameters, and what it is that of."""

    kind: str
    name: str


def kind_of_names(path: tuple[str, ...]) -> str | None:
    """Return what the names in the list at a path are those of, HARDWARE or CONTROLLER; None for all other paths."""
    match path:
        case (outer, inner) if outer == _INITIAL_STATE and inner in _STATES:
            return HARDWARE
        case (_, "fallback_controllers"):
            return CONTROLLER
    return None


def is_of_controller(value: object) -> bool:
    """Whether a parameter is what the manager has of a controller, under its name."""
    return isinstance(value, Mapping) and not _OF_CONTROLLER.isdisjoint(value)


def listed_names(parameters: Mapping[str, object], path: tuple[str, ...] = ()) -> Iterator[ListedName]:
    """Yield the names in the lists of the parameters."""
    for key, value in parameters.items():
        inner = (*path, key)
        if kind := kind_of_names(inner):
            names = value if isinstance(value, list | tuple) else (value,)
            yield from (ListedName(kind, name) for name in names if isinstance(name, str))
        elif isinstance(value, Mapping):
            yield from listed_names(value, inner)


def with_prefixed_names(parameters: Mapping[str, object], prefix: str) -> Mapping[str, object]:
    """Return the parameters with a prefix before the names of hardware and controllers."""
    return FrozenMap(
        {
            _prefixed(key, prefix) if is_of_controller(value) else key: _with_prefix(value, (key,), prefix)
            for key, value in parameters.items()
        }
    )


def _with_prefix(value: object, path: tuple[str, ...], prefix: str) -> object:
    if isinstance(value, Mapping):
        return FrozenMap({key: _with_prefix(item, (*path, key), prefix) for key, item in value.items()})
    if kind_of_names(path) is None:
        return value
    if isinstance(value, list | tuple):
        return tuple(_prefixed(name, prefix) if isinstance(name, str) else name for name in value)
    return _prefixed(value, prefix) if isinstance(value, str) else value


def _prefixed(name: str, prefix: str) -> str:
    return SourcedText(prefix + name, name.source) if isinstance(name, SourcedText) else prefix + name


def loaded_class(parameters: Mapping[str, object], controller: str) -> object:
    """Return the class of a controller that the parameters of the manager state; None if they do not."""
    stated = parameters.get(controller)
    return stated.get("type") if isinstance(stated, Mapping) else None
