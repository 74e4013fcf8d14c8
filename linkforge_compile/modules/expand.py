"""The verb of this room: from the compiled file to the assembly of every use of every file, all computed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import (
    MODULES_NOT_MAP,
    TOO_MANY_MODULES,
    USE_CIRCLE,
    USE_TOO_DEEP,
)
from linkforge_compile.modules.arguments import Arguments
from linkforge_compile.modules.assembly import Instance
from linkforge_compile.modules.evaluate_tree import Expressions, TreeEvaluator
from linkforge_compile.modules.given import Given, Unset
from linkforge_compile.modules.loader import Loader, SpecFile, follow
from linkforge_compile.modules.module_entry import ModuleEntry, found, read_entry
from linkforge_compile.modules.names import FileNames
from linkforge_compile.modules.noted import used_from
from linkforge_compile.modules.uses import UseSite, mesh_base, name_from, open_use
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import YamlFault, YamlMap, YamlScalar

MAX_DEPTH = 50
MAX_MODULES = 10_000

_LEFT_OUT = frozenset({"parameters", "variables", "packages", "modules"})


def expand(
    spec: SpecFile, arguments: Arguments, loader: Loader, sink: Diagnostics, *, unset: Unset = Unset.ERROR
) -> Instance:
    """Compute every expression of a file and of the modules it uses.

    What is at fault is reported and stands as a YamlFault; a module that cannot be had is an Instance without a
    tree. `unset` says what it is when nothing sets a required parameter of the compiled file.
    """
    return _Expansion(spec, loader, sink, unset).instance(_Use(spec, Given(arguments, sink)))


@dataclass(frozen=True, slots=True)
class _Use:
    """One use of a file: by an entry in the file of the `outer` use, or the compiled file itself."""

    spec: SpecFile
    given: Given
    entry: ModuleEntry | None = None
    outer: _Use | None = None

    @property
    def chain(self) -> tuple[_Use, ...]:
        """The use itself and those around it, the compiled file last."""
        return (self, *self.outer.chain) if self.outer else (self,)

    @property
    def trail(self) -> tuple[Span, ...]:
        """Every `use` that led here, the last one first."""
        return tuple(use.given.use for use in self.chain if use.given.use)


class _Expansion:
    """One compile: what all its uses share, and how many there are."""

    def __init__(self, compiled: SpecFile, loader: Loader, sink: Diagnostics, unset: Unset) -> None:
        self._compiled = compiled
        self._loader = loader
        self._sink = sink
        self._unset = unset
        self._expressions = Expressions()
        self._modules_read = 0

    def instance(self, use: _Use) -> Instance:
        """Expand one use of one file, and all that it uses."""
        names = FileNames(use.spec, use.given, self._unset, self._expressions, used_from(self._sink, use.trail))
        names.judge_parameters()
        tree = names.tree.node(_robot_part(use.spec.tree))
        assert isinstance(tree, YamlMap), "a map that is computed is a map"
        modules = self._modules(use, names.tree)
        names.judge_unused_variables()
        if use.entry is None:
            name = tree.get("name")
            return Instance(name.text if isinstance(name, YamlScalar) else "", tree, modules=modules)
        return Instance(
            name=use.entry.name,
            tree=tree,
            entry=use.entry.ref,
            prefix=use.entry.prefix,
            mesh_base=mesh_base(use.spec, self._compiled),
            trail=use.trail,
            modules=modules,
        )

    def _modules(self, use: _Use, tree: TreeEvaluator) -> tuple[Instance, ...]:
        section = use.spec.tree.get("modules")
        if isinstance(section, YamlScalar):
            section = tree.node(section)
        if section is None or (isinstance(section, YamlScalar) and section.value is None):
            return ()
        if isinstance(section, YamlMap):
            packages = _packages(use.spec, tree)
            return tuple(
                self._module(read_entry(entry, tree, use.spec.folder, use.trail), use, tree, packages)
                for entry in section
            )
        if not isinstance(section, YamlFault):
            tree.sink.report(MODULES_NOT_MAP.at(section.span, found=found(section)))
        return (Instance("", None, SourceRef(YamlFault(section.span), None, use.trail)),)

    def _module(self, entry: ModuleEntry, outer: _Use, tree: TreeEvaluator, packages: Mapping[str, Path]) -> Instance:
        if entry.use is None:
            return _unread(entry)
        site = UseSite(entry.use.text, entry.use.span, outer.spec, packages)
        spec = open_use(site, self._loader, tree.sink)
        if spec is None:
            return _unread(entry)
        use = _Use(spec, Given(entry.arguments, tree.sink, entry.tree, entry.use.span), entry, outer)
        instance = self.instance(use) if self._is_bounded(use, tree.sink) else None
        return instance if instance and entry.is_named else _unread(entry)

    def _is_bounded(self, use: _Use, sink: Diagnostics) -> bool:
        """Whether a use leads on and to an end; reports why not."""
        where = use.given.use
        chain = use.chain
        files = [other.spec.file for other in chain]
        self._modules_read += 1
        if use.spec.file in files[1:]:
            sink.report(_circle(chain[: files.index(use.spec.file, 1) + 1], self._compiled))
        elif len(chain) > MAX_DEPTH:
            sink.report(USE_TOO_DEEP.at(where, limit=MAX_DEPTH))
        elif self._modules_read > MAX_MODULES:
            # Once is enough: every `use` behind this one is one too many as well.
            if self._modules_read == MAX_MODULES + 1:
                sink.report(TOO_MANY_MODULES.at(where, limit=f"{MAX_MODULES:,}"))
        else:
            return True
        return False


def _robot_part(tree: YamlMap) -> YamlMap:
    """Return what describes the robot, without what only computes it and the author's own keys."""
    kept = {name: entry for name, entry in tree.entries.items() if name not in _LEFT_OUT and not name.startswith("x-")}
    return YamlMap(kept, tree.span)


def _packages(spec: SpecFile, tree: TreeEvaluator) -> dict[str, Path]:
    """Return the folders that a file declares for packages, those that lead somewhere."""
    section = spec.tree.get("packages")
    folders = tree.node(section) if section else None
    return {
        entry.name: follow(spec.folder, entry.value.text) if spec.folder else Path(entry.value.text)
        for entry in (folders if isinstance(folders, YamlMap) else ())
        if isinstance(entry.value, YamlScalar) and (spec.folder is not None or Path(entry.value.text).is_absolute())
    }


def _unread(entry: ModuleEntry) -> Instance:
    """Return what stands for a module that could not be had; its arguments are judged, whatever they were for."""
    if entry.tree:
        for argument in entry.arguments.entries.values():
            entry.tree.value(argument.value)
    return Instance(entry.name, None, entry.ref, entry.prefix if entry.is_named else "")


def _circle(chain: tuple[_Use, ...], compiled: SpecFile) -> Diagnostic:
    """Tell of a chain of uses, the last one first, that ends in the file with which it begins."""
    path = [name_from(use.spec, compiled) for use in reversed(chain)]
    notes = [
        Note(f"'{name}' is used here", use.given.use)
        for name, use in zip(path[1:-1], reversed(chain[1:-1]), strict=True)
    ]
    return USE_CIRCLE.at(chain[0].given.use, path=" → ".join(path), notes=notes)
