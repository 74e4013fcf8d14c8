"""One error of jsonschema, in one human sentence at one place: a function a keyword."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.schema import (
    MISSING_NAME,
    MISSING_VERSION,
    OTHER_VERSION,
    UNKNOWN_KEY,
    UNKNOWN_WORD,
    WRONG_KIND,
    WRONG_LENGTH,
)
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.meant import Misfit, Path, is_row, meant_expression, way_out
from linkforge_compile.schema.repetition import has_names
from linkforge_compile.schema.words import (
    COMMON_KEYS,
    alternatives,
    branch_meant,
    expected,
    field,
    found,
    shortened,
    words_of,
)
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.syntax.xacro import xacro_facts

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError

_SHOWN_KEYS = 10
"""More keys than that help nobody who wrote another one."""


class Judgement(NamedTuple):
    """A fault, and the path of the node that must not go on: a YamlFault takes its place."""

    diagnostic: Diagnostic
    path: Path


def explain(error: ValidationError, tree: YamlMap) -> Iterator[Judgement]:
    """Yield the faults behind one error; none where nothing was said or the reader has reported it already."""
    path = tuple(error.absolute_path)
    node = _node_at(tree, path)
    if isinstance(node, YamlFault) or (is_null(node) and not isinstance(path[-1], int)):
        return
    misfit = Misfit(node, path, mapping(error.schema), tree)
    meant = None if error.validator != "anyOf" or _is_text(node) else branch_meant(misfit.schema, node)
    if meant is not None:
        for inner in error.context or ():
            if inner.schema_path[0] == meant:
                yield from explain(inner, tree)
    elif isinstance(node, YamlScalar) and (facts := xacro_facts(node.text)):
        for one in facts:
            yield Judgement(XACRO_EXPRESSION.at(node.span, text=one["text"], ours=one["ours"]), path)
    else:
        yield from _EXPLAIN[str(error.validator)](misfit)


def _unknown_keys(misfit: Misfit) -> Iterator[Judgement]:
    node, path, schema, _ = misfit
    known, patterns = mapping(schema.get("properties", {})), mapping(schema.get("patternProperties", {}))
    for entry in node if isinstance(node, YamlMap) else ():
        if entry.name in known or any(re.search(pattern, entry.name) for pattern in patterns):
            continue
        yield Judgement(_unknown_key(entry, schema), (*path, entry.name))


def _unknown_key(entry: YamlEntry, schema: Schema) -> Diagnostic:
    """Say where the key belongs, else which was meant, else which there are."""
    key = entry.key
    owner, known = str(schema["title"]), mapping(schema.get("properties", {}))
    own = [name for name in known if name not in COMMON_KEYS]
    near = [*known]
    hint = _HINTS_FOR_OWNER.get((owner, key.text)) or _HINTS.get(key.text) or _hint_for_path(key.text, known)
    parts = {name: part for name, part in known.items() if name not in _NOT_HOMES}
    if not hint and (homes := [f"'{name}'" for name, part in parts.items() if key.text in _keys_within(part)]):
        hint = f"it belongs under {alternatives(homes)}"
    if not hint and (sections := [name for name, part in parts.items() if _is_entry_of(entry.value, part)]):
        written = [f"'{name}: {{{key.text}: …}}'" for name in sections]
        hint = f"write {alternatives(written)}"
    if not hint and owner == "an override" and nearest(key.text, near) is None and _says_nothing(entry.value):
        hint = f"write it in its section, such as 'links: {{{key.text}: …}}'"
    if not hint and nearest(key.text, near) is None and 0 < len(own) <= _SHOWN_KEYS:
        hint = f"its keys are {alternatives(own, 'and')}"
    hinted = f"; {hint}" if hint else ""
    return UNKNOWN_KEY.at(key.span, name=key.text, owner=owner, hint=hinted, near=() if hint else near)


def _hint_for_path(key: str, known: Schema) -> str:
    """Return how a way to a value is written that stands in one key, as 'explain' and YAML's queries write it."""
    first, *steps = re.split(r"[/.]", key)
    if first not in known or not steps or not all(steps):
        return ""
    inside = "".join(f"{{{step}: " for step in steps)
    return f"write '{first}: {inside}…{'}' * len(steps)}'"


_HINTS_FOR_OWNER = {
    ("an override", "frames"): "a frame is a link and a joint here: write what is to change under 'links' or 'joints'",
    ("an override", "parameters"): "parameters are set by 'with'",
    ("a module", "parameters"): "parameters are set by 'with'",
    ("a module", "args"): "parameters are set by 'with'",
    ("a module", "file"): "write 'use'",
    ("a joint", "parent_link"): "write 'parent'",
    ("a joint", "child_link"): "write 'child'",
    ("a joint's limits", "min"): "write 'lower'",
    ("a joint's limits", "max"): "write 'upper'",
    ("a joint's limits", "torque"): "write 'effort'",
    ("a joint's limits", "force"): "write 'effort'",
    ("a joint's limits", "speed"): "write 'velocity'",
    ("a virtual joint", "parent"): "write 'parent_frame'",
    ("a virtual joint", "child"): "write 'child_link'",
    ("a frame", "link"): "write 'parent'",
    ("a sensor", "parent"): "write 'link'",
    ("a mesh", "filename"): "write 'file'",
    **{("an origin", axis): "write 'xyz: [x, y, z]'" for axis in "xyz"},
    **{("an origin", angle): "write 'rpy: [roll, pitch, yaw]'" for angle in ("roll", "pitch", "yaw")},
    ("a gazebo block", "mu"): "write 'mu1', and 'mu2' for the second direction",
    ("a ros2_control block", "plugin"): "write 'hardware_plugin'",
    ("a ros2_control block", "hardware"): "write its plugin as 'hardware_plugin', its params as 'parameters'",
    ("a ros2_control block", "joint"): "joints stand under 'joints', by name",
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
}
"""What is meant by keys that other objects have, or URDF and SDFormat at this place."""

_HINTS = {
    "geometry": "write the shape itself, such as 'box: [1, 1, 1]'",
    "name": "its name is the key that it stands under",
    "if": "write 'when', such as 'when: $(simulated)'",
    "unless": "write 'when', such as 'when: $(not simulated)'",
    "args": "what a user may set stands under 'parameters'",
    "properties": "what is computed stands under 'variables'",
    "macros": "what is used several times is a file of its own, used under 'modules'",
    "xacro:arg": "what a user may set stands under 'parameters'",
    "xacro:property": "what is computed stands under 'variables'",
    "xacro:macro": "what is used several times is a file of its own, used under 'modules'",
    "xacro:include": "files that are one robot stand under 'include', those of its parts under 'modules'",
    "xacro:if": "write 'when', such as 'when: $(simulated)'",
    "xacro:unless": "write 'when', such as 'when: $(not simulated)'",
}
"""Habits from URDF and xacro, which put these words where this language has none."""


_NOT_HOMES = {"defaults", "override"}
"""What holds keys only to change those of other places."""


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


def _missing_keys(misfit: Misfit) -> Iterator[Judgement]:
    """Tell of all missing keys: the error does not say which one it is for, and the sink takes equal faults as one."""
    node, path, schema, _ = misfit
    required = schema["required"]
    if not isinstance(node, YamlMap) or not isinstance(required, list):
        return
    first = next((entry.key.span for entry in node), node.span)
    for name in map(str, required):
        if node.get(name) is None:
            code = MISSING_VERSION if name == "linkforge" else MISSING_NAME
            yield Judgement(code.at(first), (*path, name))


def _other_version(misfit: Misfit) -> Iterator[Judgement]:
    yield Judgement(OTHER_VERSION.at(misfit.node.span, found=found(misfit.node)), misfit.path)


def _wrong_word(misfit: Misfit) -> Iterator[Judgement]:
    """Say which words there are, of text; of anything else, `type` has told already."""
    node, path, schema, _ = misfit
    if isinstance(node, YamlScalar) and isinstance(node.value, str):
        words, meant = words_of(schema), _WORDS_MEANT.get(node.text.lower())
        meant = meant if meant in words else meant_expression(misfit)
        hint = f"; write '{meant}'" if meant else ""
        facts = {"field": field(path), "expected": expected(schema), "name": shortened(node.text), "hint": hint}
        yield Judgement(UNKNOWN_WORD.at(node.span, near=() if hint else words, notes=(), **facts), path)


_WORDS_MEANT = {
    "float": "number",
    "double": "number",
    "int": "integer",
    "str": "string",
    "bool": "boolean",
    "path": "file",
    "array": "list",
    "dict": "map",
    "hinge": "revolute",
    "slider": "prismatic",
    "linear": "prismatic",
    "rigid": "fixed",
    "depth": "depth_camera",
    "gpu_ray": "gpu_lidar",
    "laser": "lidar",
}
"""Words of other languages and formats for those of this one."""


def _wrong_kind(misfit: Misfit) -> Iterator[Judgement]:
    node, path, schema, _ = misfit
    said = f"{found(node)}{way_out(misfit)}"
    yield Judgement(WRONG_KIND.at(node.span, field=field(path), expected=expected(schema), found=said), path)


def _no_branch(misfit: Misfit) -> Iterator[Judgement]:
    word = _is_text(misfit.node) and not is_row(misfit.node) and words_of(misfit.schema)
    yield from (_wrong_word if word else _wrong_kind)(misfit)


def _wrong_length(misfit: Misfit) -> Iterator[Judgement]:
    node, path, schema, _ = misfit
    # A row of numbers without commas is told as that.
    if isinstance(node, YamlList) and not any(map(is_row, node)):
        yield Judgement(
            WRONG_LENGTH.at(node.span, field=field(path), expected=expected(schema), found=len(node)),
            path,
        )


_EXPLAIN: dict[str, Callable[[Misfit], Iterator[Judgement]]] = {
    "additionalProperties": _unknown_keys,
    "required": _missing_keys,
    "const": _other_version,
    "enum": _wrong_word,
    "anyOf": _no_branch,
    "type": _wrong_kind,
    "pattern": _wrong_kind,
    "minItems": _wrong_length,
    "maxItems": _wrong_length,
}


def _node_at(tree: YamlMap, path: Path) -> YamlNode:
    node: YamlNode | None = tree
    for key in path:
        node = node.child(key) if node else None
    if node is None:
        raise LookupError(f"no node at {path}")
    return node


def _is_text(node: YamlNode) -> bool:
    return isinstance(node, YamlScalar) and isinstance(node.value, str)
