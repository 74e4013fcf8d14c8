"""Transmissions: how actuators move joints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from operator import attrgetter
from typing import Annotated, ClassVar, Self

from linkforge_compile.core.constants import EPSILON, HW_IF_POSITION
from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import (
    BEYOND_EPSILON,
    Children,
    Name,
    Number,
    Parameters,
    Reference,
    Text,
    require_finite,
)
from linkforge_compile.core.naming import require_name, require_unique_names, require_valid_characters
from linkforge_compile.core.part import Element, FreePart, FrozenMap, Stating, extras_last
from linkforge_compile.units import POSITION


class TransmissionType(StrEnum):
    """The transmissions that ros2_control brings along; other plugins are named by plain text."""

    SIMPLE = "transmission_interface/SimpleTransmission"
    DIFFERENTIAL = "transmission_interface/DifferentialTransmission"
    FOUR_BAR_LINKAGE = "transmission_interface/FourBarLinkageTransmission"
    CUSTOM = "custom"


JOINTS_AND_ACTUATORS: dict[str, int] = {
    TransmissionType.SIMPLE: 1,
    TransmissionType.DIFFERENTIAL: 2,
    TransmissionType.FOUR_BAR_LINKAGE: 2,
}
"""The number of joints, and of actuators, by type."""


@extras_last
@dataclass(frozen=True)
class _TransmissionEnd(Element, Stating):
    """What a joint and an actuator of a transmission have in common."""

    name: Annotated[str, Name()]
    hardware_interfaces: Annotated[Sequence[str], Text(xml="hardwareInterface/text()")] = (HW_IF_POSITION,)
    mechanical_reduction: Annotated[float | None, Number(bound=BEYOND_EPSILON, xml="mechanicalReduction/text()")] = 1.0
    offset: Annotated[float, Number(POSITION, xml="offset/text()")] = 0.0
    stated: Sequence[str] = field(default=(), kw_only=True, repr=False)
    """The field `offset` where it is 0 and written nevertheless."""
    interfaces_stated: bool = field(default=True, kw_only=True, repr=False)
    """Whether the interfaces become tags: many files state none, and ros2_control asks for none."""

    what: ClassVar[str]
    name_target: ClassVar[str]

    def _check(self) -> None:
        require_name(self.name, f"{self.what} name", self.name_target)
        if not self.hardware_interfaces:
            raise RobotValidationError.empty(
                f"{self.what} '{self.name}' must have at least one interface",
                "HardwareInterfaces",
                self.name,
                "hardware_interfaces",
            )
        if self.mechanical_reduction is not None and abs(self.mechanical_reduction) < EPSILON:
            raise RobotValidationError.invalid(
                f"mechanical_reduction of {self.what} '{self.name}' cannot be 0",
                "MechanicalReduction",
                self.mechanical_reduction,
                "mechanical_reduction",
            )
        require_finite(self, "mechanical_reduction", "offset")

    def normalized(self) -> Self:
        """Return it with its interfaces sorted."""
        return self.with_fields(hardware_interfaces=tuple(sorted(self.hardware_interfaces)))


class TransmissionJoint(_TransmissionEnd):
    """A joint that a transmission moves: `<joint name>`.

    `mechanical_reduction` is actuator over joint, negative to turn the other way, None if not written. `offset` is
    added to the joint's position [rad], or [m] if it is prismatic.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name, VALUE_EMPTY without interfaces, INVALID_VALUE for a
            reduction of 0.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "joint"
    name: Annotated[str, Reference("joint", key="")]
    what = "transmission joint"
    name_target = "JointName"


class TransmissionActuator(_TransmissionEnd):
    """An actuator that drives a transmission: `<actuator name>`; otherwise as TransmissionJoint."""

    TAG = "actuator"
    what = "transmission actuator"
    name_target = "ActuatorName"


@extras_last
@dataclass(frozen=True)
class Transmission(Element):
    """Joints and the actuators that move them: `<transmission name>`.

    `type` is a TransmissionType or the name of another plugin, `parameters` further child elements by tag:
    their texts, or what is in them.

    Raises:
        RobotValidationError: NAME_EMPTY or INVALID_NAME for the name; VALUE_EMPTY without type, joint or actuator;
            INVALID_VALUE where the type wants another number of them; DUPLICATE_NAME for two joints or two
            actuators of one name.

    """

    TAG = "transmission"

    name: Annotated[str, Name()]
    type: Annotated[str, Text(xml="type/text()", example="transmission_interface/SimpleTransmission")]
    joints: Annotated[Sequence[TransmissionJoint], Children()] = ()
    actuators: Annotated[Sequence[TransmissionActuator], Children()] = ()
    parameters: Annotated[Mapping[str, FreePart], Parameters(xml="*")] = FrozenMap()

    def _check(self) -> None:
        require_name(self.name, "transmission name", "TransmissionName")
        if not self.type:
            raise RobotValidationError.empty("transmission type cannot be empty", "TransmissionType", self.type, "type")
        require_valid_characters(self.name, "transmission name", "TransmissionName")
        if not self.joints:
            raise RobotValidationError.empty(
                "transmission must have at least one joint", "TransmissionJoints", self.name, "joints"
            )
        if not self.actuators:
            raise RobotValidationError.empty(
                "transmission must have at least one actuator", "TransmissionActuators", self.name, "actuators"
            )
        self._check_count()
        require_unique_names(self.joints, f"transmission '{self.name}'", "DuplicateJoints", "joints")
        require_unique_names(self.actuators, f"transmission '{self.name}'", "DuplicateActuators", "actuators")

    def _check_count(self) -> None:
        count = JOINTS_AND_ACTUATORS.get(self.type)
        if count and (len(self.joints), len(self.actuators)) != (count, count):
            raise RobotValidationError.invalid(
                f"{self.type} must have exactly {count} joint{'s' * (count > 1)} and {count} "
                f"actuator{'s' * (count > 1)}, found {len(self.joints)} and {len(self.actuators)}",
                "TransmissionComponents",
                None,
                "actuators" if len(self.joints) == count else "joints",
            )

    def normalized(self) -> Self:
        """Return it with joints and actuators sorted by name, and their interfaces sorted."""
        return self.with_fields(
            joints=tuple(joint.normalized() for joint in sorted(self.joints, key=attrgetter("name"))),
            actuators=tuple(actuator.normalized() for actuator in sorted(self.actuators, key=attrgetter("name"))),
        )

    @classmethod
    def create_simple(
        cls,
        name: str,
        joint_name: str,
        actuator_name: str | None = None,
        mechanical_reduction: float = 1.0,
        hardware_interfaces: Sequence[str] | None = None,
    ) -> Self:
        """Return a transmission of one joint, which takes the reduction, and one actuator, which has 1.

        The actuator is called `JOINT_motor` unless named; both have the interfaces given, `position` for None.
        """
        return cls._create(
            name, TransmissionType.SIMPLE, ((joint_name, actuator_name),), mechanical_reduction, hardware_interfaces
        )

    @classmethod
    def create_differential(  # noqa: PLR0917 - the order is that of LinkForge
        cls,
        name: str,
        joint1_name: str,
        joint2_name: str,
        actuator1_name: str | None = None,
        actuator2_name: str | None = None,
        mechanical_reduction: float = 1.0,
        hardware_interfaces: Sequence[str] | None = None,
    ) -> Self:
        """Return a transmission of two joints, which take the reduction, and two actuators, which have 1.

        An actuator is called `JOINT_motor` unless named; all have the interfaces given, `position` for None.
        """
        pairs = ((joint1_name, actuator1_name), (joint2_name, actuator2_name))
        return cls._create(name, TransmissionType.DIFFERENTIAL, pairs, mechanical_reduction, hardware_interfaces)

    @classmethod
    def _create(
        cls,
        name: str,
        kind: TransmissionType,
        pairs: Sequence[tuple[str, str | None]],
        reduction: float,
        hardware_interfaces: Sequence[str] | None,
    ) -> Self:
        interfaces = tuple(hardware_interfaces or (HW_IF_POSITION,))
        return cls(
            name,
            kind.value,
            tuple(TransmissionJoint(joint, interfaces, reduction) for joint, _ in pairs),
            tuple(
                TransmissionActuator(f"{joint}_motor" if actuator is None else actuator, interfaces)
                for joint, actuator in pairs
            ),
        )
