"""Validate a tree by the schema: report what does not match, and return the tree without it."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import COMPUTED_REPETITION
from linkforge_compile.schema.registry import HEADER, accepts, linked
from linkforge_compile.schema.repetition_words import FOR_AND_WHEN, repetition_words
from linkforge_compile.schema.shapes import FREE, Shape, shapes
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.units import Quantity


def validate(tree: YamlMap, sink: Diagnostics, *, is_included: bool = False) -> YamlMap:
    """Report each node of a file that does not match the schema, and replace it by a YamlFault.

    A file needs a name unless it is included. The values of unknown keys are replaced as well, so that a misspelt
    key is not also reported as missing. A YamlFault is not validated again. Required fields of entries, references
    and units are checked by later stages.
    """
    if _is_valid(tree, is_included) and not _may_lack_section_line(tree):
        return tree
    # Imported here because importing jsonschema costs 90 ms.
    from linkforge_compile.schema.explain import report_mismatches
    from linkforge_compile.schema.section_lines import restore_sections
    from linkforge_compile.schema.state_groups import restore_groups_of_states

    restored = restore_groups_of_states(restore_sections(tree, sink), sink)
    return report_mismatches(restored, sink, is_included=is_included)


def validate_computed(node: YamlNode, key: str, shape: Shape, sink: Diagnostics, *, is_entry: bool = False) -> YamlNode:
    """Validate a map or list that an expression made, as if it were written under `key`; see `validate`.

    `is_entry` as for `repetition_words`. Its own kind and length are not checked here but, as for any computed value,
    where it is read; so are scalars.
    """
    if not isinstance(node, YamlMap | YamlList) or not shape.schema:
        return node
    if word := next(_computed_words(node, shape, is_entry=is_entry), None):
        sink.report(COMPUTED_REPETITION.at(node.span, name=word))
        return YamlFault(node.span)
    if shape.is_free_part:
        return node
    written = _with_units(node)
    if accepts(shape.schema, written):
        return node
    from linkforge_compile.schema.explain import report_computed_mismatches

    return report_computed_mismatches(node, written, key, shape.schema, sink)


def _is_valid(tree: YamlMap, is_included: bool) -> bool:
    """Whether a file has its header and the gate accepts it."""
    header = ("linkforge",) if is_included else HEADER
    return all(tree.get(name) is not None for name in header) and accepts(linked(), tree)


def _may_lack_section_line(tree: YamlMap) -> bool:
    """Whether the line of a section may be missing or indented in a valid file.

    An indented line is an entry without a value, and a frame among the joints has no child.
    """
    at_top, semantic = _empty_entries(tree), _empty_entries(tree.get("semantic"))
    sections = shapes().keys, shapes().under("semantic").keys
    if not (at_top.isdisjoint(sections[0]) and semantic.isdisjoint(sections[1])):
        return True
    joints = tree.get("joints")
    last = [entry.value for entry in joints][-1:] if isinstance(joints, YamlMap) else []
    return any(isinstance(joint, YamlMap) and "child" not in joint.entries for joint in last)


def _empty_entries(node: YamlNode | None) -> set[str]:
    """Return the names of the entries without a value in the sections of an object, except `x-` sections."""
    sections = [part.value for part in node if not part.name.startswith("x-")] if isinstance(node, YamlMap) else []
    inside = (section.entries.items() for section in sections if isinstance(section, YamlMap))
    return {name for entries in inside for name, entry in entries if is_null(entry.value)}


def _with_units(node: YamlNode) -> YamlNode:
    """Return a node with its computed quantities as text: "0.1 m"."""
    match node:
        case YamlMap():
            return YamlMap({one.name: YamlEntry(one.key, _with_units(one.value)) for one in node}, node.span)
        case YamlList():
            return YamlList(tuple(map(_with_units, node)), node.span)
        case YamlScalar(value=Quantity() as quantity):
            return YamlScalar(str(quantity), str(quantity), node.span)
    return node


def _computed_words(node: YamlNode, shape: Shape, *, is_entry: bool) -> Iterator[str]:
    """Yield each computed `for` and `when` that would repeat something had it been written out."""
    match node:
        case YamlList():
            item_shape = shape.item or (shape if shape.is_object or shape.is_for_plugins else FREE)
            for item in node:
                yield from _computed_words(item, item_shape, is_entry=True)
        case YamlMap() if shape.is_for_plugins or not shape.is_plain:
            words = frozenset() if shape.has_names else FOR_AND_WHEN
            if shape.is_for_plugins:
                words = repetition_words(node, shape, is_entry=is_entry)
            for entry in node:
                if entry.name in words:
                    yield entry.name
                yield from _computed_words(entry.value, shape.under(entry.name), is_entry=shape.is_for_plugins)
