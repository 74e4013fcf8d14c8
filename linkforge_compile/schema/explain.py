"""Report what jsonschema finds wrong in a tree, and return the tree without it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING

from jsonschema import Draft7Validator

from linkforge_compile.diagnostics import MAX_KEPT, Diagnostic, Diagnostics, notes_of, too_many_errors
from linkforge_compile.diagnostics.codes import schema as codes
from linkforge_compile.diagnostics.codes.syntax import TAB_INDENTATION, XACRO_EXPRESSION
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.findings import Finding, merge_missing_levels
from linkforge_compile.schema.hint_rules import value_hint, word_hint
from linkforge_compile.schema.hints import renamed_key
from linkforge_compile.schema.json_schema import LinkedSchema, Schema, linked_part, mapping
from linkforge_compile.schema.list_to_map import under_name
from linkforge_compile.schema.misplaced_keys import find_like_space, group_unknown_keys
from linkforge_compile.schema.number_texts import is_row
from linkforge_compile.schema.registry import HEADER, linked, plain
from linkforge_compile.schema.shapes import (
    FREE,
    Path,
    SchemaMismatch,
    Shape,
    expected,
    field,
    find_branch,
    found,
    is_text,
    node_at,
    shape_at,
    shape_of,
    shapes,
    shortened,
    words_of,
)
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import code_point
from linkforge_compile.source.provenance import aliases_of, join_links
from linkforge_compile.syntax.entries import STUCK
from linkforge_compile.syntax.fixes import replace_like_spaces, space_after_colon, space_after_dash
from linkforge_compile.syntax.nodes import (
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    is_null,
    to_fault,
    xacro_facts,
)

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError


def report_mismatches(tree: YamlMap, sink: Diagnostics, *, is_included: bool) -> YamlMap:
    """Report each node of a file that does not match the schema; return the file without them."""
    absent = {name for name in HEADER if tree.get(name) is None}
    data = {entry.name: plain(entry.value) for entry in tree if entry.name not in absent}
    errors = (error for error in _validator(is_included).iter_errors(data) if not _is_under_reserved_name(error))
    # A hostile file has a hundred thousand errors; explaining more than are shown would take long.
    return _report(tree, list(islice(_findings(errors, tree), MAX_KEPT + 1)), sink)


def report_computed_mismatches(
    node: YamlNode, written: YamlNode, key: str, schema: LinkedSchema, sink: Diagnostics
) -> YamlNode:
    """Report what is wrong in a map or list that an expression made under a key; return it without that.

    `written` is the node with its quantities as text, as the schema expects them.
    """
    name = YamlScalar(key, key, node.span)
    tree = YamlMap({key: YamlEntry(name, node)}, node.span)
    shown = YamlMap({key: YamlEntry(name, written)}, node.span)
    whole: Schema = {"type": "object", "properties": {key: schema}}
    errors = Draft7Validator(whole).iter_errors({key: plain(written)})
    findings = [finding for finding in _findings(errors, shown) if len(finding.path) > 1]
    return _report(tree, findings, sink).entries[key].value


@cache
def _validator(is_included: bool) -> Draft7Validator:
    if is_included:
        return Draft7Validator(linked())
    root = LinkedSchema(linked())
    root["required"] = [*HEADER]
    return Draft7Validator(root)


def _is_under_reserved_name(error: ValidationError) -> bool:
    """Whether an error is in an entry that is named `for`; expanding reports that name, and nothing else in it."""
    shape = shapes()
    for step in error.absolute_path:
        if isinstance(step, int):
            shape = shape.item or FREE
        elif shape.reserves(step):
            return True
        else:
            shape = shape.under(step)
    return False


def _findings(errors: Iterable[ValidationError], tree: YamlMap) -> Iterator[Finding]:
    for error in errors:
        yield from _explain(error, tree)
        _break_cycles(error)


def _break_cycles(error: ValidationError) -> None:
    """Detach an error from those in its context; the garbage collector is paused and would not free them."""
    for inner in error.context or ():
        inner.parent = None
        _break_cycles(inner)


def _report(tree: YamlMap, findings: Sequence[Finding], sink: Diagnostics) -> YamlMap:
    """Report the findings in the order of the file; return the tree without their nodes."""
    if not findings:
        return tree
    findings = merge_missing_levels(findings, tree)
    found = [(one.diagnostic, tuple(join_links(aliases_of(SourceRef(tree), *one.path)) or ())) for one in findings]
    # If several aliases of one anchor do not match, the sink keeps the first; jsonschema's order is that of a set.
    for diagnostic, aliases in sorted(found, key=lambda one: (one[0].order, [alias.span.start for alias in one[1]])):
        notes = (*diagnostic.notes, *notes_of(aliases))
        sink.report(replace(diagnostic, notes=notes) if aliases else diagnostic)
    if sum(1 + len(finding.also) for finding in findings) > MAX_KEPT:
        raise too_many_errors(findings[-1].diagnostic.span)
    return _prune(tree, findings)


def _prune(tree: YamlMap, findings: Iterable[Finding]) -> YamlMap:
    """Replace the nodes of the findings by faults."""
    faulty = {path for finding in findings for path in (finding.path, *finding.also)}
    touched = {path[:length] for path in faulty for length in range(len(path) + 1)}

    def prune(node: YamlNode, path: Path) -> YamlNode:
        if path in faulty:
            return to_fault(node)
        if path not in touched:
            return node
        if isinstance(node, YamlList):
            return YamlList(tuple(prune(item, (*path, i)) for i, item in enumerate(node)), node.span)
        return prune_map(node, path) if isinstance(node, YamlMap) else node

    def prune_map(node: YamlMap, path: Path) -> YamlMap:
        entries = {entry.name: YamlEntry(entry.key, prune(entry.value, (*path, entry.name))) for entry in node}
        return YamlMap(entries, node.span)

    if () in faulty:
        faulty |= {(entry.name,) for entry in tree if entry.name not in HEADER}
        touched |= faulty
    return prune_map(tree, ())


_MOST_COMPARED = 100
"""How many unknown keys are compared with a missing key; a hostile file has a hundred thousand."""


def _explain(error: ValidationError, tree: YamlMap) -> Iterator[Finding]:
    """Yield the findings of one error; none for an empty field and for what the reader has reported."""
    path = tuple(error.absolute_path)
    node = node_at(tree, path)
    assert node is not None, "jsonschema reports only what is in the tree"
    if isinstance(node, YamlFault) or (is_null(node) and not isinstance(path[-1], int)):
        return
    if nameless := _object_without_name(tree, path):
        yield nameless
        return
    mismatch = SchemaMismatch(node, path, mapping(error.schema), tree)
    branch = None if error.validator != "anyOf" or is_text(node) else find_branch(mismatch.schema, node)
    if branch is not None:
        for inner in error.context or ():
            if inner.schema_path[0] == branch:
                yield from _explain(inner, tree)
    elif isinstance(node, YamlScalar) and _lacks_space(node, mismatch.schema):
        yield Finding(space_after_colon(node.span, node.text), path)
    elif isinstance(node, YamlScalar) and (facts := xacro_facts(node.text)):
        for one in facts:
            yield Finding(XACRO_EXPRESSION.at(node.span, text=one["text"], ours=one["ours"]), path)
    else:
        yield from _EXPLAIN[str(error.validator)](mismatch)


def _lacks_space(node: YamlScalar, schema: Schema) -> bool:
    """Whether a text is a key and its value without a space, in place of an object that has the key."""
    key, _, value = node.text.partition(":")
    shape = shape_of(linked_part(schema))
    is_stuck = STUCK.fullmatch(node.text) and node.text == node.span.text and not value.startswith("//")
    return bool(is_stuck) and (shape.has_names or key in shape.keys)


def _unknown_keys(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    for entries, hint in group_unknown_keys(node, schema) if isinstance(node, YamlMap) else ():
        first, *others = entries
        hinted = f"; {hint.words}" if hint.words else ""
        facts = {"name": first.name, "owner": schema["title"], "hint": hinted}
        fault = codes.UNKNOWN_KEY.at(first.key.span, near=hint.near, notes=(), **facts)
        fault = fault.with_fix(*hint.fixes)
        if new := renamed_key(str(schema["title"]), first.name):
            fault = fault.replacing(first.name, new, is_safe=True)
        if any(mismatch.node.child(edit.text) for fix in fault.fixes for edit in fix.edits):
            fault = replace(fault, fixes=())  # the key would be written twice
        if space_like := find_like_space(first):
            fault = TAB_INDENTATION.at(space_like, found=f"{code_point(space_like.text or '')}, which looks like one")
            fault = fault.with_fix(replace_like_spaces(space_like.file, [entry.key.span.line for entry in entries]))
        if _is_list_without_spaces(mismatch):
            fault = space_after_dash(first.key.span, first.name)
        yield Finding(fault, (*path, first.name), tuple((*path, other.name) for other in others))


def _is_list_without_spaces(mismatch: SchemaMismatch) -> bool:
    """Whether a map in place of a list has only keys such as `-box`."""
    node, shape = mismatch.node, shape_at(mismatch.path)
    is_stuck = isinstance(node, YamlMap) and all(
        entry.name.startswith("-") and entry.name[1:] in shape.keys for entry in node
    )
    return is_stuck and shape.item is not None


def _missing_keys(mismatch: SchemaMismatch) -> Iterator[Finding]:
    """Report all missing keys; the error does not name its own, and the sink drops repeated diagnostics."""
    node, path, schema, _ = mismatch
    required = schema["required"]
    if not isinstance(node, YamlMap) or not isinstance(required, list):
        return
    first = next((entry.key.span for entry in node), node.span)
    known = mapping(schema["properties"])
    unknown = [entry for entry in node if entry.name not in known]
    for name in map(str, required):
        # A misspelt key, or one in a map that should not be there, is reported as unknown.
        is_reported = any(
            entry.value.child(name) or nearest(entry.name, known) == name for entry in unknown[:_MOST_COMPARED]
        )
        if node.get(name) is None and not is_reported:
            fault = _missing_version(first) if name == "linkforge" else codes.MISSING_NAME.at(first)
            yield Finding(fault, (*path, name))


def _missing_version(first: Span) -> Diagnostic:
    """Return the error for a file without its version, at its first key."""
    fault, start = codes.MISSING_VERSION.at(first), Span(first.file, *first.start, *first.start)
    fix = Fix("write 'linkforge: 1'", (Edit(start, f"linkforge: 1{first.file.newline}"),), is_safe=True)
    return fault.with_fix(fix) if first.column == 1 else fault


def _other_version(mismatch: SchemaMismatch) -> Iterator[Finding]:
    yield Finding(codes.OTHER_VERSION.at(mismatch.node.span, found=found(mismatch.node)), mismatch.path)


def _wrong_word(mismatch: SchemaMismatch) -> Iterator[Finding]:
    """Report a text that is none of the words; the keyword `type` reports other values."""
    node, path, schema, _ = mismatch
    if isinstance(node, YamlScalar) and isinstance(node.value, str):
        words = words_of(schema)
        hint = word_hint(mismatch, words)
        facts = {"field": field(path), "expected": expected(schema), "name": shortened(node.text), "hint": hint.ending}
        fault = codes.UNKNOWN_WORD.at(node.span, near=() if hint.ending else words, notes=(), **facts)
        yield Finding(fault.with_fix(hint.fix(node.span)), path)


def _wrong_kind(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    hint = value_hint(mismatch)
    actual = f"{found(node)}{hint.ending}"
    fault = codes.WRONG_KIND.at(node.span, field=field(path), expected=expected(schema), found=actual)
    yield Finding(
        fault.with_fix(hint.fix(node.span)), path, wrong_kind=id(schema) if isinstance(node, YamlScalar) else 0
    )


def _no_branch(mismatch: SchemaMismatch) -> Iterator[Finding]:
    word = is_text(mismatch.node) and not is_row(mismatch.node) and words_of(mismatch.schema)
    yield from (_wrong_word if word else _wrong_kind)(mismatch)


def _wrong_length(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    # A row of numbers without commas is reported at its item.
    if isinstance(node, YamlList) and not any(map(is_row, node)):
        hint = value_hint(mismatch)
        actual = f"{len(node)}{hint.ending}"
        fault = codes.WRONG_LENGTH.at(node.span, field=field(path), expected=expected(schema), found=actual)
        yield Finding(fault.with_fix(hint.fix(node.span)), path)


def _object_without_name(tree: YamlMap, path: Path) -> Finding | None:
    """Report an object in place of a map of such objects by name, as the only error in it."""
    node, shape = tree, shapes()
    # A node that an expression made is not in a file.
    for length, key in enumerate(path if "linkforge" in tree.entries else ()):
        entry = shape.under(str(key))
        if shape.has_names and _is_single_object(node, entry):
            field, first = path[length - 1], next(iter(node))
            known = next(one for one in node if one.name in entry.keys)
            name = "NAME" if first is known else first.name
            actual = f"the keys of a single one; write '{field}: {{{name}: {{{known.name}: …}}}}'"
            fault = codes.WRONG_KIND.at(known.key.span, field=f"'{field}'", expected=shape.title, found=actual)
            return Finding(fault.with_fix(under_name(node)), path[:length])
        inner = node.child(key)
        if not isinstance(inner, YamlMap):
            return None
        node, shape = inner, entry
    return None


def _is_single_object(node: YamlMap, shape: Shape) -> bool:
    """Whether a map has only keys of an object, apart from a first one without a value that may be its name."""
    first = next(iter(node), None)
    # The keys first: `all` stops early for a map with a hundred thousand names.
    has_keys = all(entry.name in shape.keys or (entry is first and is_null(entry.value)) for entry in node)
    return has_keys and not all(is_null(entry.value) or isinstance(entry.value, YamlMap) for entry in node)


_EXPLAIN: dict[str, Callable[[SchemaMismatch], Iterator[Finding]]] = {
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
