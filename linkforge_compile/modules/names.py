"""The names that the expressions of a file may use: its parameters, its variables, and what is always there."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial

from linkforge_compile.diagnostics import Code, Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes import expressions as expression_codes
from linkforge_compile.diagnostics.codes.modules import (
    INVALID_VARIABLE_NAME,
    NOT_JUDGED,
    PARAMETER_AND_VARIABLE,
    RESERVED_NAME,
)
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Fault, Lazy, Scope, Value
from linkforge_compile.modules.evaluate_tree import Expressions, TreeEvaluator
from linkforge_compile.modules.given import Given, Unset, parameter_value, tell_unset
from linkforge_compile.modules.loader import SpecFile
from linkforge_compile.modules.parameters import Declaration, declarations
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode, YamlScalar

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")

_SEEN_IN_THE_TEXT = {
    code.id for code in vars(expression_codes).values() if isinstance(code, Code) and not "LF3120" <= code.id < "LF3140"
}
"""The faults of an expression that it has whatever the values of its names are."""


class FileNames:
    """The scope of one use of a file; each name is computed when first used, in any order, and once."""

    def __init__(self, spec: SpecFile, given: Given, unset: Unset, expressions: Expressions, sink: Diagnostics) -> None:
        self._spec = spec
        self._given = given
        self._is_unset_told = unset is Unset.ERROR or given.use is not None
        self._declared = declarations(spec.tree.get("parameters"))
        self._unset: list[Declaration] = []
        self._sink = sink
        self._parameters = {
            name: Lazy(partial(self._parameter, declaration), declaration.key.span)
            for name, declaration in self._declared.items()
            if self._is_name(declaration.key, "parameter")
        }
        self._variables = self._lazy_variables()
        always: dict[str, Value | Fault | Lazy] = {
            "name": Lazy(self._name, spec.file.whole),
            "standalone": given.use is None,
        }
        scope = Scope({**always, **self._variables, **self._parameters}, self._names_unread())
        self.tree = TreeEvaluator(scope, expressions, sink)

    def judge_parameters(self) -> None:
        """Report what is wrong with the parameters and with what sets them, used or not."""
        if not isinstance(self._spec.tree.get("parameters"), YamlFault):
            self._given.tell_unknown(self._declared, self._spec)
        for name in self._parameters:
            self.tree.scope.lookup(name, self._sink)
        if self._unset and not self._is_unset_told:
            names = ", ".join(f"'{declaration.name}'" for declaration in self._unset)
            pronoun = "it" if len(self._unset) == 1 else "them"
            self._sink.report(NOT_JUDGED.at(self._unset[0].key.span, names=names, pronoun=pronoun))

    def judge_unused_variables(self) -> None:
        """Report of the variables that nothing used what is wrong with them whatever their values are.

        They are computed when used: that one divides by zero is no fault of a robot that does not need it.
        """
        self.tree = replace(self.tree, sink=_TextFaults(self._sink))
        for name in self._variables:
            self.tree.scope.lookup(name, self.tree.sink)

    def _parameter(self, declaration: Declaration) -> Value | Fault:
        value = parameter_value(declaration, self._given, self._spec, self.tree)
        if value is not None:
            return value
        self._unset.append(declaration)
        if self._is_unset_told and not self._given.arguments.is_partial:
            tell_unset(declaration, self._given)
        return FAULT

    def _lazy_variables(self) -> dict[str, Lazy]:
        section = self._spec.tree.get("variables")
        lazy = {}
        for entry in section if isinstance(section, YamlMap) else ():
            name = entry.name
            if name in self._declared:
                notes = [Note("the parameter is declared here", self._declared[name].key.span)]
                self._sink.report(PARAMETER_AND_VARIABLE.at(entry.key.span, name=name, notes=notes))
            elif self._is_name(entry.key, "variable"):
                lazy[name] = Lazy(partial(self._variable, entry.value), entry.key.span)
        return lazy

    def _variable(self, node: YamlNode) -> Value | Fault:
        return self.tree.value(node)

    def _is_name(self, key: YamlScalar, kind: str) -> bool:
        """Whether an expression can use the name; reports why not."""
        if not _NAME.fullmatch(key.text):
            self._sink.report(INVALID_VARIABLE_NAME.at(key.span, name=key.text, kind=kind))
        elif key.text in RESERVED_NAMES:
            self._sink.report(RESERVED_NAME.at(key.span, name=key.text, kind=kind))
        else:
            return True
        return False

    def _name(self) -> Value | Fault:
        node = self._spec.tree.get("name")
        key = self.tree.key(node) if isinstance(node, YamlScalar) else None
        return key.text if key else FAULT

    def _names_unread(self) -> Scope | None:
        """Return a scope for what a faulty section may have declared, None where all was read."""
        sections = (self._spec.tree.get("parameters"), self._spec.tree.get("variables"))
        return _AnyName({}) if any(isinstance(section, YamlFault) for section in sections) else None


class _AnyName(Scope):
    """Knows every name and has no value for any: their declarations are at fault, which was reported."""

    def __contains__(self, name: object) -> bool:
        return True

    def lookup(self, name: str, sink: Diagnostics) -> Value | Fault:
        return FAULT


class _TextFaults(Diagnostics):
    """Hands on only the faults that an expression has whatever its names stand for."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        if diagnostic.code.id in _SEEN_IN_THE_TEXT:
            self._sink.report(diagnostic)
