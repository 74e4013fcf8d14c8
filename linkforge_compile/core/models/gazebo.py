"""Gazebo: settings of the simulator for a link, a joint or the robot, and its plugins."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Self

from linkforge_compile.core.exceptions import FieldPath, RobotValidationError
from linkforge_compile.core.fields import (
    NOT_NEGATIVE,
    ZERO_TO_ONE,
    Children,
    Flag,
    Name,
    Number,
    Parameters,
    Reference,
    Text,
    require_finite,
    tags_with_text,
)
from linkforge_compile.core.naming import require_not_blank
from linkforge_compile.core.part import Element, FreePart, FrozenMap, extras_last


@extras_last
@dataclass(frozen=True)
class GazeboPlugin(Element):
    """A plugin of a simulator: `<plugin name filename>`.

    `filename` is the library, `parameters` its child elements by tag: their texts, or what is in them. `raw_xml` is
    its whole content as XML where that was read, and is written in place of the parameters; None if there is none.
    It is not compared.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank name, VALUE_EMPTY for a blank filename.

    """

    TAG = "plugin"

    name: Annotated[str, Name(example="controller")]
    filename: Annotated[str, Text(example="libcontroller.so")]
    parameters: Annotated[Mapping[str, FreePart], Parameters(xml="*")] = FrozenMap()
    raw_xml: str | None = field(default=None, compare=False)

    def with_prefix(self, prefix: str) -> Self:
        """Return the plugin with the prefix before its name, unless that is a class of Gazebo Sim's.

        A plugin of Gazebo Classic has any name; Gazebo Sim loads the class of that name, `gz::sim::systems::Imu`.
        """
        return self if "::" in self.name else Element.with_prefix(self, prefix)

    def _check(self) -> None:
        require_not_blank(self.name, "plugin name", "PluginName")
        if not self.filename.strip():
            raise RobotValidationError.empty(
                f"filename of plugin '{self.name}' cannot be empty or blank", "PluginFilename", None, "filename"
            )


@extras_last
@dataclass(frozen=True)
class GazeboElement(Element):
    """Settings of a simulator: `<gazebo reference>`.

    `reference` names a link or joint, None the robot as a whole. `properties` are child elements by tag: their
    texts, or what is in them. `material` and `static` belong to links, the rest to joints: `stop_cfm` (constraint
    force mixing at the joint's stops, 0 or above) and `stop_erp` (share of the error that a step corrects, 0 to 1).
    None for what is not written.

    Raises:
        RobotValidationError: NAME_EMPTY for a blank reference, INVALID_VALUE for stop_cfm or stop_erp out of range.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "gazebo"

    reference: Annotated[str | None, Reference("part")] = None
    properties: Annotated[Mapping[str, FreePart], Parameters(xml="*")] = FrozenMap()
    plugins: Annotated[Sequence[GazeboPlugin], Children()] = ()
    material: Annotated[str | None, Text(xml="material/text()")] = None
    static: Annotated[bool | None, Flag(xml="static/text()")] = None
    stop_cfm: Annotated[float | None, Number(bound=NOT_NEGATIVE, xml="stopCfm/text()")] = None
    stop_erp: Annotated[float | None, Number(bound=ZERO_TO_ONE, xml="stopErp/text()")] = None
    provide_feedback: Annotated[bool | None, Flag(xml="provideFeedback/text()")] = None
    implicit_spring_damper: Annotated[bool | None, Flag(xml="implicitSpringDamper/text()")] = None

    def _check(self) -> None:
        if self.reference is not None:
            require_not_blank(self.reference, "gazebo reference", "GazeboReference", ("reference",))
        if self.stop_cfm is not None and self.stop_cfm < 0:
            raise RobotValidationError.invalid(
                f"stop_cfm must be >= 0, found {self.stop_cfm}", "GazeboStopCFM", str(self.stop_cfm), "stop_cfm"
            )
        if self.stop_erp is not None and not 0 <= self.stop_erp <= 1:
            raise RobotValidationError.invalid(
                f"stop_erp must be in [0.0, 1.0], found {self.stop_erp}",
                "GazeboStopERP",
                str(self.stop_erp),
                "stop_erp",
            )
        require_finite(self, "stop_cfm")


ELEMENT_TAGS = tags_with_text(GazeboElement)
"""The tags of the fields of GazeboElement that become tags, in the order in which they are written."""

KEEP_FIXED_JOINT = ("preserveFixedJoint", "disableFixedJointLumping")
"""The tags by which a block about a fixed joint keeps Gazebo from merging the links on its two sides into one."""


def property_path(block: GazeboElement, tag: str) -> FieldPath:
    """Return where a block has a property: one that is a key of the language is in the block itself."""
    is_key = block.source is not None and block.source.node.child(tag) is not None
    return (tag,) if is_key else ("properties", tag)


BLOCK_THAT_KEEPS_JOINT = "gazebo: {preserveFixedJoint: true}"
"""What a fixed joint has in a spec so that Gazebo keeps it."""


def keeps_fixed_joint(blocks: Iterable[GazeboElement]) -> bool:
    """Whether a block about a fixed joint keeps it: Gazebo reads the attribute `value`, else the text."""
    return any(_says_yes(block.properties.get(tag, "")) for block in blocks for tag in KEEP_FIXED_JOINT)


def _says_yes(tag: FreePart) -> bool:
    if isinstance(tag, Mapping):
        tag = tag.get("_value", tag.get("_text", ""))
    return isinstance(tag, str) and tag.strip().lower() in ("true", "yes", "1")


def content_key(element: GazeboElement) -> tuple[str, str]:
    """Return what sorts Gazebo elements by reference, then by content: several may be about one part."""
    content: dict[str, object] = {
        **{name: getattr(element, name) for name in element.__match_args__ if name not in {"reference", "plugins"}},
        "plugins": [(plugin.name, plugin.filename, _sorted(plugin.parameters)) for plugin in element.plugins],
        "extras": (element.extra_attributes, element.extra_elements, element.extra_inside),
    }
    return element.reference or "", repr(_sorted(content))


def _sorted(value: object) -> object:
    """Return a value with the items of every mapping in it sorted, as equality ignores their order."""
    if isinstance(value, Mapping):
        return sorted((name, _sorted(item)) for name, item in value.items())
    return [_sorted(item) for item in value] if isinstance(value, tuple | list) else value
