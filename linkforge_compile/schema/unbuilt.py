"""The keys of the language that this version does not compile yet: a table that shrinks as the compiler grows."""

from __future__ import annotations

from collections.abc import Mapping

_ENTRY = {"for", "when"}
"""Of each entry of a named map and each item of a list."""

_OBJECT = {"when"}
"""Of every other object that the schema knows."""

_ELEMENT = {"extra", "extra_attributes"}
"""Of every object that becomes an element of the output."""

_SECTIONS = {"data", "variants", "include", "defaults", "mount", "sensors", "transmissions", "ros2_control", "gazebo"}

UNBUILT: Mapping[str, set[str]] = {
    "a robot": _SECTIONS | _ELEMENT,
    "a material": _ENTRY | _ELEMENT,
    "a visual's material": _OBJECT | _ELEMENT,
    "a link": _ENTRY | _ELEMENT | {"physics", "gazebo"},
    "a visual": _ENTRY | _ELEMENT,
    "a collision": _ENTRY | _ELEMENT,
    "a cylinder": _OBJECT | _ELEMENT,
    "a sphere": _OBJECT | _ELEMENT,
    "a capsule": _OBJECT | _ELEMENT,
    "a mesh": _OBJECT | _ELEMENT,
    "an inertial": _OBJECT | _ELEMENT,
    "an inertia tensor": _OBJECT | _ELEMENT,
    "an origin": _OBJECT | _ELEMENT,
    "a joint": _ENTRY | _ELEMENT | {"gazebo"},
    "a joint's limits": _OBJECT | _ELEMENT,
    "a joint's dynamics": _OBJECT | _ELEMENT,
    "a joint's mimic": _OBJECT | _ELEMENT,
    "a joint's safety controller": _OBJECT | _ELEMENT,
    "a joint's calibration": _OBJECT | _ELEMENT,
    "a frame": _ENTRY,
    "a module": _ENTRY | {"override", "srdf"},
    "a module's joint": _OBJECT | _ELEMENT | {"gazebo"},
    "a semantic part": _OBJECT | {"extra"},
    "a virtual joint": _ENTRY | _ELEMENT,
    "a group": _ENTRY | _ELEMENT,
    "a chain": _ENTRY | _ELEMENT,
    "an end effector": _ENTRY | _ELEMENT,
    "an approximating sphere": _ENTRY | _ELEMENT,
}
"""The keys by the owner, which is the `title` of its schema."""

LONG_FORM = "value"
"""With `for` or `when` beside it, the item of a list that holds no objects: `{for: {i: 3}, value: joint_$(i)}`."""

DECIDES_ITS_OWNER = {"for", "when", "data", "include", "defaults", "mount", "override"}
"""Without these nobody knows what their owner is: all of it counts as faulty, so that no stage judges the rest."""
