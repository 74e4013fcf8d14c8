"""Controllers of ros2_control: what a controller manager loads, and the joints and sensors that each is for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple, Self

from linkforge_compile.core.fields import Data, Name, Reference, Text
from linkforge_compile.core.naming import require_not_blank
from linkforge_compile.core.part import Element, FrozenMap, SourcedText, extras_last

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


MANAGER = "controller_manager"
"""The name of the entry with the parameters of the manager itself, which has no type."""

DEFAULT_BROADCASTER, DEFAULT_TRAJECTORY = "joint_state_broadcaster", "joint_trajectory_controller"
"""The names of the controllers that a robot without any has, apart from those of its planning groups."""


def default_name(group: str) -> str:
    """Return the name of the controller of a planning group that a robot without controllers has."""
    return f"{group}_controller"


JOINT_FIELDS = ("joints", "left_wheels", "right_wheels")
"""The fields of a controller with names of joints."""


@extras_last
@dataclass(frozen=True)
class Controller(Element):
    """A controller that a controller manager loads, by its class `type`; it is in no URDF.

    `joints` are those that it commands or reads, for a `group` without them the joints of the group. `left_wheels` and
    `right_wheels` are those of a differential drive. `sensor` is a sensor of ros2_control, whose values are in `frame`.
    `parameters` are all others: numbers, booleans, texts, and lists and maps of them. `type` is None for the
    controller manager alone, whose name gets no prefix; the names of hardware and controllers in its parameters do.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name.

    """

    TAG = "controller"

    name: Annotated[str, Name()]
    type: Annotated[str | None, Text()] = None
    group: Annotated[str | None, Reference("group")] = None
    joints: Annotated[Sequence[str], Reference("joint")] = ()
    left_wheels: Annotated[Sequence[str], Reference("joint")] = ()
    right_wheels: Annotated[Sequence[str], Reference("joint")] = ()
    sensor: Annotated[str | None, Reference("sensor")] = None
    frame: Annotated[str | None, Reference("link")] = None
    command_interfaces: Annotated[Sequence[str], Text()] = ()
    state_interfaces: Annotated[Sequence[str], Text()] = ()
    parameters: Annotated[Mapping[str, Any], Data()] = FrozenMap()  # Any: what YAML has

    def _check(self) -> None:
        require_not_blank(self.name, "controller name", "ControllerName")

    def with_prefix(self, prefix: str) -> Self:
        if self.name == MANAGER:
            parameters = with_prefixed_names(self.parameters, prefix)
            return self if parameters == self.parameters else self.with_fields(parameters=parameters)
        return super().with_prefix(prefix)
