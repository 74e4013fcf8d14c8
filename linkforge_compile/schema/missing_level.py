"""A level of names that is missing: all that stands in a map is then wrong in the same way, and told once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

from linkforge_compile.schema.explain import Judgement
from linkforge_compile.schema.meant import Path
from linkforge_compile.syntax.nodes import YamlMap, YamlNode, is_null

_HINT = "; so are all entries here: is a line with a name missing above, or the indentation wrong?"


def told_once(judgements: Sequence[Judgement], tree: YamlMap) -> list[Judgement]:
    """Return judgements with one for each map of which every entry is of the same wrong kind, and for maps of such."""
    groups: dict[tuple[Path, int], list[Judgement]] = defaultdict(list)
    for one in sorted(judgements, key=lambda one: one.diagnostic.order):
        if one.wrong_kind:
            groups[one.path[:-1], one.wrong_kind].append(one)
    whole = {key: group for key, group in groups.items() if _is_all_of(tree, key[0], len(group))}
    above: dict[tuple[Path, int], list[Judgement]] = defaultdict(list)
    for (path, kind), group in whole.items():
        above[path[:-1], kind].append(_as_one(group))
    firsts = [_as_one(group) if _is_all_of(tree, path, len(group)) else None for (path, _), group in above.items()]
    merged = [one for first, group in zip(firsts, above.values(), strict=True) for one in ([first] if first else group)]
    gone = {id(one) for group in whole.values() for one in group}
    return [*(one for one in judgements if id(one) not in gone), *merged]


def _is_all_of(tree: YamlMap, path: Path, count: int) -> bool:
    """Whether so many entries are all that a map says, and more than one."""
    node: YamlNode | None = tree
    for key in path:
        node = node.child(key) if node else None
    said = [entry for entry in node if not is_null(entry.value)] if isinstance(node, YamlMap) else []
    return count > 1 and len(said) == count


def _as_one(group: Sequence[Judgement]) -> Judgement:
    first, *others = group
    message = first.diagnostic.message.removesuffix(_HINT) + _HINT
    also = (*first.also, *(path for other in others for path in (other.path, *other.also)))
    return Judgement(replace(first.diagnostic, message=message), first.path, also, first.wrong_kind)
