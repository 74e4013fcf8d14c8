"""Every place where a spec and its modules write a name: where it is declared and where it is used.

What the name of a part names is marked in the schemas; the names themselves are read in the expanded trees, whose
places lead to the texts. What these lack, since a `when` leaves it out or something replaces it, is read as written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from linkforge_compile.analysis import Analysis
from linkforge_compile.core.models.controller import MANAGER
from linkforge_compile.editor.completions import KEYS, NAMES, marked_names
from linkforge_compile.expand import Instance
from linkforge_compile.expand.instance import joint_name_of
from linkforge_compile.lsp.expression_names import SECTIONS, names_in
from linkforge_compile.lsp.module_entries import used_entries
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.unconditional import unconditional_tree
from linkforge_compile.roots import identity
from linkforge_compile.schema.json_schema import Schema, branches, mapping, reference
from linkforge_compile.schema.registry import definitions
from linkforge_compile.source import Position, Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

DECLARING = {
    ("links",): "link",
    ("joints",): "joint",
    ("mount",): "joint",
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


COMPUTING = {("modules",): "module", **{(section,): kind for section, kind in SECTIONS.items()}}
"""The sections of a file that only compute, and what their keys declare."""


class Occurrences:
    """The occurrences of an analysis, by name and by place."""

    def __init__(self, analysis: Analysis) -> None:
        self.analysis = analysis
        found = _in_instance(analysis.instance, "") if analysis.instance else ()
        self.all = tuple(_resolved(dict.fromkeys(found)))

    def at(self, path: str, position: Position) -> tuple[Occurrence, ...]:
        """Return those at a place in the file with a real path, the innermost first.

        A name in an expression hides that of the part whose name the expression makes.
        """
        here = (one for one in self.all if _is_in(one.span, path) and one.span.start <= position <= one.span.end)

        def size(one: Occurrence) -> tuple[int, int, int]:
            return one.span.end.line - one.span.line, len(one.span.text or ""), len(one.suffix)

        found = tuple(sorted(here, key=size))
        return tuple(one for one in found if one.scope) or found

    def of(self, names: Iterable[Occurrence]) -> tuple[Occurrence, ...]:
        """Return all occurrences of what the given ones name."""
        wanted = {one.named for one in names}
        return tuple(one for one in self.all if one.named in wanted)


def _resolved(found: Iterable[Occurrence]) -> Iterator[Occurrence]:
    """Yield occurrences without those of kinds that have no such part, where a place may name one of several kinds."""
    found = tuple(found)
    declared = {one.named for one in found if one.is_declaration}
    known = {(str(one.span), one.name) for one in found if one.named in declared}
    for one in found:
        if one.named in declared or (str(one.span), one.name) not in known:
            yield one


def _is_in(span: Span, path: str) -> bool:
    return span.file.path is not None and identity(span.file.path) == path


def _in_instance(instance: Instance, outer: str) -> Iterator[Occurrence]:
    """Yield the occurrences in a use of a file, whose entry is written in the file around it, and in its modules."""
    prefix = outer + instance.prefix
    yield from names_in(instance)
    computed = tuple(_computed(instance, prefix))
    yield from computed
    places = {one.span for one in computed}
    yield from (one for one in _written(instance, prefix) if one.span not in places and not one.is_computed)
    if (tree := unconditional_tree(instance)) is not None:
        yield from _Walker(prefix).in_robot(tree)
    for module in instance.modules:
        yield from _in_instance(module, prefix)


def _computed(instance: Instance, prefix: str) -> Iterator[Occurrence]:
    """Yield the occurrences in the expanded tree of a use of a file, and in the entries of its modules."""
    walker = _Walker(prefix)
    if instance.tree is not None:
        yield from walker.in_robot(instance.tree)
        for override in instance.overrides:
            yield from walker.in_override(override)
        for one in instance.references:
            yield Occurrence(one.kind, prefix + one.name, one.name, one.where.span)
    for module in instance.modules:
        if module.entry is not None and isinstance(module.entry.node, YamlMap):
            if isinstance(module.entry.key, YamlScalar):
                yield from walker.in_entry(module.name, module.entry.key.span, module.entry.node)
            else:
                yield from walker.references(module.entry.node, definitions()["module"])


def _written(instance: Instance, prefix: str) -> Iterator[Occurrence]:
    """Yield the occurrences in a use of a file as it is written, with those in what its `when`s leave out."""
    if instance.spec is None or instance.spec.file.is_xml:
        return
    walker, tree = _Walker(prefix), instance.spec.tree
    yield from walker.in_robot(tree.without("modules"))
    for entry in tree.section("modules").values():
        if isinstance(entry.value, YamlMap):
            yield from walker.in_entry(entry.name, entry.key.span, entry.value.without("with", "override"))
    for used in used_entries(instance, prefix):
        if used.override is not None:
            yield from _Walker(used.prefix).in_override(used.override)


class _Walker:
    """Finds names in one use of a file, whose names get a prefix."""

    def __init__(self, prefix: str) -> None:
        self._prefix = prefix

    def occurrence(self, kind: str, node: YamlScalar, *, is_declaration: bool = False) -> Occurrence:
        text = node.span.text or ""
        # The long form of a frame names its joint where the frame is named.
        is_made = is_declaration and node.text == f"{text}_joint"
        written, suffix = (text, "_joint") if is_made else (node.text, "")
        return Occurrence(kind, self._prefix + node.text, written, node.span, is_declaration, suffix)

    def named_joint(self, key: str, place: Span, entry: YamlMap) -> Occurrence:
        """Return the joint of a frame or module, which its key, computed, names unless `joint` does."""
        name = joint_name_of(key, entry)
        joint = entry.get("joint")
        joint = joint.get("name") if isinstance(joint, YamlMap) else joint
        if isinstance(joint, YamlScalar) and joint.value is not None:
            return self.occurrence("joint", joint, is_declaration=True)
        return Occurrence("joint", self._prefix + name, key, place, True, name.removeprefix(key))

    def in_robot(self, tree: YamlMap) -> Iterator[Occurrence]:
        """Yield the names in a file without its modules."""
        yield from self.declarations(tree)
        yield from self.references(tree, definitions()["robot"])

    def in_override(self, tree: YamlMap) -> Iterator[Occurrence]:
        """Yield the names in an override, without those in its overrides of nested modules."""
        yield from (one._replace(is_declaration=False) for one in self.declarations(tree))
        yield from self.references(tree.without("modules"), definitions()["robot"])
        for entry in tree.section("modules").values():
            yield Occurrence("module", self._prefix + entry.name, entry.name, entry.key.span)
            if isinstance(entry.value, YamlMap):
                yield from self.references(entry.value.without("with", "override"), definitions()["module"])

    def in_entry(self, name: str, place: Span, entry: YamlMap) -> Iterator[Occurrence]:
        """Yield the names in the entry of a module: its own, that of its joint, and its parent."""
        yield Occurrence("module", self._prefix + name, name, place, is_declaration=True)
        yield from self.references(entry, definitions()["module"])
        joint = self.named_joint(name, place, entry)
        if entry.get("parent") or not joint.suffix:
            yield joint

    def declarations(self, tree: YamlMap) -> Iterator[Occurrence]:
        """Yield the names that the sections of a file declare."""
        for path, kind in DECLARING.items():
            for entry in _section(tree, path):
                if kind == "controller" and entry.name == MANAGER:
                    continue
                yield self.occurrence(kind, entry.key, is_declaration=True)
                if kind == "virtual joint":
                    yield self.occurrence("joint", entry.key, is_declaration=True)
                if path == ("frames",):
                    fields = entry.value if isinstance(entry.value, YamlMap) else YamlMap({}, entry.value.span)
                    yield self.named_joint(entry.key.text, entry.key.span, fields)
        for group in _section(tree, _STATES):
            for state in group.value if isinstance(group.value, YamlMap) else ():
                yield self._state(group.name, state.key)._replace(is_declaration=True)
                yield from self._states_of_groups(state.value)

    def _states_of_groups(self, state: YamlNode) -> Iterator[Occurrence]:
        """Yield the groups, and their states, of which a state consists."""
        for entry in state if isinstance(state, YamlMap) else ():
            if isinstance(entry.value, YamlScalar) and isinstance(entry.value.value, str):
                yield self.occurrence("group", entry.key)
                yield self._state(entry.name, entry.value)

    def _state(self, group: str, name: YamlScalar) -> Occurrence:
        return Occurrence("state", f"{self._prefix}{group}/{self._prefix}{name.text}", name.text, name.span)

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
