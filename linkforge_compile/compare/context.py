"""What the comparison of two values depends on: tolerance, measures, and whether an author wrote them as XML."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import NamedTuple

from linkforge_compile.compare.difference import describe, describe_texts, shorten, to_json
from linkforge_compile.compare.fields import BARE, Measure, measure_of, position_measure
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import Material
from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.core.models.srdf import GroupState

TOLERANCE = 1e-6
"""Default tolerance: in metres and radians for poses, relative for other numbers."""

_DIGITS = (6, 9, 13, 17)
"""Significant digits to try until two numbers look different."""

_MAX_STATE = 200
"""Characters shown of a group state that was added or removed."""

_XML_FIELDS = frozenset({"parameters", "properties", "extra_attributes", "extra_elements"})
"""Fields whose texts an author wrote as XML."""

_WITH_PLUGIN_PARAMETERS = (GazeboPlugin, Ros2Control, Ros2ControlJoint, Ros2ControlGpio, Ros2ControlSensor)
"""Parts whose `parameters` a plugin reads as text: to a driver, firmware 1.10 is not 1.1."""


class CompareContext(NamedTuple):
    """What the comparison of a value depends on.

    Each pair is for the robot before and the robot after: `prismatic_joints` their names, `slides` whether the value
    is about one of them, `measures` what the value measures, `palettes` the materials that the robots declare.
    `in_xml`: the value is in an author's XML, where one number may be spelled in several ways. `as_spelt`: each
    spelling there is a different text.
    """

    tolerance: float = TOLERANCE
    prismatic_joints: tuple[Collection[str], Collection[str]] = ((), ())
    palettes: tuple[Mapping[str, Material], Mapping[str, Material]] = ({}, {})
    slides: tuple[bool, bool] = (False, False)
    measures: tuple[Measure, Measure] = (BARE, BARE)
    in_xml: bool = False
    as_spelt: bool = False

    def describe(self, before: object, after: object) -> tuple[str, str]:
        """Return two different values in a few words each, with enough digits to show the difference."""
        if type(before) is str and type(after) is str:
            return describe_texts(before, after)
        if isinstance(before or after, GroupState):
            prismatic_before, prismatic_after = self.prismatic_joints
            return _describe_state(before, prismatic_before), _describe_state(after, prismatic_after)
        both = tuple(zip((before, after), self.measures, self.slides, strict=True))
        for digits in _DIGITS:
            one, other = (describe(value, measure, slides=slides, digits=digits) for value, measure, slides in both)
            if one != other:
                return one, other
        return to_json(before), to_json(after)

    def for_joint(self, name: str) -> CompareContext:
        """Return the context of values about a joint."""
        before, after = (name in joints for joints in self.prismatic_joints)
        return self._replace(slides=(before, after))

    def for_section(self, field: str) -> CompareContext:
        """Return the context of a field whose numbers have no unit."""
        return self._replace(in_xml=True) if field in _XML_FIELDS else self

    def for_field(self, part: object, field: str) -> CompareContext:
        """Return the context of a field of a part."""
        before, after = (measure_of(type(part), field, slides=slides) for slides in self.slides)
        as_spelt = self.as_spelt or (field == "parameters" and isinstance(part, _WITH_PLUGIN_PARAMETERS))
        return self.for_section(field)._replace(measures=(before, after), as_spelt=as_spelt)

    def for_tag(self, tag: str) -> CompareContext:
        """Return the context of the content of an element in an author's XML."""
        return self._replace(as_spelt=True) if tag == "plugin" else self


def _describe_state(state: object, prismatic: Collection[str]) -> str:
    if not isinstance(state, GroupState):
        return describe(state)
    positions = (
        f"{joint} {describe(values, position_measure(slides=joint in prismatic))}"
        for joint, values in state.joint_values.items()
    )
    return shorten(", ".join(positions), _MAX_STATE) or describe(state)
