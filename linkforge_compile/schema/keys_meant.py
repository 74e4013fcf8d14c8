"""What was meant by the keys that an object does not have: where they belong, or what is written instead."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from typing import NamedTuple

from linkforge_compile.diagnostics import MAX_TOLD
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.numbers_meant import number_to_write
from linkforge_compile.schema.repetition import has_names
from linkforge_compile.schema.words import COMMON_KEYS, alternatives, shown
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, is_null

_SHOWN_KEYS = 10
"""More keys than that help nobody who wrote another one."""


class UnknownKeys(NamedTuple):
    """One slip: the keys that belong together, and what to write; `near` are the keys one of which may be meant."""

    entries: Sequence[YamlEntry]
    hint: str
    near: Sequence[str] = ()


def unknown_keys(node: YamlMap, schema: Schema) -> Iterator[UnknownKeys]:
    """Yield the keys of a map that its schema does not know; those that one place takes together, as one slip."""
    known, patterns = mapping(schema.get("properties", {})), mapping(schema.get("patternProperties", {}))
    unknown = (
        (before, entry)
        for before, entry in zip(chain((None,), node), node, strict=False)
        if entry.name not in known
        and not isinstance(entry.value, YamlFault)
        and not any(re.search(pattern, entry.name) for pattern in patterns)
    )
    together: dict[str, list[YamlEntry]] = {}
    for before, entry in islice(unknown, MAX_TOLD + 1):  # a hostile map has a hundred thousand
        if before and (fraction := _decimal_comma(before.value, entry)):
            yield UnknownKeys([entry], fraction)
            continue
        together.setdefault(_slip(entry, node, schema), []).append(entry)
    for slip, entries in together.items():
        if slip in known:
            yield UnknownKeys(entries, _in_its_home(slip, entries, node))
            continue
        hint, near = _meant(entries[0], node, schema)
        more = len(entries) - 1
        if more and slip not in _PARTS.get(str(schema["title"]), {}).values():
            hint += f" ({more} more unknown key{'s' if more > 1 else ''} here)"
        yield UnknownKeys(entries, hint, near)


def like_space_before(entry: YamlEntry) -> Span | None:
    """Return where a key begins with what looks like the spaces that indent it; None for other keys."""
    found = LIKE_SPACES.match(entry.key.span.text or "")
    return entry.key.span.within(found.start(1), 1) if found else None


def _slip(entry: YamlEntry, node: YamlMap, schema: Schema) -> str:
    """Return what an unknown key has in common with others of one slip: where they belong, or what is said of it."""
    known, name = mapping(schema.get("properties", {})), entry.name
    if whole := _whole(entry, schema):
        return whole
    if like_space_before(entry):
        return " "
    if _of_a_table(entry, schema):
        return f"{name}:"
    hint, near = _meant(entry, node, schema)
    # Where it has no other key either, the whole map stands in the wrong place.
    is_misplaced = hint and not near and node.entries.keys().isdisjoint(known)
    return hint.replace(name, "…") if is_misplaced and name else f"{name}:"


def _whole(entry: YamlEntry, schema: Schema) -> str | None:
    """Return what several keys make together: the one key under which they belong, or the list that they are."""
    owner, name = str(schema["title"]), entry.name
    if name in _PARTS.get(owner, {}):
        return _PARTS[owner][name]
    known = mapping(schema.get("properties", {}))
    if (owner, name) in _HINTS_FOR_OWNER or name in _HINTS or _is_other_number(name, known):
        return None
    homes = _homes(name, known)
    return homes[0] if len(homes) == 1 else None


def _in_its_home(home: str, entries: Sequence[YamlEntry], node: YamlMap) -> str:
    """Say how keys are written under the one where they belong; that of which is there already, where it is."""
    if home == "mesh" and isinstance(file := node.get(home), YamlScalar):
        written = ", ".join(f"{entry.name}: {shown(entry.value)}" for entry in entries)
        return f"write 'mesh: {{file: {shown(file)}, {written}}}'"
    if node.get(home) is not None:
        others = alternatives([f"'{entry.name}'" for entry in entries[1:]], "and") if len(entries) > 1 else ""
        return f"it belongs under '{home}'" + (f", as {others}" if others else "")
    written = ", ".join(f"{entry.name}: {shown(entry.value)}" for entry in entries)
    return f"write '{home}: {{{written}}}'"


def _meant(entry: YamlEntry, node: YamlMap, schema: Schema) -> tuple[str, Sequence[str]]:
    """Return what is written instead of a key, else which keys may be meant, else which there are."""
    owner, name = str(schema["title"]), entry.name
    known = mapping(schema.get("properties", {}))
    if hint := _of_a_table(entry, schema) or _place(entry, known):
        return hint, ()
    if nearest(name, known):
        return "", [*known]
    if owner in _BEYOND_ITS_KEYS:
        return _BEYOND_ITS_KEYS[owner].format(name), ()
    if owner == "a parameter" and node.entries.keys().isdisjoint(known):
        return "a map that is its value goes under 'default'", ()
    if owner == "an override" and _says_nothing(entry.value):
        return f"write it in its section, such as 'links: {{{name}: …}}'", ()
    own = [key for key in known if key not in COMMON_KEYS]
    if not 0 < len(own) <= _SHOWN_KEYS:
        return "", ()
    return f"its keys are {alternatives(own, 'and')}" if len(own) > 1 else f"its key is {own[0]}", ()


def _of_a_table(entry: YamlEntry, schema: Schema) -> str:
    """Return what is known to be meant by a word, or by a way to a value."""
    owner, name = str(schema["title"]), entry.name
    return (
        _PARTS.get(owner, {}).get(name)
        or _HINTS_FOR_OWNER.get((owner, name))
        or _HINTS.get(name)
        or _way_in_one_key(name, mapping(schema.get("properties", {})))
    )


_BEYOND_ITS_KEYS = {
    "a module": "a parameter is set by 'with: {{{0}: …}}'",
    "the long form": "with 'for' or 'when', only 'value' is allowed",
    "a gazebo block": "a tag that has no key goes under 'properties'",
    "a robot's gazebo block": "a tag that has no key goes under 'properties'",
}
"""What is meant by a key that is like none of an object's, where others can be said at another place."""


def _way_in_one_key(key: str, known: Mapping[str, Json]) -> str:
    """Return how a way to a value is written that stands in one key, as 'explain' and YAML's queries write it."""
    first, *steps = steps_of(key)
    if first not in known or not steps or not all(steps):
        return ""
    return f"write '{nested([first, *steps], '…')}'"


def steps_of(key: str) -> Sequence[str]:
    """Return the keys of a way to a value that stands in one key; the key itself where it is none."""
    return re.split(r"[/.]", key)


def nested(keys: Sequence[str], value: str) -> str:
    """Return a value under a way of keys in one line: `limits: {effort: 20}`."""
    first, *steps = keys
    inside = "".join(f"{{{step}: " for step in steps)
    return f"{first}: {inside}{value}{'}' * len(steps)}"


def _place(entry: YamlEntry, known: Mapping[str, Json]) -> str:
    """Say where a key belongs, or what stands under it; empty where that is not plain."""
    if _is_other_number(entry.name, known):
        return ""
    if homes := _homes(entry.name, known):
        return "it belongs under " + alternatives([f"'{home}'" for home in homes])
    parts = {name: part for name, part in known.items() if name not in _NOT_HOMES}
    if sections := [name for name, part in parts.items() if _is_entry_of(entry.value, part)]:
        return "write " + alternatives([f"'{name}: {{{entry.name}: …}}'" for name in sections])
    inner = entry.value.entries if isinstance(entry.value, YamlMap) else {}
    if inner and all(name in known and name not in COMMON_KEYS for name in inner):
        return "write what is in it without a map around it"
    entries = [one.value for one in inner.values() if not _says_nothing(one.value)]
    sections = [name for name, part in parts.items() if entries and all(_is_entry_of(one, part) for one in entries)]
    # A mount is a joint as well, and nobody calls it by another word.
    meant = [f"'{name}'" for name in sections if name != "mount"]
    return f"write {alternatives(meant)}" if meant else ""


def _homes(name: str, known: Mapping[str, Json]) -> list[str]:
    """Return the keys of an object under which another one belongs."""
    return [home for home, part in known.items() if home not in _NOT_HOMES and name in _keys_within(part)]


def _is_other_number(name: str, known: Mapping[str, Json]) -> bool:
    """Whether a key is known in the plural, or in the singular."""
    return f"{name}s" in known or name.removesuffix("s") in known


def _decimal_comma(before: YamlNode, entry: YamlEntry) -> str:
    """Say how `1,5 mm` is written, which in braces is the value of one entry and the key `5 mm` behind it."""
    if not (isinstance(before, YamlScalar) and isinstance(before.value, int) and is_null(entry.value)):
        return ""
    meant = number_to_write(f"{before.text},{entry.name}", unit=None)
    return f"write {meant}" if meant else ""


def _keys_within(schema: Json) -> set[str]:
    keys = {key for branch in branches(mapping(schema)) for key in mapping(branch.get("properties", {}))}
    return keys - COMMON_KEYS - {"name"}


def _says_nothing(node: YamlNode) -> bool:
    return is_null(node) or (isinstance(node, YamlMap) and not node.entries)


def _is_entry_of(said: YamlNode, section: Json) -> bool:
    """Whether a section keyed by names has entries that may say all of what is said."""
    keys = {entry.name for entry in said} if isinstance(said, YamlMap) else set()
    entries = [mapping(part["additionalProperties"]) for part in branches(mapping(section)) if has_names(part)]
    known = {key for part in entries for branch in branches(part) for key in mapping(branch.get("properties", {}))}
    return bool(keys) and keys <= known


_NOT_HOMES = {"defaults", "override"}
"""What holds keys only to change those of other places."""

_XYZ, _RPY = "write 'xyz: [x, y, z]'", "write 'rpy: [roll, pitch, yaw]'"
_SIZE = "write its size as one list, 'box: [x, y, z]'"

_PARTS = {
    "an origin": {**dict.fromkeys("xyz", _XYZ), **dict.fromkeys(("roll", "pitch", "yaw"), _RPY)},
    "a box": dict.fromkeys(("x", "y", "z", "width", "depth", "height", "length"), _SIZE),
    "a color": dict.fromkeys(("r", "g", "b", "a"), "write 'color: [r, g, b, a]', each from 0 to 1"),
}
"""Keys that other formats have for the numbers of one list."""

_POSE = "write 'origin: {xyz: [x, y, z], rpy: [roll, pitch, yaw]}'"

_HINTS_FOR_OWNER = {
    ("a robot", "srdf"): "write 'semantic'",
    ("a parameter", "min"): "write 'minimum'",
    ("a parameter", "max"): "write 'maximum'",
    ("defaults", "frame"): "they do not reach frames",
    ("an override", "name"): "a module is named by its key under 'modules'",
    ("an override", "frames"): "a frame is a link and a joint here: write what is to change under 'links' or 'joints'",
    ("an override", "parameters"): "parameters are set by 'with'",
    ("a module", "parameters"): "parameters are set by 'with'",
    ("a module", "args"): "parameters are set by 'with'",
    ("a module", "file"): "write 'use'",
    ("a link", "origin"): "it belongs under 'visual', 'collision' or 'inertial'; a joint's 'origin' places its child",
    ("a link", "pose"): "its place is the 'origin' of the joint whose 'child' it is",
    ("a link", "xyz"): "its place is the 'origin' of the joint whose 'child' it is",
    ("a link", "rpy"): "its place is the 'origin' of the joint whose 'child' it is",
    ("a link", "parent"): "a joint says what it hangs on: 'joints: {NAME: {type: fixed, parent: …, child: …}}'",
    ("a link", "color"): "write it in the visual, 'material: {color: [r, g, b, a]}'",
    ("a visual", "filename"): "write 'mesh'",
    ("a collision", "filename"): "write 'mesh'",
    ("a collision", "material"): "only a visual has one; for friction write 'gazebo: {mu1: …, mu2: …}' in the link",
    ("an inertial", "com"): "write 'origin: [x, y, z]', with 'inertia' about it",
    ("an inertial", "center_of_mass"): "write 'origin: [x, y, z]', with 'inertia' about it",
    ("a sphere", "diameter"): "write 'radius', which is half of it",
    ("a cylinder", "diameter"): "write 'radius', which is half of it",
    ("a cylinder", "height"): "write 'length'",
    ("a capsule", "height"): "write 'length', of the cylinder without its two caps",
    ("a material", "rgba"): "write 'color: [r, g, b, a]'",
    ("a material", "rgb"): "write 'color: [r, g, b]'",
    ("a joint", "parent_link"): "write 'parent'",
    ("a joint", "child_link"): "write 'child'",
    ("a joint", "range"): "write 'limits: {lower: …, upper: …, effort: …, velocity: …}'",
    ("a joint's limits", "min"): "write 'lower'",
    ("a joint's limits", "max"): "write 'upper'",
    ("a joint's limits", "torque"): "write 'effort'",
    ("a joint's limits", "force"): "write 'effort'",
    ("a joint's limits", "speed"): "write 'velocity'",
    ("a virtual joint", "parent"): "write 'parent_frame'",
    ("a virtual joint", "child"): "write 'child_link'",
    ("a frame", "link"): "write 'parent'",
    ("a sensor", "parent"): "write 'link'",
    **{("a mesh", name): "write 'file'" for name in ("filename", "uri", "url", "path")},
    ("a gazebo block", "mu"): "write 'mu1', and 'mu2' for the second direction",
    ("a ros2_control block", "plugin"): "write 'hardware_plugin'",
    ("a ros2_control block", "hardware"): "write its plugin as 'hardware_plugin', its params as 'parameters'",
    ("a ros2_control block", "joint"): "joints go under 'joints', by name",
    ("a laser scanner's rays", "samples"): "write 'horizontal_samples'",
    ("a laser scanner's rays", "resolution"): "write 'horizontal_resolution'",
    ("a laser scanner's rays", "min_angle"): "write 'horizontal_min_angle'",
    ("a laser scanner's rays", "max_angle"): "write 'horizontal_max_angle'",
    ("a laser scanner's rays", "range"): "write 'range_min', 'range_max' and 'range_resolution'",
    ("a laser scanner's rays", "scan"): "write 'horizontal_samples' and the like, without a map around them",
    ("a laser scanner's rays", "horizontal"): "write 'horizontal_samples' and the like",
    ("a laser scanner's rays", "vertical"): "write 'vertical_samples' and the like",
    ("a camera's picture", "image"): "write 'width', 'height' and 'format'",
    ("a camera's picture", "clip"): "write 'near_clip' and 'far_clip'",
    **{
        (owner, name): _POSE
        for owner in ("a visual", "a collision", "a joint", "a sensor", "a frame", "a module", "an inertial")
        for name in ("pose", "transform")
    },
}
"""What is meant by keys that other objects have, or URDF and SDFormat at this place."""

_HINTS = {
    "geometry": "write the shape itself, such as 'box: [1, 1, 1]'",
    "name": "its name is its key",
    "if": "write 'when', such as 'when: $(simulated)'",
    "unless": "write 'when', such as 'when: $(not simulated)'",
    "args": "what a user may set goes under 'parameters'",
    "properties": "what is computed goes under 'variables'",
    "macros": "what is used several times is a file of its own, used under 'modules'",
    "xacro:arg": "what a user may set goes under 'parameters'",
    "xacro:property": "what is computed goes under 'variables'",
    "xacro:macro": "what is used several times is a file of its own, used under 'modules'",
    "xacro:include": "files of one robot go under 'include', those of its parts under 'modules'",
    "xacro:if": "write 'when', such as 'when: $(simulated)'",
    "xacro:unless": "write 'when', such as 'when: $(not simulated)'",
}
"""Habits from URDF and xacro, which put these words where this language has none."""
