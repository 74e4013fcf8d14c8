"""The table of hints: keys and words that users write out of habit, and what to write instead.

A new hint is a row here. Keys without a row get a did-you-mean or the list of keys, from `misplaced_keys`.
"""

from __future__ import annotations

from collections.abc import Iterable

_POSE = "write 'origin: {xyz: [x, y, z], rpy: [roll, pitch, yaw]}'"
_JOINT_PLACES_LINK = "a link is placed by the 'origin' of the joint whose 'child' it is"
_SET_BY_WITH = "parameters are set under 'with'"

_KEYS = (
    # objects by title ("" is any), keys, hint
    ("", "geometry", "write the shape itself, such as 'box: [1, 1, 1]'"),
    ("", "name", "its name is its key"),
    ("", "if xacro:if", "write 'when', such as 'when: $(simulated)'"),
    ("", "unless xacro:unless", "write 'when', such as 'when: $(not simulated)'"),
    ("", "args xacro:arg", "declare it under 'parameters'"),
    ("", "properties xacro:property", "declare it under 'variables'"),
    ("", "macros xacro:macro", "put it in a file of its own and use that under 'modules'"),
    ("", "xacro:include", "list files of the same robot under 'include', files of its parts under 'modules'"),
    ("a robot", "srdf", "write 'semantic'"),
    ("defaults", "frame", "defaults do not apply to frames"),
    ("an override", "frames", "a frame is a link and a joint here; override those under 'links' or 'joints'"),
    ("an override, a module", "parameters", _SET_BY_WITH),
    ("a module", "args", _SET_BY_WITH),
    ("a link", "origin", "it belongs under 'visual', 'collision' or 'inertial'; a joint's 'origin' places its child"),
    ("a link", "pose xyz rpy", _JOINT_PLACES_LINK),
    ("an inertial", "com center_of_mass", "write 'origin: [x, y, z]', with 'inertia' about it"),
    ("a material", "rgba", "write 'color: [r, g, b, a]'"),
    ("a ros2_control block", "hardware", "write 'hardware_plugin: PLUGIN', and each 'param' under 'parameters'"),
    ("a gazebo block, a robot's gazebo block", "sensor", "declare it under 'sensors', or write it under 'properties'"),
    ("a gazebo block", "mu", "write 'mu1', and 'mu2' for the second direction"),
    ("a lidar's settings", "range", "write 'range_min', 'range_max' and 'range_resolution'"),
    ("a camera's settings", "image", "write 'width', 'height' and 'format'"),
    ("a visual, a collision, a joint, a sensor, a frame, a module, an inertial", "pose transform", _POSE),
)

_RENAMED_KEYS = (
    # objects by title, keys of other formats with the same values, our key
    ("a parameter", "min", "minimum"),
    ("a parameter", "max", "maximum"),
    ("a module", "file", "use"),
    ("a cylinder", "height", "length"),
    ("a material", "rgba", "color"),
    ("a joint", "child_link", "child"),
    ("a joint", "parent_link", "parent"),
    ("a joint", "limit", "limits"),
    ("a joint's limits", "min", "lower"),
    ("a joint's limits", "max", "upper"),
    ("a joint's limits", "torque force", "effort"),
    ("a joint's limits", "speed", "velocity"),
    ("a mesh", "filename uri", "file"),
    ("a ros2_control block", "plugin", "hardware_plugin"),
    ("a lidar's settings", "samples", "horizontal_samples"),
    ("a lidar's settings", "min_angle", "horizontal_min_angle"),
    ("a lidar's settings", "max_angle", "horizontal_max_angle"),
)

_NUMBERS_OF_LISTS = (
    # objects by title, keys that other formats have for the numbers of one list, hint
    ("an origin", "x y z", "write 'xyz: [x, y, z]'"),
    ("an origin", "roll pitch yaw", "write 'rpy: [roll, pitch, yaw]'"),
    ("a box", "x y z width depth height length", "write its size as one list, 'box: [x, y, z]'"),
    ("a color", "r g b a", "write 'color: [r, g, b, a]', each from 0 to 1"),
)

_LIKELY_KEYS = (
    # objects by title ("" is any), keys of other formats, our key, if it takes the value as it is
    ("", "if xacro:if", "when"),
    ("", "args xacro:arg", "parameters"),
    ("", "properties xacro:property", "variables"),
    ("a module", "parameters args", "with"),
    ("an inertial", "com center_of_mass", "origin"),
    ("a gazebo block", "mu", "mu1"),
)

LIST_OF_NUMBERS = {
    # object by title and one of its keys: our key for the numbers, "" for the object itself, and all keys in order
    **{("an origin", name): ("xyz", ("x", "y", "z")) for name in ("x", "y", "z")},
    **{("an origin", name): ("rpy", ("roll", "pitch", "yaw")) for name in ("roll", "pitch", "yaw")},
    **{("a box", name): ("", ("x", "y", "z")) for name in ("x", "y", "z")},
    **{("a color", name): ("", ("r", "g", "b", "a")) for name in ("r", "g", "b", "a")},
}
"""The keys that other formats have for the numbers of a list."""

_ANY_OTHER_KEY = (
    # objects by title, where to write a key that is like none of theirs, the key to write it under
    ("a module", "set a parameter with 'with: {{{0}: …}}'", "with"),
    ("the long form", "only 'for', 'when' and 'value' are allowed here", ""),
    ("a gazebo block, a robot's gazebo block", "write other tags under 'properties'", "properties"),
)

FIELDS_IN_ORDER = {
    "a cylinder": ("radius", "length"),
    "a capsule": ("radius", "length"),
    "a joint's limits": ("lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"),
    "a chain": ("base_link", "tip_link"),
    "an inertia tensor": ("ixx", "iyy", "izz"),
}
"""Objects, by title, that users write as a list of their fields."""

_WORDS = {
    # words of the language, words of Python, MuJoCo, SDFormat and people
    "number": "float double",
    "integer": "int",
    "string": "str",
    "boolean": "bool",
    "revolute": "hinge rotary",
    "prismatic": "slide slider",
    "floating": "free",
    "x": "+x",
    "y": "+y",
    "z": "+z",
}

NO_BALL_JOINT = "; URDF has no ball joint, so write three revolute joints with the same origin"


def _by_key(rows: Iterable[tuple[str, str, str]]) -> dict[tuple[str, str], str]:
    return {(owner, key): hint for owners, keys, hint in rows for owner in owners.split(", ") for key in keys.split()}


_KEY_HINTS = _by_key(_KEYS)
_NEW_KEYS = _by_key(_RENAMED_KEYS)
_OUR_KEYS = _by_key(_LIKELY_KEYS)
_NUMBER_HINTS = _by_key(_NUMBERS_OF_LISTS)
_OTHER_KEY_HINTS = {owner: rest for owners, *rest in _ANY_OTHER_KEY for owner in owners.split(", ")}
_INTENDED_WORDS = {word: intended for intended, words in _WORDS.items() for word in words.split()}


def known_key_hint(owner: str, key: str) -> str:
    """Return the hint for a key in an object of this title, "" where the table has none."""
    new = renamed_key(owner, key)
    return _KEY_HINTS.get((owner, key)) or (f"write '{new}'" if new else _KEY_HINTS.get(("", key), ""))


def renamed_key(owner: str, key: str) -> str:
    """Return our key for one of another format whose values are the same, "" for any other key."""
    return _NEW_KEYS.get((owner, key), "")


def likely_key(owner: str, key: str) -> str:
    """Return our key for one that takes the same value in most cases, "" for any other key."""
    return _OUR_KEYS.get((owner, key)) or _OUR_KEYS.get(("", key), "")


def number_of_list_hint(owner: str, key: str) -> str:
    """Return the hint for a key that is one number of a list of this object, "" for any other key."""
    return _NUMBER_HINTS.get((owner, key), "")


def other_key_hint(owner: str, key: str) -> str:
    """Return where an object's keys that the schema does not know belong, "" where they belong nowhere."""
    return _OTHER_KEY_HINTS.get(owner, ["", ""])[0].format(key)


def other_key_home(owner: str) -> str:
    """Return the key under which an object's keys that the schema does not know belong, "" for none."""
    return _OTHER_KEY_HINTS.get(owner, ["", ""])[1]


def intended_word(word: str) -> str | None:
    """Return the word of the language for a word of another format or language."""
    return _INTENDED_WORDS.get(word.lower())


# Sections, by which misplaced ones are recognized

MAY_BE_EMPTY = {"links"}
"""Sections whose entries may be empty: a link may, and have any name."""

OF_ANY_VALUE = {"metadata", "variables"}
"""Sections whose entries may have any value, or none."""

ESSENTIAL_KEYS = {
    "joints": "child",
    "frames": "parent",
    "modules": "use",
    "sensors": "link",
    "transmissions": "joints",
    "ros2_control blocks": "hardware_plugin",
    "controllers": "command_interfaces",
    "virtual joints": "child_link",
    "end effectors": "parent_link",
}
"""The key that every entry of a section has."""
