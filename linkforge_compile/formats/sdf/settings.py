"""Settings of Gazebo for links, joints and the robot: where SDF has what the tags of Gazebo in a URDF are about."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import FieldPath
from linkforge_compile.core.fields import tags_with_text
from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement, property_path
from linkforge_compile.core.models.link import PHYSICS_TAGS
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import FreePart
from linkforge_compile.formats.element import parameter_elements, raw_texts
from linkforge_compile.formats.raw import element_texts, plain_text, well_formed_elements
from linkforge_compile.formats.sdf.elements import parent, text
from linkforge_compile.formats.xml_text import NOTHING, Xml, spelled
from linkforge_compile.source import SourceRef
from linkforge_compile.source.xml_tree import XmlElement


class Setting(NamedTuple):
    """A tag of Gazebo, or an element of SDF, for a part of the robot, and where it was written.

    `raw` is the element of raw XML, of which `value` is the text.
    """

    tag: str
    value: FreePart
    source: SourceRef | None
    path: FieldPath
    raw: XmlElement | None = None

    @property
    def xml(self) -> Xml:
        """The elements of this tag."""
        if self.raw and isinstance(self.value, str):
            return Xml(self.value)
        return parameter_elements({self.tag: self.value}, self.source, *self.path[:-1])

    @property
    def words(self) -> str | None:
        """The text of a tag, or its attribute `value`, which Gazebo reads first; None for several of one tag."""
        value = self.value
        if self.raw:
            value = self.raw.get("value") or self.raw.text
        elif isinstance(value, Mapping):
            value = value.get("_value", value.get("_text", ""))
        return value.strip() if isinstance(value, str) else None

    @property
    def names(self) -> Sequence[str]:
        """The attributes `name` of the elements of this tag."""
        if self.raw:
            return [self.raw.get("name") or ""]
        parts = [self.value] if isinstance(self.value, str | Mapping) else self.value
        return [str(part.get("_name", "")) for part in parts if isinstance(part, Mapping)]


Settings: TypeAlias = Sequence[Setting]


def settings_by_reference(robot: Robot) -> Mapping[str | None, Settings]:
    """Return the settings of links, joints, and under None of the robot itself; of two for one element, the last."""
    found: dict[str | None, dict[str, Setting]] = defaultdict(dict)
    for link in robot.links:
        for name, tag in PHYSICS_TAGS.items():
            if link.physics.is_written(name):
                value = spelled(getattr(link.physics, name))
                _add(Setting(tag, value, link.physics.source, (name,)), found[link.name])
    for block in robot.gazebo_elements:
        for setting in _settings_of(block):
            _add(setting, found[block.reference])
    return {reference: tuple(settings.values()) for reference, settings in found.items()}


def _add(setting: Setting, found: dict[str, Setting]) -> None:
    """Add a setting, in place of another one for the same element of SDF."""
    key = f"{setting.tag} {len(found)}" if setting.tag in _SEVERAL else _SAME_ELEMENT.get(setting.tag, setting.tag)
    found.pop(key, None)
    found[key] = setting


def _settings_of(block: GazeboElement) -> Iterator[Setting]:
    for name, tag in _FIELD_TAGS.items():
        if (value := getattr(block, name)) is not None:
            yield Setting(tag, spelled(value), block.source, (name,))
    for tag, value in block.properties.items():
        yield Setting(tag, value, block.source, property_path(block, tag))
    for raw, source, path in raw_texts(block, block.source):
        for element, xml in element_texts(raw, source, *path):
            yield Setting(element.tag, xml, source, path, element)


_FIELD_TAGS = tags_with_text(GazeboElement)

LINK_ELEMENTS = frozenset(
    ("sensor", "light", "battery", "projector", "audio_source", "audio_sink", "particle_emitter", "velocity_decay")
)
"""Elements of SDF that are copied into a link as they are."""

OF_MODEL = frozenset(
    ("plugin", "gripper", "frame", "joint", "link", "model", "include", "static", "self_collide", "allow_auto_disable")
)

_FLAGS_OF_MODELS = frozenset(("static", "self_collide", "allow_auto_disable"))

_LINK_FLAGS = {
    "gravity": "gravity",
    "selfCollide": "self_collide",
    "self_collide": "self_collide",
    "kinematic": "kinematic",
    "enable_wind": "enable_wind",
    "must_be_base_link": "must_be_base_link",
}
_FRICTION = {"mu1": "mu", "mu2": "mu2", "fdir1": "fdir1"}
_CONTACT = {"kp": "kp", "kd": "kd", "maxVel": "max_vel", "minDepth": "min_depth"}
_COLLISION = {"maxContacts": "max_contacts", "laserRetro": "laser_retro"}
_SPRING = {"springReference": "spring_reference", "springStiffness": "spring_stiffness"}
_JOINT_LIMIT = {"stopCfm": "cfm", "stopErp": "erp"}
_JOINT_ODE = {
    "implicitSpringDamper": "implicit_spring_damper",
    "cfmDamping": "implicit_spring_damper",
    "fudgeFactor": "fudge_factor",
}

_OF_SHAPES = ("visual", "collision")
"""Tags whose children are added to each shape of a link."""

_SEVERAL = LINK_ELEMENTS | OF_MODEL - _FLAGS_OF_MODELS
"""Tags of which a part may have several."""

_SAME_ELEMENT = {"turnGravityOff": "gravity", "selfCollide": "self_collide", "cfmDamping": "implicitSpringDamper"}
"""Tags that are about the element of another tag."""

OF_FRAME = frozenset(("sensor", *_FRICTION, *_CONTACT, *_COLLISION, *_OF_SHAPES))
OF_BODY = OF_FRAME | LINK_ELEMENTS | _LINK_FLAGS.keys() | {"turnGravityOff", "dampingFactor"}
OF_FIXED_JOINT = frozenset((*_JOINT_LIMIT, *_JOINT_ODE, "provideFeedback", "sensor", *KEEP_FIXED_JOINT))
OF_JOINT = OF_FIXED_JOINT | _SPRING.keys()
"""The tags that each kind of part holds in SDF."""


def model_elements(settings: Settings) -> Xml:
    """Return the settings of the robot itself."""
    return _elements_with(OF_MODEL, settings)


def nested_model_elements(settings: Settings) -> Xml:
    """Return the settings of the robot that hold for each of its models."""
    return _elements_with(_FLAGS_OF_MODELS, settings)


def link_elements(settings: Settings) -> Xml:
    """Return the settings of a link that are elements of the link itself, but for sensors."""
    by_tag = _by_tag(settings)
    flags = [_tag_for(tag, by_tag.get(name)) for name, tag in _LINK_FLAGS.items()]
    if off := by_tag.get("turnGravityOff"):
        is_on = (off.words or "").lower() in ("false", "no", "0")
        flags.append(text("gravity", is_on, off.source, *off.path))
    damping = by_tag.get("dampingFactor")
    decay = parent("velocity_decay", _tag_for("linear", damping), _tag_for("angular", damping))
    return Xml("".join([*flags, decay, _elements_with(LINK_ELEMENTS - {"sensor"}, settings)]))


def collision_elements(settings: Settings) -> Xml:
    """Return the settings of a link that are elements of each of its collisions."""
    by_tag = _by_tag(settings)
    friction = parent("friction", parent("ode", *_tags_for(by_tag, _FRICTION)))
    contact = parent("contact", parent("ode", *_tags_for(by_tag, _CONTACT)))
    of_gazebo = shape_elements("collision", settings)
    surface = NOTHING if _has_surface(of_gazebo) else parent("surface", contact, friction)
    return Xml("".join([*_tags_for(by_tag, _COLLISION), surface, of_gazebo]))


def replaced_settings(all_settings: Mapping[str | None, Settings]) -> Iterator[tuple[str, Setting]]:
    """Yield the settings of contacts that a <surface> of the user's replaces, each with the name of its link."""
    for reference, settings in all_settings.items():
        if reference is not None and _has_surface(shape_elements("collision", settings)):
            yield from ((reference, one) for one in settings if one.tag in _FRICTION or one.tag in _CONTACT)


def _has_surface(elements: Xml) -> bool:
    return any(element.tag == "surface" for element in well_formed_elements(elements))


def shape_elements(tag: str, settings: Settings) -> Xml:
    """Return what the settings of a link add to each of its shapes of a tag."""
    setting = _by_tag(settings).get(tag)
    if setting is None:
        return NOTHING
    if setting.raw:
        return Xml("".join(plain_text(child) for one in well_formed_elements(setting.xml) for child in one.children))
    content = setting.value
    return parameter_elements(content, setting.source, *setting.path) if isinstance(content, Mapping) else NOTHING


def joint_physics(settings: Settings) -> Xml:
    """Return the settings of a joint for its physics, and its sensors that are SDF already."""
    by_tag = _by_tag(settings)
    limit = parent("limit", *_tags_for(by_tag, _JOINT_LIMIT))
    ode = parent("ode", *_tags_for(by_tag, _JOINT_ODE), limit)
    physics = parent("physics", _tag_for("provide_feedback", by_tag.get("provideFeedback")), ode)
    return Xml(physics + _elements_with({"sensor"}, settings))


def spring_elements(settings: Settings) -> Sequence[Xml]:
    """Return the settings of a joint for its dynamics."""
    return _tags_for(_by_tag(settings), _SPRING)


def _by_tag(settings: Settings) -> Mapping[str, Setting]:
    return {one.tag: one for one in settings}


def _tags_for(by_tag: Mapping[str, Setting], tags: Mapping[str, str]) -> list[Xml]:
    return [_tag_for(tag, by_tag.get(name)) for name, tag in tags.items()]


def _tag_for(tag: str, setting: Setting | None) -> Xml:
    """Return a setting under the tag of SDF; nothing for none."""
    return text(tag, setting.words, setting.source, *setting.path) if setting else NOTHING


def _elements_with(tags: Set[str], settings: Settings) -> Xml:
    """Return the settings that are elements of SDF with these tags."""
    return Xml("".join(one.xml for one in settings if one.tag in tags))
