"""What is wrong in a tree, and the entries that are all wrong in the same way because a level of names is missing."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.schema.shapes import Path, node_at
from linkforge_compile.syntax.nodes import YamlMap, is_null

_LEVEL_HINT = "; so are all entries here: is a line with a name missing above, or the indentation wrong?"


class Finding(NamedTuple):
    """A diagnostic and the path of the node that it is about, which a YamlFault replaces.

    `also` are the paths of further nodes with the same fault. `wrong_kind` identifies the schema of a scalar of the
    wrong kind, else it is 0.
    """

    diagnostic: Diagnostic
    path: Path
    also: tuple[Path, ...] = ()
    wrong_kind: int = 0


def merge_missing_levels(findings: Sequence[Finding], tree: YamlMap) -> list[Finding]:
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
    node = node_at(tree, path)
    entries = [entry for entry in node if not is_null(entry.value)] if isinstance(node, YamlMap) else []
    return count > 1 and len(entries) == count


def _merge(group: Sequence[Finding]) -> Finding:
    first, *others = group
    message = first.diagnostic.message.removesuffix(_LEVEL_HINT) + _LEVEL_HINT
    also = (*first.also, *(path for other in others for path in (other.path, *other.also)))
    return Finding(replace(first.diagnostic, message=message, fixes=()), first.path, also, first.wrong_kind)
