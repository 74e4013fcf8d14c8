"""The names of expressions, where they are declared and used: parameters, variables, data, and those of `for`.

They are read in the trees as written, since the expanded ones have values in place of expressions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand import Instance
from linkforge_compile.expressions import Expression, parse_template
from linkforge_compile.load import SpecFile
from linkforge_compile.lsp.module_entries import unused_entries, used_entries
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.roots import identity
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, has_expression

SECTIONS = {"parameters": "parameter", "variables": "variable", "data": "data"}
"""The sections that declare names of expressions, and what each is called."""

_Names = Mapping[str, Occurrence]
"""The declarations of the names that are known at a place."""


def names_in(instance: Instance) -> Iterator[Occurrence]:
    """Yield the names of expressions in a use of a file, and those that it sets in its modules."""
    spec = instance.spec
    if spec is None or spec.file.is_xml:
        return
    known = {one.written: one for one in _declared(spec)}
    yield from known.values()
    for variant in spec.tree.section("variants").values():
        yield from _set(variant.value, known)
    yield from _in_node(spec.tree, known)
    for used in used_entries(instance, ""):
        if used.module.spec is not None:
            yield from _set(used.fields.get("with"), {one.written: one for one in _declared(used.module.spec)})
    for unused in unused_entries(instance, ""):
        fields = unused.entry.value
        values = fields.get("with") if isinstance(fields, YamlMap) else None
        for entry in values if isinstance(values, YamlMap) else ():
            # The file is not read, so that a name of another kind is not known to be none.
            yield _declaration("parameter", entry.key, identity(unused.path))._replace(is_declaration=False)


def _declared(spec: SpecFile) -> Iterator[Occurrence]:
    """Yield the declarations of a file and of what it includes."""
    scope = identity(spec.file.path) if spec.file.path else spec.file.name
    for section, kind in SECTIONS.items():
        for entry in spec.tree.section(section).values():
            yield _declaration(kind, entry.key, scope)


def _declaration(kind: str, key: YamlScalar, scope: str) -> Occurrence:
    return Occurrence(kind, key.text, key.text, key.span, is_declaration=True, scope=scope)


def _set(values: YamlNode | None, known: _Names) -> Iterator[Occurrence]:
    """Yield the parameters that a map of values sets."""
    for entry in values if isinstance(values, YamlMap) else ():
        declared = known.get(entry.name)
        if declared is not None and declared.kind == "parameter":
            yield declared._replace(span=entry.key.span, is_declaration=False)


def _in_node(node: YamlNode, known: _Names) -> Iterator[Occurrence]:
    """Yield the names in the expressions of a tree, and those that `for` declares in it."""
    if isinstance(node, YamlScalar):
        yield from _in_text(node, known)
    elif isinstance(node, YamlList):
        for item in node:
            yield from _in_object(item, known)
    elif isinstance(node, YamlMap):
        for entry in node:
            repeated = _repeated(entry.value)
            yield from _in_text(entry.key, {**known, **repeated} if repeated else known)
            yield from _in_object(entry.value, known)


def _in_object(node: YamlNode, known: _Names) -> Iterator[Occurrence]:
    """Yield the names in an entry or item, whose `for` computes its values without its own names."""
    repeated = _repeated(node)
    if not repeated or not isinstance(node, YamlMap):
        yield from _in_node(node, known)
        return
    yield from repeated.values()
    for entry in node.section("for").values():
        yield from _in_node(entry.value, known)
    yield from _in_node(node.without("for"), {**known, **repeated})


def _repeated(node: YamlNode) -> _Names:
    """Return the names that the `for` of an entry or item declares, which are known in it only."""
    entries: Mapping[str, YamlEntry] = node.section("for") if isinstance(node, YamlMap) else {}
    return {name: _declaration("name of for", one.key, str(one.key.span)) for name, one in entries.items()}


def _in_text(scalar: YamlScalar, known: _Names) -> Iterator[Occurrence]:
    """Yield the names that the expressions in a text use; none of a text with faults, which are reported elsewhere."""
    template = parse_template(scalar.text, scalar.span, Diagnostics()) if has_expression(scalar.text) else None
    for expression in template.parts if template else ():
        if isinstance(expression, Expression):
            used = ((known.get(name.id), expression.span(name)) for name in expression.names)
            yield from (one._replace(span=span, is_declaration=False) for one, span in used if one)
