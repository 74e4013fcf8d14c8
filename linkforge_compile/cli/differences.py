"""What `linkforge diff` tells: the differences of two robots as lines for people, and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    from linkforge_compile.compare import Difference, RemovedName


class Side(NamedTuple):
    """One of the two robots: the word that names it, and what is set for it alone.

    `text` is that of what can be read once only, such as standard input; None for a file.
    """

    word: str
    parameters: Mapping[str, str]
    variant: str | None = None
    srdf: str | None = None
    text: str | None = None
    is_urdf: bool = False

    @property
    def label(self) -> str:
        """Its name in a heading, by which two settings of one spec are told apart: `arm.robot.yaml (reach=0.7m)`."""
        settings = [f"{name}={value}" for name, value in self.parameters.items()]
        settings = [*([f"variant {self.variant}"] if self.variant else []), *settings]
        settings += [self.srdf] if self.srdf else []
        return on_one_line(f"{self.word} ({', '.join(settings)})" if settings else self.word)


class Comparison(NamedTuple):
    """Two robots and what differs between them; `semantic` says whether that part was compared.

    `not_read_back` is why a spec beside a URDF was compared as written, None where there is no such spec.
    """

    before: Side
    after: Side
    tolerance: float
    semantic: bool
    not_read_back: str | None
    differences: Sequence[Difference]
    gone: Sequence[RemovedName]


def lines_of(comparison: Comparison) -> Iterator[str]:
    """Yield what differs: how much, the names that others miss, then the parts, section by section."""
    before, after = comparison.before.label, comparison.after.label
    if not comparison.differences:
        yield f"{before} and {after} are the same robot"
        return
    yield f"{before} → {after}: {_count(comparison.differences)}"
    if comparison.gone:
        yield from ("", "breaking: names that are gone, on which others may rely")
        width = max(len(name.kind) for name in comparison.gone)
        yield from (f"  {kind:{width}}  {text}" for kind, text in _gone(comparison.gone))
    for section, members in groupby(comparison.differences, key=lambda difference: difference.path[0]):
        yield from ("", section)
        for part, group in groupby(members, key=lambda difference: difference.path[1 : _DEPTH.get(section, 2)]):
            yield from _part_lines(part, list(group))


def _gone(gone: Sequence[RemovedName]) -> Iterator[tuple[str, str]]:
    """Yield the kind and names of what is gone, the interfaces of a joint in one."""
    for (kind, owner, now), names in groupby(gone, key=_owner):
        inside = [name.name.rpartition("/")[2] for name in names]
        if kind.endswith(_INTERFACE):
            yield kind, f"{owner}: {', '.join(inside)}" + (f", now of {now}" if now else "")
        else:
            yield kind, owner + (f", now {now}" if now else "")


_INTERFACE = " interface"


def _owner(name: RemovedName) -> tuple[str, str, str | None]:
    if not name.kind.endswith(_INTERFACE):
        return name.kind, name.name, name.now
    return name.kind, name.name.rpartition("/")[0], name.now.rpartition("/")[0] if name.now else None


_DEPTH = {"semantic": 3}
"""How many steps of a path lead to what stands in a line of its own."""

_SIGNS = {"added": "+", "removed": "-", "renamed": ">", "moved": ">", "changed": "~"}


def _part_lines(part: tuple[str, ...], differences: Sequence[Difference]) -> Iterator[str]:
    """Yield the lines about one part: what became of it as a whole, then what of it differs."""
    name, steps = "/".join(part), len(part) + 1
    whole = [difference for difference in differences if len(difference.path) <= steps]
    for difference in whole:
        sign = _SIGNS[difference.kind]
        yield f"  {sign} {name}: {difference.text}" if name else f"  {sign} {difference.text}"
    inner = [difference for difference in differences if len(difference.path) > steps]
    if inner and not whole:
        yield f"  ~ {name}"
    for difference in inner:
        sign = "" if difference.kind == "changed" else f"{_SIGNS[difference.kind]} "
        yield f"      {sign}{'/'.join(difference.path[steps:])}: {difference.text}"


def _count(differences: Sequence[Difference]) -> str:
    kinds = [difference.kind for difference in differences]
    return ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds), key=list(_SIGNS).index))


def json_of(comparison: Comparison) -> str:
    """Return all of it as docs/diff.schema.json says."""
    import json

    whole = {
        "version": 1,
        "before": comparison.before.word,
        "before_settings": _settings(comparison.before),
        "after": comparison.after.word,
        "after_settings": _settings(comparison.after),
        "tolerance": comparison.tolerance,
        "semantic_compared": comparison.semantic,
        "not_read_back": comparison.not_read_back,
        "same": not comparison.differences,
        "breaking": [name._asdict() for name in comparison.gone],
        "differences": [
            {
                "kind": difference.kind,
                "path": "/".join(difference.path),
                "before": difference.before,
                "after": difference.after,
                "text": difference.text,
            }
            for difference in comparison.differences
        ],
    }
    return json.dumps(whole, ensure_ascii=False, indent=2) + "\n"


def _settings(side: Side) -> dict[str, object]:
    return {"parameters": dict(side.parameters), "variant": side.variant, "srdf": side.srdf}
