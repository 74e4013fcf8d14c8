"""Controllers of ros2_control: what a controller manager loads, and the joints and sensors that each is for."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Self

from linkforge_compile.core.fields import Data, Name, Reference, Text
from linkforge_compile.core.models.manager_parameters import with_prefixed_names
from linkforge_compile.core.naming import require_not_blank
from linkforge_compile.core.part import Element, FrozenMap, extras_last

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
