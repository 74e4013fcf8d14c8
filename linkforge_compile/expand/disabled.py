"""What is not there because its author said so, `when` or `override`: each name with the place that takes it out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import DeletedNames, Note
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.expand.evaluate_tree import TreeEvaluator

_NAMES_ITS_JOINT = frozenset({"a frame", "a module"})
"""The titles of entries that bring a joint with them, named after themselves unless `joint` says its name."""


@dataclass(frozen=True)
class Disabled:
    """Collects the entries of one use of a file that a `when` takes out, where their names can be told."""

    names: dict[str, Note] = field(default_factory=dict)
    starts: dict[str, Note] = field(default_factory=dict)

    @property
    def removed(self) -> DeletedNames:
        return DeletedNames(self.names, self.starts)

    def add(self, key: YamlScalar, body: YamlNode, title: str, where: Span, tree: TreeEvaluator) -> None:
        """Remember an entry, whose schema has a title, that the `when` at a place takes out, and all it would bring."""
        silent = tree.silent
        name = silent.key(key)
        if name is None:
            return
        note = Note(f"'{name.text}' is disabled by 'when' here", where)
        self.names.setdefault(name.text, note)
        if title in _NAMES_ITS_JOINT:
            for joint in _joints(name.text, body, silent):
                self.names.setdefault(joint, note)
        if title == "a module":
            prefix = _text(body, "prefix", silent)
            self.starts.setdefault(f"{name.text}_" if prefix is None else prefix, note)


def _joints(name: str, body: YamlNode, tree: TreeEvaluator) -> Iterator[str]:
    joint = body.get("joint") if isinstance(body, YamlMap) else None
    said = _text(joint, "name", tree) if isinstance(joint, YamlMap) else _text(body, "joint", tree)
    yield f"{name}_joint" if said is None else said


def _text(body: YamlNode, field: str, tree: TreeEvaluator) -> str | None:
    said = body.get(field) if isinstance(body, YamlMap) else None
    key = tree.key(said) if isinstance(said, YamlScalar) else None
    return key.text if key else None
