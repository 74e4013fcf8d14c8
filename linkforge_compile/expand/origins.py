"""Where values come from: what gave each name its value, what that beat, and where a value was written in the end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.values import describe
from linkforge_compile.expressions import FAULT, Scope, Template, forgotten_expression, handed_on
from linkforge_compile.source import Key, Origin, TracedSpan
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression

if TYPE_CHECKING:
    from collections.abc import Mapping

Path: TypeAlias = tuple[str | int, ...]

_AXES = {"x": 0, "y": 1, "z": 2}
_MOST_STEPS = 10_000
_LONGEST_TEXT = 60


class Evaluation(Protocol):
    """What following a value back needs of the evaluator that computed it."""

    @property
    def scope(self) -> Scope: ...

    @property
    def settings(self) -> Mapping[str, Setting]: ...

    def scope_of(self, scalar: YamlScalar) -> Scope: ...

    def template(self, scalar: YamlScalar, sink: Diagnostics) -> Template | None: ...


@dataclass(frozen=True, eq=False)
class Setting:
    """What gives a name its value.

    `by` says who: "with", "the default". The value is the part at `path` of what `node` says, which `tree` computes;
    `tree` is None where no `$(` is an expression. `is_made` where the value itself stands nowhere, as those that a
    `for` counts. `named_by` is what names the file in which `node` stands, and `instead_of` what would have set the
    name otherwise, the next in line first.
    """

    by: str
    node: YamlNode
    tree: Evaluation | None = None
    path: Path = ()
    is_made: bool = False
    named_by: YamlNode | None = None
    instead_of: tuple[Setting, ...] = ()


@dataclass(frozen=True, eq=False)
class ExpressionTrace:
    """One expression and the scope in which it was computed: from there its value can be followed back."""

    scalar: YamlScalar
    tree: Evaluation

    def origin(self, path: Path) -> Origin | None:
        """Return where the part at a path of the value was written; None where the expression itself made it."""
        node, is_data, key, _ = _written(self.scalar, self.tree, path)
        if node is self.scalar or isinstance(node, YamlFault):
            return None
        return Origin((node.key_span(key) if key else None) or node.span, is_data)

    def forgotten_expression(self, path: Path) -> str | None:
        """Return the expression that the text at a path looks like but for its `$(`; None for anything else."""
        written = _written(self.scalar, self.tree, path)
        node, tree = written.node, written.tree
        if tree is None or written.key or not isinstance(node, YamlScalar) or has_expression(node.text):
            return None
        return forgotten_expression(node.text, node.span, tree.scope) if isinstance(node.value, str) else None


class NameOrigin(NamedTuple):
    """How a name of an expression got its value: `names` are those that the value was computed from in turn."""

    name: str
    value: str
    setting: Setting
    names: tuple[NameOrigin, ...]


def names_behind(node: YamlNode) -> tuple[NameOrigin, ...]:
    """Return how the names got their values that the expressions use from which a node was computed.

    A name that several others take is told of once.
    """
    return tuple(_names_of(node, None, set()))


def _names_of(node: YamlNode, writer: Evaluation | None, told: set[Setting]) -> Iterator[NameOrigin]:
    for name, tree in _names_in(node, writer):
        setting = tree.settings.get(name)
        if setting is None or setting in told:
            continue
        told.add(setting)
        value = tree.scope.lookup(name, Diagnostics())
        shown = "unknown" if value is FAULT else describe(value)
        if isinstance(value, str):
            shown = shown if len(shown) < _LONGEST_TEXT else f"{shown[:_LONGEST_TEXT]}…'"
        else:
            shown = shown.strip("'")
        within = tuple(_names_of(setting.named_by or setting.node, setting.tree, told))
        yield NameOrigin(name, shown, setting, within)


def _names_in(node: YamlNode, tree: Evaluation | None) -> Iterator[tuple[str, Evaluation]]:
    """Yield the names that the expressions in a node use, in the order of the text, and what computed each."""
    if computed := _expression_of(node):
        node, tree = computed[0].scalar, computed[0].tree
    match node:
        case YamlScalar() if tree:
            template = tree.template(node, Diagnostics()) if has_expression(node.text) else None
            yield from ((name, tree) for name in (template.names_in_order if template else ()))
        case YamlList():
            for item in node:
                yield from _names_in(item, tree)
        case YamlMap():
            for entry in node:
                yield from _names_in(entry.value, tree)


class _Written(NamedTuple):
    """A node that says a value; `key` where it is the key of the node that is meant, not what stands under it.

    `tree` is what computes the node, None where no `$(` is an expression.
    """

    node: YamlNode
    is_data: bool
    key: Key | None = None
    tree: Evaluation | None = None


def _written(node: YamlNode, tree: Evaluation | None, path: Path) -> _Written:
    """Follow a value through the names that hand it on; what computes it is where it was written."""
    is_data = False
    for _ in range(_MOST_STEPS):
        if computed := _expression_of(node):
            node, tree, path = computed[0].scalar, computed[0].tree, (*computed[1], *path)
        elif isinstance(node, YamlScalar) and tree and has_expression(node.text):
            template = tree.template(node, Diagnostics())
            taken = handed_on(template, tree.scope_of(node)) if template else None
            setting = tree.settings.get(taken[0]) if taken else None
            if taken is None or setting is None or setting.is_made:
                break
            node, tree, path = setting.node, setting.tree, (*setting.path, *taken[1], *path)
            is_data = is_data or setting.named_by is not None
        elif not path:
            break
        elif isinstance(path[0], Key):
            return _Written(node, is_data, path[0])
        else:
            inner = _part(node, path[0])
            if inner is None:
                break
            node, path = inner, path[1:]
    return _Written(node, is_data, None, tree)


def _expression_of(node: YamlNode) -> tuple[ExpressionTrace, Path] | None:
    """Return the expression that computed a node and the path in its value; None for what overrides changed."""
    span = node.span
    if isinstance(span, TracedSpan) and isinstance(span.trace, ExpressionTrace) and not span.changes:
        return span.trace, span.path
    return None


def _part(node: YamlNode, key: str | int) -> YamlNode | None:
    """Return what a node says under a key, as expressions reach into values."""
    if isinstance(node, YamlMap):
        return node.child(str(key))
    if isinstance(node, YamlList):
        position = _AXES.get(key) if isinstance(key, str) else key
        if position is not None and -len(node) <= position < len(node):
            return node.items[position]
    return None
