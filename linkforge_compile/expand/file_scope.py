"""The scope of one use of a file: parameters, variables, data, builtin names and functions."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.expressions import WITHOUT_VALUES
from linkforge_compile.diagnostics.codes.modules import (
    DATA_NOT_PATH,
    INVALID_VARIABLE_NAME,
    NAME_OF_TWO_KINDS,
    NOT_CHECKED,
    PACKAGE_NOWHERE,
    RESERVED_NAME,
)
from linkforge_compile.expand.arguments import Unset, Variants
from linkforge_compile.expand.data_tags import UNIT_TAGS, number_with_tag
from linkforge_compile.expand.evaluate import Evaluator, Expressions, report_interpolated_quantity
from linkforge_compile.expand.expand_tree import expand_node
from linkforge_compile.expand.instance import NameReference
from linkforge_compile.expand.module_cache import CacheOfCompile
from linkforge_compile.expand.modules import ModuleEntry
from linkforge_compile.expand.parameter_values import BoundArguments, parameter_value, report_unset
from linkforge_compile.expand.parameters import Declaration, declarations
from linkforge_compile.expand.values import Setting, plain_value
from linkforge_compile.expand.varied import Varied
from linkforge_compile.expressions import (
    FAULT,
    RESERVED_NAMES,
    Fault,
    FileFunction,
    Lazy,
    PathText,
    Scope,
    Value,
    as_text,
    kind_name,
)
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.locations import PathSite, Writers, from_base, locate, mesh_base, rebased
from linkforge_compile.paths import follow
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.source import ModuleUse, SourceFile, SourceRef, Span
from linkforge_compile.source.provenance import Kind
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlScalar
from linkforge_compile.syntax.nodes import names_at_fault

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")

_KINDS = {"parameters": "parameter", "variables": "variable", "data": "data name"}
"""The sections that declare names, and what each is called in messages."""


@dataclass(frozen=True)
class CompileState:
    """What all uses in one compile share; `variant` selects one of the compiled file, or several: `a+b`."""

    compiled: SpecFile
    loader: Loader
    expressions: Expressions
    unset: Unset = Unset.ERROR
    variant: str | None = None
    cache: CacheOfCompile | None = None


@dataclass(frozen=True)
class Use:
    """One use of a file: by an entry in the file of the `outer` use, or the compiled file itself."""

    spec: SpecFile
    bound: BoundArguments
    entry: ModuleEntry | None = None
    outer: Use | None = None
    outer_writers: Writers = field(default_factory=dict)
    varied: Varied = None

    @property
    def chain(self) -> tuple[Use, ...]:
        """The use itself and those around it, that of the compiled file last."""
        return (self, *self.outer.chain) if self.outer else (self,)

    @cached_property
    def prefix(self) -> str | Fault:
        """The full prefix of the names of the file; FAULT if a part of it is faulty."""
        if self.entry is None or self.outer is None:
            return ""
        outer = self.outer.prefix
        return outer + self.entry.prefix if self.entry.is_named and not isinstance(outer, Fault) else FAULT

    @cached_property
    def include_stack(self) -> tuple[ModuleUse, ...]:
        """The `use` of this file and of those around it, the innermost first."""
        return tuple(ModuleUse.of(use.bound.use, use.entry.name) for use in self.chain if use.bound.use and use.entry)

    def writers(self, packages: Mapping[str, Path]) -> Writers:
        """Return the files that may have written a path here: its own, which know these packages, and those around."""
        files = {self.spec.file: self.spec, **self.spec.included}
        return {**self.outer_writers, **{file: (part, packages) for file, part in files.items()}}


class FileScope:
    """The names of one use of a file; each value is computed when first used, in any order, and once."""

    def __init__(self, use: Use, state: CompileState, sink: Diagnostics) -> None:
        """Declare the names; nothing is computed or looked up yet."""
        spec, bound = use.spec, use.bound
        self._use = use
        self._path_base = "" if spec.folder is None else mesh_base(spec, state.compiled)
        self._loader = state.loader
        self._packages: dict[str, Path] | None = None
        self._reports_unset = state.unset is Unset.ERROR or bound.use is not None
        self._variants = Variants() if bound.use else Variants.of(spec, state.variant)
        self._sink = sink
        self._unset: list[Declaration] = []
        self.declared = declarations(spec.tree.get("parameters"))
        self._names = self._declared_names()
        self.references: list[NameReference] = []
        """The names passed to `link()` and `joint()`, for a later check."""
        values: dict[str, Value | Fault | Lazy] = {
            "name": Lazy(self._name, spec.file.whole),
            "standalone": bound.use is None,
            "prefix": use.prefix,
            **self._names["variables"],
            **self._names["data"],
            **self._names["parameters"],
        }
        functions: dict[str, FileFunction] = {"path": self._find_path}
        functions |= {kind: partial(self._with_prefix, kind) for kind in ("link", "joint")}
        scope = Scope(values, self._unread_names(), functions, self._loader.budget)
        self.evaluator = Evaluator(scope, state.expressions, sink, self._paths_elsewhere())

    @property
    def packages(self) -> Mapping[str, Path]:
        """The package folders that the file and those around it declare."""
        if self._packages is None:
            # Set before the declarations are computed, because computing them may look for packages.
            self._packages = dict(self._use.spec.packages)
            self._packages.update(self._declared_packages())
        return self._packages

    def site(self, text: str, where: Span) -> PathSite:
        """Return the site of a path that this file or one that it includes wrote."""
        return PathSite(text, where, self._use.spec.part_at(where), self.packages)

    def _find_path(self, text: str, where: Span, sink: Diagnostics) -> Value | Fault:
        target = locate(self.site(text, where), self._loader, sink)
        return FAULT if target is None else str(target.path.absolute())

    def _with_prefix(self, kind: str, name: str, where: Span, _sink: Diagnostics) -> Value | Fault:
        self.references.append(NameReference(kind, name, SourceRef(YamlFault(where), None, self._use.include_stack)))
        prefix = self._use.prefix
        return FAULT if isinstance(prefix, Fault) else prefix + name

    def _declared_packages(self) -> dict[str, Path]:
        section = self._use.spec.tree.get("packages")
        shape = shapes().under("packages")
        declared = expand_node(section, self.evaluator, shape, key="packages") if section else None
        folders = {}
        for entry in declared if isinstance(declared, YamlMap) else ():
            if isinstance(entry.value, YamlScalar):
                folder, target = self._use.spec.part_at(entry.value.span).folder, entry.value.text
                if folder is not None or Path(target).is_absolute():
                    folders[entry.name] = follow(folder or Path(), target)
                    self._check_package(entry.name, folders[entry.name], entry.value)
        return folders

    def _check_package(self, name: str, folder: Path, declared: YamlScalar) -> None:
        """Report a declared folder within the roots that does not exist, unless the user says where the package is."""
        may_look = name not in self._loader.packages and self._loader.roots.hold(folder)
        if may_look and not os.path.isdir(folder):  # noqa: PTH112 - handles names that no file can have
            self._sink.report(PACKAGE_NOWHERE.at(declared.span, path=declared.text, name=name))

    def check_parameters(self) -> None:
        """Report what is wrong with the parameters and their arguments, used or not."""
        if not self._is_faulty("parameters", "include"):
            self._use.bound.report_unknown(self.declared, self._variants, self._use.spec)
        for name in (*self._names["parameters"], *self._names["data"]):
            self.evaluator.scope.lookup(name, self._sink)
        if self._unset and self._reports_unset and not self._use.bound.arguments.is_partial:
            report_unset(self._unset, self._use.bound, self._variants)
        elif self._unset and not self._reports_unset:
            names = ", ".join(f"'{declaration.name}'" for declaration in self._unset)
            pronoun = "it" if len(self._unset) == 1 else "them"
            self._sink.report(NOT_CHECKED.at(self._unset[0].key.span, names=names, pronoun=pronoun))

    def check_unused_variables(self) -> None:
        """Report faults of unused variables and of variants that do not depend on values.

        Other faults, such as a division by zero, do not matter in a variable that is not used.
        """
        self.evaluator = replace(self.evaluator, sink=_TextFaultSink(self._sink))
        for name in self._names["variables"]:
            self.evaluator.scope.lookup(name, self.evaluator.sink)
        for setting in self._variants.entries:
            self.evaluator.value(setting.value)

    def _declared_names(self) -> dict[str, dict[str, Fault | Lazy]]:
        """Return the values of the names that each section declares; of two sections with one name, reported ones."""
        compute = {"parameters": self._parameter, "variables": self._variable, "data": self._data_value}
        names: dict[str, dict[str, Fault | Lazy]] = {section: {} for section in _KINDS}
        first: dict[str, tuple[str, YamlScalar]] = {}
        for section, kind in _KINDS.items():
            for entry in self._use.spec.tree.section(section).values():
                other, key = first.setdefault(entry.name, (section, entry.key))
                if other != section:
                    names[other][entry.name] = FAULT
                    notes = [Note(f"the {_KINDS[other]} is declared here", key.span)]
                    kinds = f"a {_KINDS[other]} and a {kind}"
                    self._sink.report(NAME_OF_TWO_KINDS.at(entry.key.span, name=entry.name, kinds=kinds, notes=notes))
                elif self._is_valid_name(entry.key, kind):
                    names[section][entry.name] = Lazy(partial(compute[section], entry), entry.key.span)
        return names

    def _parameter(self, entry: YamlEntry) -> Value | Fault:
        declaration = self.declared[entry.name]
        value, setting = parameter_value(declaration, self._use.bound, self._variants, self._use.spec, self.evaluator)
        if setting is not None:
            self.evaluator.settings[declaration.name] = setting
        if value is not None:
            return self._as_path(value) if declaration.is_file else value
        if not declaration.is_faulty:
            self._unset.append(declaration)
        return FAULT

    def _variable(self, entry: YamlEntry) -> Value | Fault:
        self.evaluator.settings[entry.name] = Setting(Kind.VARIABLE, entry.value, self.evaluator)
        value = self.evaluator.value(entry.value)
        return FAULT if report_interpolated_quantity(entry.value, value, self.evaluator) else value

    def _data_value(self, entry: YamlEntry) -> Value | Fault:
        """Return the content of a file of `data`, in which text with a unit is a quantity and `$(` is plain text."""
        path = self.evaluator.value(entry.value)
        if path is FAULT:
            return FAULT
        text = as_text(path)
        if text is None:
            found = "nothing" if path is None else kind_name(path)
            self._sink.report(DATA_NOT_PATH.at(entry.value.span, name=entry.name, found=found))
            return FAULT
        site = self.site(text, self.evaluator.place(entry.value))
        target = locate(site, self._loader, self._sink)
        tags = {tag: partial(number_with_tag, self._sink, tag) for tag in UNIT_TAGS}
        node = self._loader.open_data(target.path, self._sink, tags, site.used) if target else None
        if node is None:
            return FAULT
        name = node.span.file.name
        self.evaluator.settings[entry.name] = Setting(Kind.DATA, node, name=name, named_by=entry.value)
        return plain_value(node)

    def _paths_elsewhere(self) -> dict[SourceFile, dict[str, Lazy]]:
        """Return the path parameters as seen from each included file that lies in another folder."""
        paths = [one for name, one in self.declared.items() if one.is_file and name in self._names["parameters"]]
        return {
            file: {path.name: Lazy(partial(self._seen_from, part, path.name), path.key.span) for path in paths}
            for file, part in self._use.spec.included.items()
            if part.folder != self._use.spec.folder
        }

    def _seen_from(self, part: SpecFile, name: str) -> Value | Fault:
        path = self.evaluator.scope.lookup(name, self._sink)
        return self._as_path(path, rebased(path, self._use.spec.folder, part)) if isinstance(path, str) else path

    def _as_path(self, value: Value | Fault, text: str | None = None) -> Value | Fault:
        """Return a path that knows how the compiled file would write it; `text` is its text, the path by default."""
        # An empty text is not a path, and has no length by which to bound what is built from it.
        if not isinstance(value, str) or not value:
            return value
        return PathText(value if text is None else text, from_base(value, self._path_base))

    def _is_valid_name(self, key: YamlScalar, kind: str) -> bool:
        """Whether an expression can use the name; reports why not."""
        if not _NAME.fullmatch(key.text):
            self._sink.report(INVALID_VARIABLE_NAME.at(key.span, name=key.text, kind=kind))
        elif key.text in RESERVED_NAMES:
            notes = [Note("names get the prefix of their use automatically")] if key.text == "prefix" else []
            self._sink.report(RESERVED_NAME.at(key.span, name=key.text, kind=kind, notes=notes))
        else:
            return True
        return False

    def _name(self) -> Value | Fault:
        node = self._use.spec.tree.get("name")
        key = self.evaluator.key(node) if isinstance(node, YamlScalar) else None
        return key.text if key else FAULT

    def _unread_names(self) -> Scope | None:
        """Return a scope for names that a faulty section, an unknown key or an unread file may have declared."""
        if self._use.spec.tree.get("name") is None or self._is_faulty(*_KINDS, "include"):
            return _FaultyScope(None)
        names = frozenset(names_at_fault(self._use.spec.tree))
        return _FaultyScope(names) if names else None

    def _is_faulty(self, *sections: str) -> bool:
        return any(isinstance(self._use.spec.tree.get(section), YamlFault) for section in sections)


class _FaultyScope(Scope):
    """A scope with the given names, or every name for None, whose values are faults that were reported."""

    def __init__(self, names: frozenset[str] | None) -> None:
        super().__init__({})
        self._names = names

    def __contains__(self, name: object) -> bool:
        return self._names is None or name in self._names

    def lookup(self, name: str, sink: Diagnostics) -> Value | Fault:
        return FAULT


class _TextFaultSink(Diagnostics):
    """Passes on only faults of the text of an expression, which do not depend on values."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        if diagnostic.code in WITHOUT_VALUES:
            self._sink.report(diagnostic)
