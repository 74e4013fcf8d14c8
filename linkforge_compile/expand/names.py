"""The names that the expressions of a file may use: its parameters, its variables, and what is always there."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.expressions import SEEN_IN_THE_TEXT
from linkforge_compile.diagnostics.codes.modules import (
    INVALID_VARIABLE_NAME,
    NAME_OF_TWO_KINDS,
    NOT_JUDGED,
    PACKAGE_NOWHERE,
    RESERVED_NAME,
)
from linkforge_compile.expand.arguments import Unset
from linkforge_compile.expand.evaluate_tree import Expressions, TreeEvaluator
from linkforge_compile.expand.given import Given, parameter_value, tell_unset
from linkforge_compile.expand.kinds import KINDS
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.made_number import tell_made_quantity
from linkforge_compile.expand.origins import Setting
from linkforge_compile.expand.own_names import OwnNames
from linkforge_compile.expand.parameters import Declaration, declarations
from linkforge_compile.expand.paths import follow
from linkforge_compile.expand.uses import from_base, mesh_base, rebased
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expand.variants import Variants, variants_of
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Fault, Lazy, PathText, Scope, Value
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlScalar
from linkforge_compile.syntax.nodes import names_at_fault

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")

_KINDS = {"parameters": "parameter", "variables": "variable", "data": "data name"}
"""The sections that declare names, and what each is called."""


@dataclass(frozen=True)
class Shared:
    """What all uses of all files in one compile share; `variant` is the one chosen for the compiled file."""

    compiled: SpecFile
    loader: Loader
    expressions: Expressions
    unset: Unset = Unset.ERROR
    variant: str | None = None


class UseOfFile(NamedTuple):
    """One use of a file: what it is given, its whole prefix (FAULT where that is at fault), and each `use` to it."""

    spec: SpecFile
    given: Given
    prefix: str | Fault = ""
    trail: tuple[Span, ...] = ()


class FileNames:
    """The scope of one use of a file; each name is computed when first used, in any order, and once."""

    def __init__(self, use: UseOfFile, shared: Shared, sink: Diagnostics) -> None:
        spec, given = use.spec, use.given
        self._spec = spec
        self._path_base = "" if spec.folder is None else mesh_base(spec, shared.compiled)
        self._given = given
        self._loader = shared.loader
        self._packages: dict[str, Path] | None = None
        self._is_unset_told = shared.unset is Unset.ERROR or given.use is not None
        self._variants = Variants() if given.use else Variants(variants_of(spec), shared.variant)
        self.declared = declarations(spec.tree.get("parameters"))
        self._unset: list[Declaration] = []
        self._sink = sink
        self._of_two: set[str] = set()
        """The names that two sections declare: what is meant where they are used nobody knows, which has been told."""
        self._parameters = {
            name: Lazy(partial(self._parameter, declaration), declaration.key.span)
            for name, declaration in self.declared.items()
            if self._is_name(declaration.key, "parameter")
        }
        self._variables = {name: self._lazy(self._variable, entry) for name, entry in self._entries("variables")}
        self._data = {name: self._lazy(self._data_value, entry) for name, entry in self._entries("data")}
        always: dict[str, Value | Fault | Lazy] = {
            "name": Lazy(self._name, spec.file.whole),
            "standalone": given.use is None,
            "prefix": use.prefix,
        }
        self.own = OwnNames(spec, use.prefix, lambda: self.packages, shared.loader, use.trail)
        values = {**always, **self._variables, **self._data, **self._parameters, **dict.fromkeys(self._of_two, FAULT)}
        scope = Scope(values, self._names_unread(), self.own.functions, self._loader.budget)
        self.tree = TreeEvaluator(scope, shared.expressions, sink, self._paths_seen_from_elsewhere())

    @property
    def packages(self) -> Mapping[str, Path]:
        """The folders that the file declares for packages, those that lead somewhere."""
        if self._packages is None:
            # None of them is found by way of another one: that may be the way back.
            self._packages = dict(self._spec.packages)
            self._packages.update(self._declared_packages())
        return self._packages

    def _declared_packages(self) -> dict[str, Path]:
        section = self._spec.tree.get("packages")
        declared = self.tree.node(section, shapes().under("packages"), key="packages") if section else None
        folders = {}
        for entry in declared if isinstance(declared, YamlMap) else ():
            if isinstance(entry.value, YamlScalar):
                folder, target = self._spec.part_at(entry.value.span).folder, entry.value.text
                if folder is not None or Path(target).is_absolute():
                    folders[entry.name] = follow(folder or Path(), target)
                    self._judge_package(entry.name, folders[entry.name], entry.value)
        return folders

    def _judge_package(self, name: str, folder: Path, said: YamlScalar) -> None:
        """Tell of a folder within the roots that is not there; where its user says where the package is, nothing."""
        may_look = name not in self._loader.packages and self._loader.roots.hold(folder)
        if may_look and not os.path.isdir(folder):  # noqa: PTH112 - answers for names that no file can have as well
            self._sink.report(PACKAGE_NOWHERE.at(said.span, path=said.text, name=name))

    def judge_parameters(self) -> None:
        """Report what is wrong with the parameters and with what sets them, used or not."""
        if not self._is_faulty("parameters", "include"):
            self._given.tell_unknown(self.declared, self._variants, self._spec)
        for name in (*self._parameters, *self._data):
            self.tree.scope.lookup(name, self._sink)
        if self._unset and self._is_unset_told and not self._given.arguments.is_partial:
            tell_unset(self._unset, self._given, self._variants)
        elif self._unset and not self._is_unset_told:
            names = ", ".join(f"'{declaration.name}'" for declaration in self._unset)
            pronoun = "it" if len(self._unset) == 1 else "them"
            self._sink.report(NOT_JUDGED.at(self._unset[0].key.span, names=names, pronoun=pronoun))

    def judge_unused_variables(self) -> None:
        """Report of the variables that nothing used, and of variants, what is wrong whatever the values are.

        They are computed when used: that one divides by zero is no fault of a robot that does not need it.
        """
        self.tree = replace(self.tree, sink=_TextFaults(self._sink))
        for name in self._variables:
            self.tree.scope.lookup(name, self.tree.sink)
        for setting in self._variants.entries():
            self.tree.value(setting.value)

    def _parameter(self, declaration: Declaration) -> Value | Fault:
        value, setting = parameter_value(declaration, self._given, self._variants, self._spec, self.tree)
        if setting is not None:
            self.tree.settings[declaration.name] = setting
        if value is not None:
            return self._as_path(value) if declaration.kind is KINDS["file"] else value
        if declaration.is_faulty:
            return FAULT
        self._unset.append(declaration)
        return FAULT

    def _entries(self, section: str) -> Iterator[tuple[str, YamlEntry]]:
        """Yield the entries of `variables` or `data` whose names are theirs alone."""
        kind = _KINDS[section]
        declared = self._spec.tree.get(section)
        for entry in declared if isinstance(declared, YamlMap) else ():
            other = self._kind_of_other(entry.name, section)
            if other:
                self._of_two.add(entry.name)
                notes = [Note(f"the {other[0]} is declared here", other[1].span)]
                kinds = f"a {other[0]} and a {kind}"
                self._sink.report(NAME_OF_TWO_KINDS.at(entry.key.span, name=entry.name, kinds=kinds, notes=notes))
            elif self._is_name(entry.key, kind):
                yield entry.name, entry

    def _kind_of_other(self, name: str, section: str) -> tuple[str, YamlScalar] | None:
        """Return what declares a name of a section before it, and where."""
        for other, kind in _KINDS.items():
            if other == section:
                return None
            declared = self._spec.tree.get(other)
            if isinstance(declared, YamlMap) and name in declared.entries:
                return kind, declared.entries[name].key
        return None

    def _lazy(self, compute: Callable[[YamlEntry], Value | Fault], entry: YamlEntry) -> Lazy:
        return Lazy(partial(compute, entry), entry.key.span)

    def _variable(self, entry: YamlEntry) -> Value | Fault:
        self.tree.settings[entry.name] = Setting("the variable", entry.value, self.tree)
        value = self.tree.value(entry.value)
        return FAULT if tell_made_quantity(entry.value, value, self.tree) else value

    def _data_value(self, entry: YamlEntry) -> Value | Fault:
        from linkforge_compile.expand.data import data_of

        path = self.tree.value(entry.value)
        place = self.tree.place(entry.value)
        node = data_of(entry, path, lambda text: self.own.site(text, place), self._loader, self._sink)
        if node is None:
            return FAULT
        self.tree.settings[entry.name] = Setting("data", node, named_by=entry.value)
        return plain_value(node)

    def _paths_seen_from_elsewhere(self) -> dict[SourceFile, dict[str, Lazy]]:
        """Return the parameters that are paths, for each included file that lies in another folder than this one."""
        paths = [one for one in self.declared.values() if one.kind is KINDS["file"] and one.name in self._parameters]
        return {
            file: {path.name: Lazy(partial(self._seen_from, part, path.name), path.key.span) for path in paths}
            for file, part in self._spec.included.items()
            if part.folder != self._spec.folder
        }

    def _seen_from(self, part: SpecFile, name: str) -> Value | Fault:
        path = self.tree.scope.lookup(name, self._sink)
        return self._as_path(path, rebased(path, self._spec.folder, part)) if isinstance(path, str) else path

    def _as_path(self, value: Value | Fault, text: str | None = None) -> Value | Fault:
        """Return a path of this file as one that can tell how the compiled file writes it; `text` is it as read."""
        # An empty text is no path, and would have no length by which to bound what is put together of it.
        if not isinstance(value, str) or not value:
            return value
        return PathText(value if text is None else text, from_base(value, self._path_base))

    def _is_name(self, key: YamlScalar, kind: str) -> bool:
        """Whether an expression can use the name; reports why not."""
        if not _NAME.fullmatch(key.text):
            self._sink.report(INVALID_VARIABLE_NAME.at(key.span, name=key.text, kind=kind))
        elif key.text in RESERVED_NAMES:
            notes = [Note("names take the prefix of their use by themselves")] if key.text == "prefix" else []
            self._sink.report(RESERVED_NAME.at(key.span, name=key.text, kind=kind, notes=notes))
        else:
            return True
        return False

    def _name(self) -> Value | Fault:
        node = self._spec.tree.get("name")
        key = self.tree.key(node) if isinstance(node, YamlScalar) else None
        return key.text if key else FAULT

    def _names_unread(self) -> Scope | None:
        """Return a scope for what a faulty section, an unknown key, or a file around this one may have declared."""
        if self._spec.tree.get("name") is None or self._is_faulty(*_KINDS, "include"):
            return _LostNames(None)
        lost = frozenset(names_at_fault(self._spec.tree))
        return _LostNames(lost) if lost else None

    def _is_faulty(self, *sections: str) -> bool:
        return any(isinstance(self._spec.tree.get(section), YamlFault) for section in sections)


class _LostNames(Scope):
    """Knows names, every one for None, and has no value for any: their declarations are at fault, which was told."""

    def __init__(self, names: frozenset[str] | None) -> None:
        super().__init__({})
        self._names = names

    def __contains__(self, name: object) -> bool:
        return self._names is None or name in self._names

    def lookup(self, name: str, sink: Diagnostics) -> Value | Fault:
        return FAULT


class _TextFaults(Diagnostics):
    """Hands on only the faults that an expression has whatever its names stand for."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        if diagnostic.code in SEEN_IN_THE_TEXT:
            self._sink.report(diagnostic)
