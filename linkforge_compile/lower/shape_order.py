"""The order of a link's shapes: that of its keys, or what its `shape_order` says."""

from __future__ import annotations

from collections.abc import Sequence

from linkforge_compile.core.models.shape_order import COLLISION, KINDS, PAIRS, VISUAL, grouped, in_pairs
from linkforge_compile.diagnostics import notes_of
from linkforge_compile.diagnostics.codes.model import SHAPE_ORDER_COUNT, UNKNOWN_CHOICE, WRONG_KIND
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.quantities import found
from linkforge_compile.source import SourceRef
from linkforge_compile.source.provenance import join_links, overrides_of
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlScalar

_EXPECTED = f"'{PAIRS}' or a list of the words '{VISUAL}' and '{COLLISION}'"


def lower_shape_order(
    link: Fields, visuals: Sequence[object | None], collisions: Sequence[object | None]
) -> tuple[str, ...]:
    """Return the kinds of a link's shapes as they are written out, () where that goes without saying.

    None among the shapes is one that is lost. What is faulty is told, and leaves the order of the keys.
    """
    counts = {VISUAL: len(visuals), COLLISION: len(collisions)}
    keys = (entry.name for entry in link.node if entry.name in KINDS)
    kinds = [kind for kind in dict.fromkeys((*keys, *KINDS)) for _ in range(counts[kind])]
    # Of a faulty link nobody knows how many shapes it was to have.
    is_whole = not link.is_faulty and None not in (*visuals, *collisions)
    order = tuple(_said(link, kinds, is_whole=is_whole) or kinds)
    return () if order[:1] == (VISUAL,) and order == grouped(order) else order


def _said(link: Fields, kinds: Sequence[str], *, is_whole: bool) -> Sequence[str] | None:
    """Return the order that `shape_order` gives to these kinds, None where it says none."""
    node = link.node.get("shape_order")
    match node:
        case None | YamlFault():
            return None
        case YamlScalar() if node.text == PAIRS:
            return in_pairs(kinds)
        case YamlList():
            return _listed(link, node, kinds) if is_whole else None
    link.tell(WRONG_KIND, node, field="shape_order", expected=_EXPECTED, found=found(node))
    return None


def _listed(link: Fields, node: YamlList, kinds: Sequence[str]) -> Sequence[str] | None:
    words = [link.text_at(item, "shape_order") for item in node]
    for item, word in zip(node, words, strict=True):
        if word is not None and word not in KINDS:
            link.tell(UNKNOWN_CHOICE, item, near=KINDS, field="shape_order", choices=", ".join(KINDS), name=word)
    listed = [word for word in words if word in KINDS]
    if len(listed) < len(words):
        return None
    if sorted(listed) == sorted(kinds):
        return listed
    shapes = [said for kind in KINDS if (said := link.node.get(kind))]
    overrides = overrides_of((change for written in (link.node, *shapes) for change in written.span.changes), node.span)
    facts = {"owner": link.title, "expected": _counted(kinds), "found": _counted(listed)}
    notes = notes_of(join_links(overrides))
    link.sink.report(SHAPE_ORDER_COUNT.at(SourceRef(node, None, link.trail), notes=notes, **facts))
    return None


def _counted(kinds: Sequence[str]) -> str:
    counts = {kind: kinds.count(kind) for kind in KINDS}
    return " and ".join(f"{count} {kind}{'' if count == 1 else 's'}" for kind, count in counts.items())
