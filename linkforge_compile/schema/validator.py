"""Validate the shape of a tree by the schema: report what does not fit, and return the tree without it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.schema.gate import accepts
from linkforge_compile.schema.registry import linked
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.units import Quantity

if TYPE_CHECKING:
    from linkforge_compile.schema.shapes import Shape

HEADER = ("linkforge", "name")
"""The keys that every file says; an included one says the first only."""


def validate(tree: YamlMap, sink: Diagnostics, *, is_included: bool = False) -> YamlMap:
    """Report every place where the tree is not shaped as the language; return it without them.

    A file that is included says no name of its own, any other must.
    Faulty nodes become YamlFault, the values of unknown keys too, so that what an object seems to lack and holds
    misspelt is not told twice. What was YamlFault before is not judged.
    What is missing inside an entry, names, and the units of quantities are for later stages to judge.
    """
    if _is_right(tree, is_included) and not _may_lack_a_line(tree):
        return tree
    # Only what the gate does not accept needs jsonschema, which takes 90 ms to import, and the words for its errors.
    from linkforge_compile.schema.faults import without_faults
    from linkforge_compile.schema.section_lines import with_sections_restored

    return without_faults(with_sections_restored(tree, sink), sink, is_included=is_included)


def validate_computed(node: YamlNode, key: str, shape: Shape, sink: Diagnostics) -> YamlNode:
    """Return a map or list that an expression made, judged as if it were written out under `key`; see `validate`.

    Whether it is itself of the kind and length that stands there, its reader judges, as of any computed value.
    """
    written = _with_units(node)
    if accepts(shape.schema, written):
        return node
    from linkforge_compile.schema.faults import computed_without_faults

    return computed_without_faults(node, written, key, shape.schema, sink)


def _is_right(tree: YamlMap, is_included: bool) -> bool:
    """Whether a file has its header and the gate accepts it; `faults` finds what is wrong with any other."""
    header = ("linkforge",) if is_included else HEADER
    return all(tree.get(name) is not None for name in header) and accepts(linked(), tree)


def _may_lack_a_line(tree: YamlMap) -> bool:
    """Whether a file may have lost the line of a section, though it is shaped as the language.

    A line that is indented is an entry without a value, and a frame in the place of a joint has no child.
    """
    at_top, semantic = _unsaid_in_sections(tree), _unsaid_in_sections(tree.get("semantic"))
    if at_top or semantic:
        from linkforge_compile.schema.shapes import shapes

        if not (at_top.isdisjoint(shapes().keys) and semantic.isdisjoint(shapes().under("semantic").keys)):
            return True
    joints = tree.get("joints")
    last = [entry.value for entry in joints][-1:] if isinstance(joints, YamlMap) else []
    return any(isinstance(said, YamlMap) and "child" not in said.entries for said in last)


def _unsaid_in_sections(node: YamlNode | None) -> set[str]:
    """Return the names of the entries without a value in the sections of an object, but not in the author's own."""
    sections = [part.value for part in node if not part.name.startswith("x-")] if isinstance(node, YamlMap) else []
    inside = (section.entries.items() for section in sections if isinstance(section, YamlMap))
    return {name for entries in inside for name, entry in entries if is_null(entry.value)}


def _with_units(node: YamlNode) -> YamlNode:
    """Return a node with its computed quantities as a person writes them: "0.1 m"."""
    match node:
        case YamlMap():
            return YamlMap({one.name: YamlEntry(one.key, _with_units(one.value)) for one in node}, node.span)
        case YamlList():
            return YamlList(tuple(map(_with_units, node)), node.span)
        case YamlScalar(value=Quantity() as quantity):
            return YamlScalar(str(quantity), str(quantity), node.span)
    return node
