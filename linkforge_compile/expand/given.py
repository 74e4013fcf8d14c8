"""What the user of a file gives to its parameters, and the value that each parameter has in the end."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.files import FILE_OUTSIDE_PACKAGE
from linkforge_compile.diagnostics.codes.modules import (
    PARAMETER_NOT_SET,
    PARAMETER_WITHOUT_TYPE,
    UNKNOWN_PARAMETER,
)
from linkforge_compile.expand.arguments import COMMAND_LINE, Arguments
from linkforge_compile.expand.evaluate_tree import TreeEvaluator
from linkforge_compile.expand.kinds import Kind, kind_of
from linkforge_compile.expand.loader import SpecFile
from linkforge_compile.expand.made_number import tell_made_number
from linkforge_compile.expand.noted import NotedSink
from linkforge_compile.expand.origins import Setting
from linkforge_compile.expand.parameters import Declaration, Parameter, parameter_of, written
from linkforge_compile.expand.uses import rebased
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expand.variants import Variants
from linkforge_compile.expressions import FAULT, Fault, Value
from linkforge_compile.limits import Limit
from linkforge_compile.schema.words import alternatives
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlFault, YamlList, YamlNode, YamlScalar, has_expression, read

_SHOWN = 8
"""How many parameters, choices and variants a message shows."""

_SHOWN_TEXT = 60
"""How long choices may be that a message shows."""


@dataclass(frozen=True)
class Given:
    """The arguments of one use of a file.

    `sink` takes the faults of what was written there, and `tree` computes it in its writer's scope, None where it
    holds no expressions. `use` is where a missing argument is blamed, None for the compiled file.
    """

    arguments: Arguments
    sink: Diagnostics
    tree: TreeEvaluator | None = None
    use: Span | None = None

    def tell_unknown(self, declared: dict[str, Declaration], variants: Variants, spec: SpecFile) -> None:
        """Report arguments, and settings of variants, for parameters that the file does not have."""
        section = spec.tree.entries.get("parameters")
        note = Note("its parameters are declared here" if section else "this file declares no parameters")
        note = Note(note.message, section.key.span if section else spec.file.whole)
        for name, entry in self.arguments.entries.items():
            if name not in declared:
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=declared, notes=[note]))
        for entry in variants.entries():
            if entry.name not in declared:
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=entry.name, near=declared, notes=[note]))

    def node(self, name: str, kind: Kind, sink: Diagnostics) -> YamlNode | None:
        """Return what is given to a parameter, None for nothing; a list or map that was typed as text is read."""
        entry = self.arguments.entries.get(name)
        if entry is None or (isinstance(entry.value, YamlScalar) and entry.value.value is None):
            return None
        node = entry.value
        if not (self.arguments.as_text and kind.is_structured and isinstance(node, YamlScalar)):
            return node
        file = SourceFile(node.span.file.name, f"{name}: {node.text}")
        typed = read(file, sink)
        return YamlFault(node.span) if typed is None else typed.get(name) or node

    def place(self, node: YamlNode) -> Span:
        """Return where a given node stands; the place of an expression can tell where its value comes from."""
        return self.tree.place(node) if self.tree else node.span

    @property
    def names(self) -> Container[str]:
        """The names that expressions may use where the arguments are written."""
        return self.tree.scope if self.tree else ()

    def settings(self, name: str, node: YamlNode) -> list[Setting]:
        """Return what gives the node to a parameter, and what that took the place of."""
        by = "'with'" if self.use else "the command line" if node.span.file.name == COMMAND_LINE else "Python"
        settings, entry = [Setting(by, node, self.tree)], self.arguments.entries[name].replaced
        while entry:
            settings.append(Setting(by, entry.value, self.tree))
            entry = entry.replaced
        return settings

    def value(self, node: YamlNode, kind: Kind) -> Value | Fault:
        """Return what a given node means to a parameter of a type, before it is judged."""
        if self.tree:
            return written(node, kind, self.tree)
        return node.text if kind.is_text and isinstance(node, YamlScalar) else plain_value(node)


def parameter_value(
    declaration: Declaration, given: Given, variants: Variants, spec: SpecFile, tree: TreeEvaluator
) -> tuple[Value | Fault | None, Setting | None]:
    """Return the value of a parameter: the given one, else the chosen variant's, else the default; None for none.

    `tree` computes the declaration, in the scope of the file `spec` that has it. FAULT for what was reported.
    With it comes what set it.
    """
    kind = declared_kind(declaration, tree)
    if kind is None:
        return FAULT, None
    parameter = parameter_of(declaration, kind, tree)
    noted = NotedSink(tree.sink, [Note("the parameter is declared here", declaration.key.span)])
    in_force, settings = _given_value(parameter, given, spec, tree, declaration.key.span)
    for node, sink, by in (
        (variants.value_of(declaration.name), noted, f"variant '{variants.chosen}'"),
        *((other, noted, "") for other in variants.other_values_of(declaration.name)),
        (declaration.default, tree.sink, "the default"),
    ):
        wins = bool(by) and in_force is None
        # What is wrong with a value whatever the names stand for is wrong unused, too.
        if node is not None and (wins or not tree.expressions.are_in(node)):
            value = _own_value(parameter, node, spec, tree, sink)
            in_force = value if wins else in_force
        if node is not None and by and in_force is not None:
            settings.append(Setting(by, node, tree))
    return in_force, replace(settings[0], instead_of=tuple(settings[1:])) if settings else None


def tell_unset(declared: Sequence[Declaration], given: Given, variants: Variants) -> None:
    """Report the required parameters that nothing sets: all at the `use` that lacks them, else each where it stands."""
    if given.use is not None:
        rest = len(declared) - _SHOWN
        names = [*(f"'{one.name}'" for one in declared[:_SHOWN]), *([f"{rest} more"] if rest > 0 else [])]
        settings = [*(f"{one.name}: {_placeholder(one)}" for one in declared[:_SHOWN]), *(["…"] if rest > 0 else [])]
        what = f"parameter {names[0]} has" if len(names) == 1 else f"parameters {alternatives(names, 'and')} have"
        notes = [Note(f"'{one.name}' is declared here", one.key.span) for one in declared[:_SHOWN]]
        remedy = f"'with: {{{', '.join(settings)}}}'"
        given.sink.report(PARAMETER_NOT_SET.at(given.use, what=what, remedy=remedy, notes=notes))
        return
    in_python = given.arguments.from_python
    for one in declared:
        itself = f"parameters={{'{one.name}': …}}" if in_python else f"'-p {one.name}={_placeholder(one)}'"
        names = [name for name, said in variants.by_name.items() if said.get(one.name) is not None][:_SHOWN]
        remedy = alternatives(
            [itself, *(f"variant='{name}'" if in_python else f"'--variant {name}'" for name in names)]
        )
        given.sink.report(PARAMETER_NOT_SET.at(one.key.span, what=f"parameter '{one.name}' has", remedy=remedy))


def _placeholder(declaration: Declaration) -> str:
    """Return what stands for a value: the choices of an `enum`, else the type: "mock|real", "LENGTH"."""
    choices = declaration.constraints.get("enum")
    items = choices.value.items if choices and isinstance(choices.value, YamlList) else ()
    words = [item.text for item in items if isinstance(item, YamlScalar) and not has_expression(item.text)]
    written = "|".join(words[:_SHOWN])
    if 0 < len(words) == len(items) <= _SHOWN and len(written) <= _SHOWN_TEXT:
        return written
    return declaration.kind.name.upper() if declaration.kind else "VALUE"


def declared_kind(declaration: Declaration, tree: TreeEvaluator) -> Kind | None:
    """Return the declared type, or that of the default; None where neither tells, which has been reported."""
    if declaration.kind or declaration.is_faulty:
        return declaration.kind
    if declaration.default is None:
        tree.sink.report(PARAMETER_WITHOUT_TYPE.at(declaration.key.span, name=declaration.name))
        return None
    value = tree.value(declaration.default)
    return None if value is FAULT else kind_of(value)


def _given_value(
    parameter: Parameter, given: Given, spec: SpecFile, tree: TreeEvaluator, declared: Span
) -> tuple[Value | Fault | None, list[Setting]]:
    """Return what the user of the file gives, None for nothing, and what gives it."""
    sink = NotedSink(given.sink, [Note("the parameter is declared here", declared)])
    node = given.node(parameter.name, parameter.kind, given.sink)
    value = None if node is None else given.value(node, parameter.kind)
    if node is None or value is None:
        return None, []
    taken = _judged(parameter, _Said(node, value, given.place(node), given.names), tree, sink)
    path = _in_the_file(parameter, taken, given.arguments.folder, spec)
    if isinstance(taken, str) and path != taken and Path(str(path)).is_absolute():
        sink.report(FILE_OUTSIDE_PACKAGE.at(node.span, path=taken))
    return path, given.settings(parameter.name, node)


def _own_value(
    parameter: Parameter, node: YamlNode, spec: SpecFile, tree: TreeEvaluator, sink: Diagnostics
) -> Value | Fault | None:
    """Return what the file itself says, in a default or a variant; None for nothing."""
    value = written(node, parameter.kind, tree)
    if value is None:
        return None
    taken = _judged(parameter, _Said(node, value, tree.place(node), tree.scope), tree, sink)
    return _in_the_file(parameter, taken, spec.writer(node.span).folder, spec)


def _in_the_file(parameter: Parameter, value: Value | Fault, writer: Path | None, spec: SpecFile) -> Value | Fault:
    """Return a path that was written in one folder as one of the file that reads it; any other value as it is."""
    return rebased(value, writer, spec) if parameter.kind.name == "file" and isinstance(value, str) else value


class _Said(NamedTuple):
    """What is said of a parameter, what it comes to, the place to blame for that, and the names known there."""

    node: YamlNode
    value: Value | Fault
    place: Span
    names: Container[str]


def _judged(parameter: Parameter, said: _Said, tree: TreeEvaluator, sink: Diagnostics) -> Value | Fault:
    """Return the value as one of the parameter's type, FAULT where it does not fit, which is reported at its place."""
    if said.value is FAULT:
        return FAULT
    is_text = parameter.kind.is_text
    if not is_text and tell_made_number(said.node, said.value, tree.expressions, said.names, sink):
        return FAULT
    if parameter.pattern is not None:
        steps = parameter.pattern.steps(str(said.value))
        tree.expressions.budget.spend(Limit.STEPS, steps, said.node.span)
    taken = parameter.take(said.value, said.place, sink, said.names)
    return FAULT if taken is None else taken
