"""Every place where a spec and its modules write the name of a part: where it is declared and where it is used.

What a name names is marked in the schemas; the names themselves are read in the expanded trees, whose places lead to
the texts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.analysis import Analysis
from linkforge_compile.editor.completions import KEYS, NAMES, marked_names
from linkforge_compile.expand import Instance
from linkforge_compile.expand.instance import joint_name_of
from linkforge_compile.roots import identity
from linkforge_compile.schema.json_schema import Schema, branches, mapping, reference
from linkforge_compile.schema.registry import definitions
from linkforge_compile.source import Position, Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

DECLARING = {
    ("links",): "link",
    ("joints",): "joint",
    ("frames",): "link",
    ("materials",): "material",
    ("sensors",): "sensor",
    ("transmissions",): "transmission",
    ("ros2_control",): "hardware",
    ("controllers",): "controller",
    ("semantic", "groups"): "group",
    ("semantic", "virtual_joints"): "virtual joint",
    ("semantic", "end_effectors"): "end effector",
}
"""The sections whose keys declare parts, and what they declare."""

_STATES = ("semantic", "group_states")


COMPUTING = {("modules",): "module", ("parameters",): "parameter", ("variables",): "variable", ("data",): "data"}
"""The sections of a file that only compute, and what their keys declare."""


class Occurrence(NamedTuple):
    """A name at a place; `name` is the final one, with the prefixes, of which `written` is what the place writes.

    A place in a file that is used several times has an occurrence for each use. The text at the place is another one
    where an expression makes the name.
    """

    kind: str
    name: str
    written: str
    span: Span
    is_declaration: bool = False


class Occurrences:
    """The occurrences of an analysis, by name and by place."""

    def __init__(self, analysis: Analysis) -> None:
        found = _in_instance(analysis.instance, "") if analysis.instance else ()
        self.all = tuple(dict.fromkeys(found))

    def at(self, path: str, position: Position) -> tuple[Occurrence, ...]:
        """Return those at a place in the file with a real path, the innermost first."""
        here = (one for one in self.all if _is_in(one.span, path) and one.span.start <= position <= one.span.end)
        return tuple(sorted(here, key=lambda one: (one.span.end.line - one.span.line, len(one.span.text or ""))))

    def of(self, names: Iterable[Occurrence]) -> tuple[Occurrence, ...]:
        """Return all occurrences of what the given ones name."""
        wanted = {(one.kind, one.name) for one in names}
        return tuple(one for one in self.all if (one.kind, one.name) in wanted)


def _is_in(span: Span, path: str) -> bool:
    return span.file.path is not None and identity(span.file.path) == path


def _in_instance(instance: Instance, outer: str) -> Iterator[Occurrence]:
    """Yield the occurrences in a use of a file, whose entry is written in the file around it, and in its modules."""
    prefix = outer + instance.prefix
    if instance.tree is not None:
        walker = _Walker(prefix)
        yield from walker.declarations(instance.tree)
        yield from walker.references(instance.tree, definitions()["robot"])
        for override in instance.overrides:
            yield from (one._replace(is_declaration=False) for one in walker.declarations(override))
            yield from walker.references(override, definitions()["robot"])
        for one in instance.references:
            yield Occurrence(one.kind, prefix + one.name, one.name, one.where.span)
    for module in instance.modules:
        if module.entry is not None and isinstance(module.entry.node, YamlMap):
            yield from _in_entry(module, module.entry.node, prefix)
        yield from _in_instance(module, prefix)


def _in_entry(module: Instance, entry: YamlMap, prefix: str) -> Iterator[Occurrence]:
    """Yield the occurrences in the entry of a module: its own name, that of its joint, and its parent."""
    walker = _Walker(prefix)
    if module.entry is not None and isinstance(module.entry.key, YamlScalar):
        yield walker.occurrence("module", module.entry.key, is_declaration=True)
    yield from walker.references(entry, definitions()["module"])
    joint = entry.get("joint")
    named = joint.get("name") if isinstance(joint, YamlMap) else joint
    if isinstance(named, YamlScalar):
        yield walker.occurrence("joint", named, is_declaration=True)
    elif module.entry is not None and isinstance(module.entry.key, YamlScalar) and entry.get("parent"):
        key, name = module.entry.key, joint_name_of(module.name, entry)
        yield Occurrence("joint", prefix + name, name, key.span, is_declaration=True)


class _Walker:
    """Finds names in one use of a file, whose names get a prefix."""

    def __init__(self, prefix: str) -> None:
        self._prefix = prefix

    def occurrence(self, kind: str, node: YamlScalar, *, is_declaration: bool = False) -> Occurrence:
        return Occurrence(kind, self._prefix + node.text, node.text, node.span, is_declaration)

    def declarations(self, tree: YamlMap) -> Iterator[Occurrence]:
        """Yield the names that the sections of a file declare."""
        for path, kind in DECLARING.items():
            for entry in _section(tree, path):
                yield self.occurrence(kind, entry.key, is_declaration=True)
                if path == ("frames",) and isinstance(entry.value, YamlMap):
                    name = joint_name_of(entry.name, entry.value)
                    yield Occurrence("joint", self._prefix + name, name, entry.key.span, is_declaration=True)
        for group in _section(tree, _STATES):
            for state in group.value if isinstance(group.value, YamlMap) else ():
                name = f"{self._prefix}{group.name}/{state.name}"
                yield Occurrence("state", name, state.name, state.key.span, is_declaration=True)

    def references(self, node: YamlNode, schema: Schema) -> Iterator[Occurrence]:
        """Yield the names in what a schema describes that its marks call names of parts."""
        what, kinds = marked_names(schema)
        if what == NAMES:
            for scalar in (node,) if isinstance(node, YamlScalar) else node if isinstance(node, YamlList) else ():
                if isinstance(scalar, YamlScalar) and scalar.value is not None:
                    yield from (self.occurrence(kind, scalar) for kind in kinds)
        target = reference(schema)
        if target is not None:
            yield from self.references(node, definitions()[target])
        elif "anyOf" in schema:
            for branch in branches(schema):
                yield from self.references(node, branch)
        elif isinstance(node, YamlList) and isinstance(schema.get("items"), dict):
            for item in node:
                yield from self.references(item, mapping(schema["items"]))
        elif isinstance(node, YamlMap):
            yield from self._in_map(node, schema, kinds if what == KEYS else ())

    def _in_map(self, node: YamlMap, schema: Schema, kinds: Iterable[str]) -> Iterator[Occurrence]:
        known, others = mapping(schema.get("properties", {})), schema.get("additionalProperties")
        for entry in node:
            if entry.name in known:
                yield from self.references(entry.value, mapping(known[entry.name]))
                continue
            yield from (self.occurrence(kind, entry.key) for kind in kinds)
            if isinstance(others, Mapping):
                yield from self.references(entry.value, mapping(others))


def declarations_in(tree: YamlMap) -> Iterator[tuple[str, YamlEntry]]:
    """Yield the kind and entry of each part that a file declares, as written, section by section; states come last."""
    for path, kind in (*COMPUTING.items(), *DECLARING.items()):
        yield from ((kind, entry) for entry in _section(tree, path))
    for group in _section(tree, _STATES):
        yield from (("state", state) for state in group.value) if isinstance(group.value, YamlMap) else ()


def _section(tree: YamlMap, path: tuple[str, ...]) -> Iterable[YamlEntry]:
    node: YamlNode | None = tree
    for key in path:
        node = node.get(key) if isinstance(node, YamlMap) else None
    return node if isinstance(node, YamlMap) else ()
