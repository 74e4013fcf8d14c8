"""Tags of Gazebo under keys of their own and under `properties`: an override finds each in the place of the other."""

from __future__ import annotations

import re

from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlScalar

_BLOCKS = ("a gazebo block", "a robot's gazebo block")
_PROPERTIES = "properties"


def with_tags_as_patched(block: YamlMap, patch: YamlMap, shape: Shape) -> YamlMap:
    """Return a Gazebo block with each tag that a patch names where the patch has it; anything else as it is.

    An import puts a tag under `properties` whose number is spelled as no number comes out. Two of it would be a fault
    that nobody who only reads the keys of the language could foresee.
    """
    if shape.title not in _BLOCKS:
        return block
    entries = dict(block.entries)
    properties, patched = _properties(block), _properties(patch)
    keys = {_tag(name): name for name in entries if _is_key(shape, name)}
    for name in patch.entries:
        if _is_key(shape, name) and (said := properties.pop(_tag(name), None)):
            entries[name] = YamlEntry(YamlScalar(name, name, said.key.span), said.value)
    for tag in patched.keys() & keys.keys():
        said = entries.pop(keys[tag])
        properties[tag] = YamlEntry(YamlScalar(tag, tag, said.key.span), said.value)
    return YamlMap(_with_properties(entries, properties, block), block.span)


def _with_properties(
    entries: dict[str, YamlEntry], properties: dict[str, YamlEntry], block: YamlMap
) -> dict[str, YamlEntry]:
    said = block.entries.get(_PROPERTIES)
    if said is not None and not isinstance(said.value, YamlMap):
        return entries
    others = {name: entry for name, entry in entries.items() if name != _PROPERTIES}
    if not properties:
        return others
    key = said.key if said else YamlScalar(_PROPERTIES, _PROPERTIES, block.span)
    span = said.value.span if said else block.span
    return {**others, _PROPERTIES: YamlEntry(key, YamlMap(properties, span))}


def _properties(block: YamlMap) -> dict[str, YamlEntry]:
    said = block.get(_PROPERTIES)
    return dict(said.entries) if isinstance(said, YamlMap) else {}


def _is_key(shape: Shape, name: str) -> bool:
    return name != _PROPERTIES and shape.under(name) is not FREE


def _tag(key: str) -> str:
    """Return the tag of a key: its own name, in which Gazebo has a capital where the language has a `_`."""
    return re.sub(r"_([a-z])", lambda found: found[1].upper(), key)
