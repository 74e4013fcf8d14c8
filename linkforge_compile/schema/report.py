"""Report what jsonschema finds wrong in a tree, and return the tree without it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING

from jsonschema import Draft7Validator

from linkforge_compile.diagnostics import MAX_KEPT, Diagnostics, notes_of, too_many_errors
from linkforge_compile.schema.explain import Finding, explain
from linkforge_compile.schema.gate import HEADER, plain
from linkforge_compile.schema.json_types import LinkedSchema, Schema
from linkforge_compile.schema.registry import linked
from linkforge_compile.schema.shapes import FREE, shapes
from linkforge_compile.schema.value_hints import Path
from linkforge_compile.source import SourceRef
from linkforge_compile.source.provenance import aliases_of, join_links
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, fault_of, is_null

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError

_LEVEL_HINT = "; so are all entries here: is a line with a name missing above, or the indentation wrong?"


def report_mismatches(tree: YamlMap, sink: Diagnostics, *, is_included: bool) -> YamlMap:
    """Report each node of a file that does not match the schema; return the file without them."""
    errors = (error for error in _errors(tree, is_included) if not _is_under_reserved_name(error))
    found = (finding for error in errors for finding in _explain(error, tree))
    # A hostile file has a hundred thousand errors; explaining more than are shown would take long.
    return _report(tree, list(islice(found, MAX_KEPT + 1)), sink)


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
    findings = [finding for error in errors for finding in _explain(error, shown) if len(finding.path) > 1]
    return _report(tree, findings, sink).entries[key].value


def _errors(tree: YamlMap, is_included: bool) -> Iterator[ValidationError]:
    data = {entry.name: plain(entry.value) for entry in tree}
    for name in HEADER:
        if tree.get(name) is None:
            data.pop(name, None)
    return _validator(is_included).iter_errors(data)


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


def _explain(error: ValidationError, tree: YamlMap) -> Iterator[Finding]:
    yield from explain(error, tree)
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
    findings = _merge_missing_levels(findings, tree)
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
            return fault_of(node)
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


# A missing level of names: every entry of a map is then wrong in the same way, and reported once


def _merge_missing_levels(findings: Sequence[Finding], tree: YamlMap) -> list[Finding]:
    """Merge the findings on all entries of a map that are of the same wrong kind, and those on all maps of such."""
    groups: dict[tuple[Path, int], list[Finding]] = defaultdict(list)
    for finding in sorted(findings, key=lambda one: one.diagnostic.order):
        if finding.wrong_kind:
            groups[finding.path[:-1], finding.wrong_kind].append(finding)
    complete = {key: group for key, group in groups.items() if _is_every_entry(tree, key[0], len(group))}
    above: dict[tuple[Path, int], list[Finding]] = defaultdict(list)
    for (path, kind), group in complete.items():
        above[path[:-1], kind].append(_merge(group))
    merged: list[Finding] = []
    for (path, _), group in above.items():
        merged += [_merge(group)] if _is_every_entry(tree, path, len(group)) else group
    replaced = {id(finding) for group in complete.values() for finding in group}
    return [*(finding for finding in findings if id(finding) not in replaced), *merged]


def _is_every_entry(tree: YamlMap, path: Path, count: int) -> bool:
    """Whether a map has this many entries with a value, and more than one."""
    node: YamlNode | None = tree
    for key in path:
        node = node.child(key) if node else None
    entries = [entry for entry in node if not is_null(entry.value)] if isinstance(node, YamlMap) else []
    return count > 1 and len(entries) == count


def _merge(group: Sequence[Finding]) -> Finding:
    first, *others = group
    message = first.diagnostic.message.removesuffix(_LEVEL_HINT) + _LEVEL_HINT
    also = (*first.also, *(path for other in others for path in (other.path, *other.also)))
    return Finding(replace(first.diagnostic, message=message), first.path, also, first.wrong_kind)
