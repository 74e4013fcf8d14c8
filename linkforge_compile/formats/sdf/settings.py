"""Settings of Gazebo for links, joints and the robot: where SDF has what the tags of Gazebo in a URDF are about."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.fields import tags_with_text
from linkforge_compile.core.models.gazebo import KEEP_FIXED_JOINT, GazeboElement
from linkforge_compile.core.models.link import PHYSICS_TAGS
from linkforge_compile.formats.element import parameter_elements, raw_texts
from linkforge_compile.formats.raw import plain_text, well_formed_elements
from linkforge_compile.formats.sdf.elements import parent, text
from linkforge_compile.formats.xml_text import NOTHING, Xml, spelled

if TYPE_CHECKING:
    from linkforge_compile.core.exceptions import FieldPath
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.part import FreePart
    from linkforge_compile.source import SourceRef


class Setting(NamedTuple):
    """A tag of Gazebo, or an element of SDF, for a part of the robot, and where it was written."""

    tag: str
    value: FreePart
    source: SourceRef | None
    path: FieldPath
    is_raw: bool = False

    @property
    def words(self) -> str | None:
        """The text of a tag, or its attribute `value`, which Gazebo reads first; None for several of one tag."""
        value = self.value
        if self.is_raw and isinstance(value, str):
            (element,) = well_formed_elements(value)
            value = element.get("value") or element.text
        elif isinstance(value, Mapping):
            value = value.get("_value", value.get("_text", ""))
        return value.strip() if isinstance(value, str) else None

    @property
    def names(self) -> Sequence[str]:
        """The attributes `name` of the elements of this tag."""
        if self.is_raw and isinstance(self.value, str):
            return [element.get("name") or "" for element in well_formed_elements(self.value)]
        parts = [self.value] if isinstance(self.value, str | Mapping) else self.value
        return [str(part.get("_name", "")) for part in parts if isinstance(part, Mapping)]


Settings: TypeAlias = Sequence[Setting]


def settings_by_reference(robot: Robot) -> Mapping[str | None, Settings]:
    """Return the settings of links, joints, and under None of the robot itself; of two with one tag, the last."""
    found: dict[str | None, dict[str, Setting]] = defaultdict(dict)
    for link in robot.links:
        for name, tag in PHYSICS_TAGS.items():
            if link.physics.is_written(name):
                value = spelled(getattr(link.physics, name))
                found[link.name][tag] = Setting(tag, value, link.physics.source, (name,))
    for block in robot.gazebo_elements:
        for setting in _settings_of(block):
            # Each raw text is one of its own, whatever its tag.
            key = "/".join(map(str, (setting.tag, *setting.path))) if setting.is_raw else setting.tag
            found[block.reference][key] = setting
    return {reference: tuple(settings.values()) for reference, settings in found.items()}


def _settings_of(block: GazeboElement) -> Iterator[Setting]:
    for name, tag in _FIELD_TAGS.items():
        if (value := getattr(block, name)) is not None:
            yield Setting(tag, spelled(value), block.source, (name,))
    # Tags of Gazebo that are keys of the language are written in the block itself, others in its `properties`.
    own = block.source.node if block.source else None
    for tag, value in block.properties.items():
        yield Setting(tag, value, block.source, (tag,) if own and own.child(tag) else ("properties", tag))
    for raw, source, path in raw_texts(block, block.source):
        for number, element in enumerate(well_formed_elements(raw)):
            yield Setting(element.tag, plain_text(element), source, (*path, number), is_raw=True)


_FIELD_TAGS = tags_with_text(GazeboElement)

LINK_ELEMENTS = frozenset(
    ("sensor", "light", "battery", "projector", "audio_source", "audio_sink", "particle_emitter", "velocity_decay")
)
"""Elements of SDF that are copied into a link as they are."""

_MODEL_ELEMENTS = frozenset(
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

_KNOWN_OF_LINKS = frozenset(
    (*LINK_ELEMENTS, *_LINK_FLAGS, *_FRICTION, *_CONTACT, *_COLLISION, *_OF_SHAPES, "turnGravityOff", "dampingFactor")
)
_KNOWN_OF_JOINTS = frozenset((*_SPRING, *_JOINT_LIMIT, *_JOINT_ODE, "provideFeedback", "sensor", *KEEP_FIXED_JOINT))


def lost_settings(robot: Robot) -> Iterator[tuple[str | None, Setting]]:
    """Yield the settings that SDF, or Gazebo Sim, has no place for, each with the name of its link or joint."""
    for reference, settings in settings_by_reference(robot).items():
        if reference is None:
            known = _MODEL_ELEMENTS
        else:
            known = _KNOWN_OF_LINKS if robot.has_link(reference) else _KNOWN_OF_JOINTS
        yield from ((reference, one) for one in settings if one.tag not in known)


def model_elements(settings: Settings) -> Xml:
    """Return the settings of the robot itself."""
    return _copied(settings, _MODEL_ELEMENTS)


def nested_model_elements(settings: Settings) -> Xml:
    """Return the settings of the robot that hold for each of its models."""
    return _copied(settings, _FLAGS_OF_MODELS)


def link_elements(settings: Settings) -> Xml:
    """Return the settings of a link that are elements of the link itself."""
    by_tag = _by_tag(settings)
    flags = [_as(tag, by_tag.get(name)) for name, tag in _LINK_FLAGS.items()]
    if off := by_tag.get("turnGravityOff"):
        is_on = (off.words or "").lower() in ("false", "no", "0")
        flags.append(text("gravity", is_on, off.source, *off.path))
    damping = by_tag.get("dampingFactor")
    decay = parent("velocity_decay", _as("linear", damping), _as("angular", damping))
    return Xml("".join([*flags, decay, _copied(settings, LINK_ELEMENTS)]))


def collision_elements(settings: Settings) -> Xml:
    """Return the settings of a link that are elements of each of its collisions."""
    by_tag = _by_tag(settings)
    friction = parent("friction", parent("ode", *_all(by_tag, _FRICTION)))
    contact = parent("contact", parent("ode", *_all(by_tag, _CONTACT)))
    of_gazebo = shape_elements("collision", settings)
    surface = NOTHING if _has_surface(of_gazebo) else parent("surface", contact, friction)
    return Xml("".join([*_all(by_tag, _COLLISION), surface, of_gazebo]))


def replaced_settings(robot: Robot) -> Iterator[tuple[str, Setting]]:
    """Yield the settings of contacts that a <surface> of the user's replaces, each with the name of its link."""
    for reference, settings in settings_by_reference(robot).items():
        if reference is not None and _has_surface(shape_elements("collision", settings)):
            yield from ((reference, one) for one in settings if one.tag in _FRICTION or one.tag in _CONTACT)


def _has_surface(elements: Xml) -> bool:
    return any(element.tag == "surface" for element in well_formed_elements(elements))


def shape_elements(tag: str, settings: Settings) -> Xml:
    """Return what the settings of a link add to each of its shapes of a tag."""
    setting = _by_tag(settings).get(tag)
    if setting is None:
        return NOTHING
    content = setting.value
    if setting.is_raw and isinstance(content, str):
        return Xml(
            "".join(plain_text(child) for element in well_formed_elements(content) for child in element.children)
        )
    return parameter_elements(content, setting.source, *setting.path) if isinstance(content, Mapping) else NOTHING


def joint_physics(settings: Settings) -> Xml:
    """Return the settings of a joint for its physics, and its sensors that are SDF already."""
    by_tag = _by_tag(settings)
    limit = parent("limit", *_all(by_tag, _JOINT_LIMIT))
    ode = parent("ode", *_all(by_tag, _JOINT_ODE), limit)
    physics = parent("physics", _as("provide_feedback", by_tag.get("provideFeedback")), ode)
    return Xml(physics + _copied(settings, frozenset(("sensor",))))


def spring_elements(settings: Settings) -> Sequence[Xml]:
    """Return the settings of a joint for its dynamics."""
    return _all(_by_tag(settings), _SPRING)


def _by_tag(settings: Settings) -> Mapping[str, Setting]:
    return {one.tag: one for one in settings}


def _all(by_tag: Mapping[str, Setting], tags: Mapping[str, str]) -> list[Xml]:
    return [_as(tag, by_tag.get(name)) for name, tag in tags.items()]


def _as(tag: str, setting: Setting | None) -> Xml:
    """Return a setting under the tag of SDF; nothing for none."""
    return text(tag, setting.words, setting.source, *setting.path) if setting else NOTHING


def _copied(settings: Settings, tags: frozenset[str]) -> Xml:
    """Return the settings that are elements of SDF already."""
    return Xml("".join(_element(one) for one in settings if one.tag in tags))


def _element(setting: Setting) -> Xml:
    if setting.is_raw and isinstance(setting.value, str):
        return Xml(setting.value)
    return parameter_elements({setting.tag: setting.value}, setting.source, *setting.path[:-1])
