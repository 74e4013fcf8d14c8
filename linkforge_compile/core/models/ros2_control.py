"""ros2_control: hardware with its joints, sensors, gpios and their interfaces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import partial
from operator import attrgetter
from typing import Annotated, ClassVar, NoReturn, Self

from linkforge_compile.core.constants import CONTROL_TYPE_ACTUATOR, CONTROL_TYPE_SENSOR, CONTROL_TYPE_SYSTEM
from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import Children, Choice, Name, Parameters, Reference, Text, require_choice
from linkforge_compile.core.naming import require_name, require_unique_names
from linkforge_compile.core.part import Element, FrozenMap, Inside, attribute_pairs, dump_like, extras_last
from linkforge_compile.source import SourceRef


class Interface(str):
    """An interface's name, such as `position`: `<command_interface name>`, `<state_interface name>`.

    It sorts, hashes and prints as that name, and equals it; two interfaces are equal if their parameters and extras
    are, too. `parameters` are texts by name (`min`, `max`, `initial_value`): `<param name>`.
    `source` is where it was written, None if it was not read.
    """

    __slots__ = ("extra_attributes", "extra_elements", "extra_inside", "parameters", "source")

    parameters: Mapping[str, str]
    source: SourceRef | None
    extra_attributes: tuple[tuple[str, str], ...]
    extra_elements: tuple[str, ...]
    extra_inside: tuple[Inside, ...]

    def __new__(
        cls,
        name: str,
        parameters: Mapping[str, str] = FrozenMap(),
        *,
        source: SourceRef | None = None,
        extra_attributes: Sequence[tuple[str, str]] = (),
        extra_elements: Sequence[str] = (),
        extra_inside: Sequence[Inside] = (),
    ) -> Self:
        interface = super().__new__(cls, name)
        facts = {
            "parameters": FrozenMap(parameters),
            "source": source,
            "extra_attributes": attribute_pairs(extra_attributes),
            "extra_elements": tuple(extra_elements),
            "extra_inside": tuple(extra_inside),
        }
        for fact, value in facts.items():
            object.__setattr__(interface, fact, value)
        return interface

    @classmethod
    def of(cls, name: str) -> "Interface":
        """Return the interface itself, or one without parameters for a bare name."""
        return name if isinstance(name, Interface) else cls(name)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Interface):
            return str.__eq__(self, other) and self._facts == other._facts
        return str.__eq__(self, other) if isinstance(other, str) else NotImplemented

    def __ne__(self, other: object) -> bool:
        # str defines `__ne__` itself and does not call `__eq__`.
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else not equal

    __hash__ = str.__hash__

    @property
    def _facts(self) -> tuple[object, ...]:
        return tuple(getattr(self, fact) for fact in _FACTS)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"an Interface cannot be changed: {name}")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"an Interface cannot be changed: {name}")

    def __reduce__(self) -> tuple[object, ...]:
        facts = {name: getattr(self, name) for name in ("source", *_FACTS)}
        return partial(type(self), **facts), (str(self),)


dump_like(Interface, str)

_FACTS = ("parameters", "extra_attributes", "extra_elements", "extra_inside")


_COMMANDS = Children(kinds=(Interface,), xml="command_interface")
_STATES = Children(kinds=(Interface,), xml="state_interface")


class Ros2ControlType(StrEnum):
    """What a piece of hardware is: a system of joints and sensors, one actuator, or sensors alone."""

    SYSTEM = CONTROL_TYPE_SYSTEM
    ACTUATOR = CONTROL_TYPE_ACTUATOR
    SENSOR = CONTROL_TYPE_SENSOR


@extras_last
@dataclass(frozen=True)
class _CommandedComponent(Element):
    """What joints and gpios have in common: they may be commanded as well as read."""

    name: Annotated[str, Name()]
    command_interfaces: Annotated[Sequence[str], _COMMANDS] = ()
    state_interfaces: Annotated[Sequence[str], _STATES] = ()
    parameters: Annotated[Mapping[str, str], Parameters(xml="param")] = FrozenMap()

    what: ClassVar[str]
    name_target: ClassVar[str]

    def _check(self) -> None:
        require_name(self.name, f"{self.what} name", self.name_target)

    def normalized(self) -> Self:
        """Return it with its interfaces sorted."""
        return self.with_fields(
            command_interfaces=tuple(sorted(self.command_interfaces)),
            state_interfaces=tuple(sorted(self.state_interfaces)),
        )


class Ros2ControlJoint(_CommandedComponent):
    """A joint that hardware moves or reads: `<joint name>` in `<ros2_control>`.

    Interfaces are names, or Interface where they have parameters; `parameters` are texts by name: `<param name>`.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name, VALUE_EMPTY without any interface.

    """

    TAG = "joint"
    name: Annotated[str, Reference("joint", key="")]
    what = "ros2_control joint"
    name_target = "JointName"

    def _check(self) -> None:
        super()._check()
        if not self.command_interfaces and not self.state_interfaces:
            raise RobotValidationError.empty(
                f"ros2_control joint '{self.name}' must have at least one command or state interface",
                "Ros2ControlInterfaces",
                self.name,
            )


class Ros2ControlGpio(_CommandedComponent):
    """Pins that hardware switches or reads: `<gpio name>` in `<ros2_control>`; fields as of a joint.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name.

    """

    TAG = "gpio"
    what = "ros2_control gpio"
    name_target = "GpioName"


@extras_last
@dataclass(frozen=True)
class Ros2ControlSensor(Element):
    """A sensor that hardware reads: `<sensor name>` in `<ros2_control>`; fields as of a joint.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name.

    """

    TAG = "sensor"

    name: Annotated[str, Name()]
    state_interfaces: Annotated[Sequence[str], _STATES] = ()
    parameters: Annotated[Mapping[str, str], Parameters(xml="param")] = FrozenMap()

    def _check(self) -> None:
        require_name(self.name, "ros2_control sensor name", "SensorName")

    def normalized(self) -> Self:
        """Return it with its interfaces sorted."""
        return self.with_fields(state_interfaces=tuple(sorted(self.state_interfaces)))


@extras_last
@dataclass(frozen=True)
class Ros2Control(Element):
    """One piece of hardware: `<ros2_control name type>`.

    `type` is `system`, `actuator` or `sensor`; `hardware_plugin` the class that talks to it, `<plugin>` in
    `<hardware>`, with the `parameters`. `extra_elements` are children of `<ros2_control>` itself.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name; INVALID_VALUE for another type, a command interface in a
            sensor, or an actuator without exactly one joint; VALUE_EMPTY without plugin; DUPLICATE_NAME for two
            joints, two sensors or two gpios of one name.

    """

    TAG = "ros2_control"

    name: Annotated[str, Name()]
    type: Annotated[str, Choice(Ros2ControlType, is_required_in_urdf=True)] = CONTROL_TYPE_SYSTEM
    hardware_plugin: Annotated[str, Text(xml="hardware/plugin/text()", example="mock_components/GenericSystem")] = ""
    joints: Annotated[Sequence[Ros2ControlJoint], Children()] = ()
    sensors: Annotated[Sequence[Ros2ControlSensor], Children()] = ()
    parameters: Annotated[Mapping[str, str], Parameters(xml="hardware/param")] = FrozenMap()
    gpios: Annotated[Sequence[Ros2ControlGpio], Children()] = field(default=(), kw_only=True)

    def _check(self) -> None:
        require_name(self.name, "ros2_control name", "Ros2ControlName")
        require_choice(self.type, Ros2ControlType, "ros2_control type", "Ros2ControlType", "type")
        if not self.hardware_plugin:
            raise RobotValidationError.empty(
                "hardware_plugin cannot be empty", "HardwarePlugin", self.hardware_plugin, "hardware_plugin"
            )
        owner = f"ros2_control '{self.name}'"
        require_unique_names(self.joints, owner, "Ros2ControlJoints", "joints")
        require_unique_names(self.sensors, owner, "Ros2ControlSensors", "sensors")
        require_unique_names(self.gpios, owner, "Ros2ControlGpios", "gpios")
        self._check_joints_of_type()

    def _check_joints_of_type(self) -> None:
        if self.type == CONTROL_TYPE_SENSOR:
            for joint in self.joints:
                if joint.command_interfaces:
                    raise RobotValidationError.invalid(
                        f"a ros2_control sensor cannot have command interfaces, found them in joint '{joint.name}'",
                        "Ros2ControlMode",
                        self.type,
                        "joints",
                        joint.name,
                        "command_interfaces",
                    )
        if self.type == CONTROL_TYPE_ACTUATOR and len(self.joints) != 1:
            raise RobotValidationError.invalid(
                f"a ros2_control actuator must have exactly one joint, found {len(self.joints)}",
                "Ros2ControlJoints",
                len(self.joints),
                "joints",
            )

    def normalized(self) -> Self:
        """Return it with joints, sensors and gpios sorted by name, and their interfaces sorted."""
        by_name = attrgetter("name")
        return self.with_fields(
            joints=tuple(joint.normalized() for joint in sorted(self.joints, key=by_name)),
            sensors=tuple(sensor.normalized() for sensor in sorted(self.sensors, key=by_name)),
            gpios=tuple(gpio.normalized() for gpio in sorted(self.gpios, key=by_name)),
        )
