"""All that is wrong with the shape of a tree, told, and the tree without it: entered by faulty files only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING

from jsonschema import Draft7Validator

from linkforge_compile.diagnostics import MAX_TOLD, Diagnostics, brought_in_at, too_many_errors
from linkforge_compile.schema.explain import Judgement, explain
from linkforge_compile.schema.gate import HEADER, plain
from linkforge_compile.schema.json_types import LinkedSchema, Schema
from linkforge_compile.schema.missing_level import told_once
from linkforge_compile.schema.registry import linked
from linkforge_compile.schema.shapes import FREE, shape_of
from linkforge_compile.schema.value_hints import Path
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, fault_of

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError


def without_faults(tree: YamlMap, sink: Diagnostics, *, is_included: bool) -> YamlMap:
    """Report every place where a file is not shaped as the language; return it without them."""
    errors = (error for error in _errors(tree, is_included) if not _is_in_reserved_name(error))
    found = (judgement for error in errors for judgement in _explained(error, tree))
    # Each is explained with all that is near it: of the hundred thousand faults of a hostile file, those that are told.
    judgements = list(islice(found, MAX_TOLD + 1))
    return _told(tree, judgements, sink)


def computed_without_faults(
    node: YamlNode, written: YamlNode, key: str, schema: LinkedSchema, sink: Diagnostics
) -> YamlNode:
    """Report what is wrong in a map or list that an expression made under a key; return it without that.

    `written` is it with its quantities as a person writes them.
    """
    name = YamlScalar(key, key, node.span)
    tree = YamlMap({key: YamlEntry(name, node)}, node.span)
    shown = YamlMap({key: YamlEntry(name, written)}, node.span)
    whole: Schema = {"type": "object", "properties": {key: schema}}
    errors = Draft7Validator(whole).iter_errors({key: plain(shown.entries[key].value)})
    judgements = [one for error in errors for one in _explained(error, shown) if len(one.path) > 1]
    return _told(tree, judgements, sink).entries[key].value


def _explained(error: ValidationError, tree: YamlMap) -> Iterator[Judgement]:
    yield from explain(error, tree)
    _let_go(error)


def _let_go(error: ValidationError) -> None:
    """Detach an error from those that follow it: they refer to one another while the garbage collector is paused."""
    for inner in error.context or ():
        inner.parent = None
        _let_go(inner)


def _told(tree: YamlMap, judgements: Sequence[Judgement], sink: Diagnostics) -> YamlMap:
    """Report what was found; return the tree without what it is about."""
    if not judgements:
        return tree
    judgements = told_once(judgements, tree)
    found = [(one.diagnostic, SourceRef(tree).brought_in(*one.path)) for one in judgements]
    # Where several uses do not fit one anchor, the sink keeps the first: of jsonschema, they come as a set has them.
    for told, places in sorted(found, key=lambda one: (one[0].order, [place.start for place in one[1]])):
        sink.report(replace(told, notes=(*told.notes, *brought_in_at(places))) if places else told)
    if sum(1 + len(judgement.also) for judgement in judgements) > MAX_TOLD:
        raise too_many_errors(judgements[-1].diagnostic.span)
    return _pruned(tree, judgements)


@cache
def _validator(is_included: bool) -> Draft7Validator:
    if is_included:
        return Draft7Validator(linked())
    root = LinkedSchema(linked())
    root["required"] = [*HEADER]
    return Draft7Validator(root)


def _errors(tree: YamlMap, is_included: bool) -> Iterator[ValidationError]:
    data = {entry.name: plain(entry.value) for entry in tree}
    for name in HEADER:
        if tree.get(name) is None:
            data.pop(name, None)
    return _validator(is_included).iter_errors(data)


def _is_in_reserved_name(error: ValidationError) -> bool:
    """Whether an error lies in what has `for` as its name: whoever reads the words tells of that, and it is all."""
    shape = shape_of(linked())
    for step in error.absolute_path:
        if isinstance(step, int):
            shape = shape.item or FREE
        elif shape.reserves(step):
            return True
        else:
            shape = shape.under(step)
    return False


def _pruned(tree: YamlMap, judgements: Iterable[Judgement]) -> YamlMap:
    faulty = {path for judgement in judgements for path in (judgement.path, *judgement.also)}
    touched = {path[:length] for path in faulty for length in range(len(path) + 1)}

    def pruned(node: YamlNode, path: Path) -> YamlNode:
        if path in faulty:
            return fault_of(node)
        if path not in touched:
            return node
        if isinstance(node, YamlList):
            return YamlList(tuple(pruned(item, (*path, i)) for i, item in enumerate(node)), node.span)
        return pruned_map(node, path) if isinstance(node, YamlMap) else node

    def pruned_map(node: YamlMap, path: Path) -> YamlMap:
        entries = {entry.name: YamlEntry(entry.key, pruned(entry.value, (*path, entry.name))) for entry in node}
        return YamlMap(entries, node.span)

    if () in faulty:
        faulty |= {(entry.name,) for entry in tree if entry.name not in HEADER}
        touched |= faulty
    return pruned_map(tree, ())
