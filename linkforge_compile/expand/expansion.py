"""Every use of every file, all that it says computed: for a robot that has expressions or modules."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import (
    MODULES_NOT_MAP,
    SRDF_BESIDE_SPEC,
    USE_CIRCLE,
    USE_TOO_DEEP,
)
from linkforge_compile.expand.annotating_sink import with_use_trace
from linkforge_compile.expand.arguments import Arguments, Unset
from linkforge_compile.expand.assembly import Instance, count_entries, own_name, robot_part
from linkforge_compile.expand.evaluate_tree import Expressions, TreeEvaluator
from linkforge_compile.expand.given import Given
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.module_entry import ModuleEntry, found, read_entry
from linkforge_compile.expand.names import FileNames, Shared, UseOfFile
from linkforge_compile.expand.own_names import asked_in
from linkforge_compile.expand.uses import (
    SPEC_ENDINGS,
    XACRO,
    MakeSite,
    PathSite,
    locate,
    mesh_base,
    mesh_finder,
    name_from,
    open_use,
)
from linkforge_compile.expand.variants import tell_unknown_variant, variants_of
from linkforge_compile.expressions import FAULT, Fault
from linkforge_compile.schema.shapes import FREE, shapes
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.syntax import YamlFault, YamlMap, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.expand.xacro import XacroUse

MAX_DEPTH = 50


def expanded(
    spec: SpecFile, arguments: Arguments, loader: Loader, sink: Diagnostics, *, unset: Unset, variant: str | None
) -> Instance:
    """Compute every expression of a file and of the modules it uses; see `expand`."""
    if variant is not None and variant not in variants_of(spec):
        tell_unknown_variant(variant, spec, sink)
        # Nobody knows what it would have set.
        arguments = replace(arguments, is_partial=True)
    shared = Shared(spec, loader, Expressions(loader.budget), unset, variant)
    return _Expansion(spec, shared, sink).instance(_Use(spec, Given(arguments, sink)))


@dataclass(frozen=True)
class _Use:
    """One use of a file: by an entry in the file of the `outer` use, or the compiled file itself."""

    spec: SpecFile
    given: Given
    entry: ModuleEntry | None = None
    outer: _Use | None = None
    sites_around: Mapping[SourceFile, MakeSite] = field(default_factory=dict)

    @property
    def chain(self) -> tuple[_Use, ...]:
        """The use itself and those around it, the compiled file last."""
        return (self, *self.outer.chain) if self.outer else (self,)

    @property
    def prefix(self) -> str | Fault:
        """What is put before every name of the file in the end; FAULT where a part of it is at fault."""
        if self.entry is None or self.outer is None:
            return ""
        outer = self.outer.prefix
        return outer + self.entry.prefix if self.entry.is_named and not isinstance(outer, Fault) else FAULT

    @property
    def trail(self) -> tuple[Span, ...]:
        """Every `use` that led here, the last one first."""
        return tuple(use.given.use for use in self.chain if use.given.use)


class _Expansion:
    """One compile: what all its uses share, and how many there are."""

    def __init__(self, compiled: SpecFile, shared: Shared, sink: Diagnostics) -> None:
        self._compiled = compiled
        self._shared = shared
        self._sink = sink
        self._used: set[SourceFile] = set()

    def instance(self, use: _Use) -> Instance:
        """Expand one use of one file, and all that it uses."""
        if use.spec.file in self._used:
            self._shared.expressions.write_again(use.spec.tree, use.given.use or use.spec.file.whole)
        self._used.add(use.spec.file)
        file = UseOfFile(use.spec, use.given, use.prefix, use.trail)
        names = FileNames(file, self._shared, with_use_trace(self._sink, use.trail))
        names.judge_parameters()
        tree, defaults = _tree(use, names.tree), None
        if use.spec.tree.get("defaults") is not None:
            from linkforge_compile.expand.defaults import defaults_of, with_defaults

            defaults = defaults_of(use.spec.tree, names.tree)
            tree = with_defaults(tree, defaults) if defaults else tree
        entries, removed = tuple(_entries(use, names.tree)), names.tree.disabled.removed
        asked = names.own.asked
        if use.entry and use.entry.overrides:
            from linkforge_compile.expand.module_overrides import Body

            body = Body(tree, entries, removed).under(*use.entry.overrides)
            asked = asked_in(asked, tree, body.tree) if asked else asked
            tree, entries, removed = body.tree, body.entries, body.removed
        count_entries(tree, len(use.chain), self._shared.loader.budget, use.given.use)
        modules = tuple(self._module(entry, use, names) for entry in entries)
        names.judge_unused_variables()
        if use.entry is None:
            instance = Instance(own_name(tree), tree)
        else:
            instance = Instance(use.entry.name, tree, use.entry.ref, use.entry.prefix, trail=use.trail)
        return replace(
            instance,
            mesh_bases=self._mesh_bases(use),
            find_mesh=mesh_finder(_sites(use, names), self._shared.loader),
            modules=modules,
            references=asked,
            removed=removed,
            packages=names.packages,
            defaults=defaults,
        )

    def _mesh_bases(self, use: _Use) -> dict[SourceFile, str]:
        """Return what makes a path of the compiled file of one that this use's files wrote, or those around it."""
        files = [part for one in reversed(use.chain) for part in (one.spec, *one.spec.included.values())]
        return {part.file: mesh_base(part, self._compiled) for part in files if part.folder is not None}

    def _module(self, entry: ModuleEntry, outer: _Use, names: FileNames) -> Instance:
        if entry.use is None:
            return _unread(entry)
        sink = names.tree.sink
        spec, arguments = self._robot(entry, names.own.site(entry.use.text, entry.use.span), names)
        if spec is None:
            return _unread(entry)
        given = Given(arguments, sink, entry.tree, entry.use.span)
        use = _Use(spec, given, entry, outer, _sites(outer, names))
        instance = self.instance(use) if self._is_bounded(use, sink) else None
        return instance if instance and entry.is_named else _unread(entry)

    def _robot(self, entry: ModuleEntry, site: PathSite, names: FileNames) -> tuple[SpecFile | None, Arguments]:
        """Return the file that an entry uses, and the arguments that are left for it.

        Those of a xacro are spent on it, and on that of its SRDF: both take what they have of them.
        """
        loader, sink = self._shared.loader, names.tree.sink
        srdf = entry.ref.node.child("srdf")
        if not isinstance(srdf, YamlScalar):
            return self._opened(entry, site, frozenset(), sink)
        if site.text.lower().endswith(SPEC_ENDINGS):
            sink.report(SRDF_BESIDE_SPEC.at(srdf.span, path=site.text))
            return None, entry.arguments
        from linkforge_compile.expand.semantic import open_semantic, with_semantic

        beside = self._to_expand(names.own.site(srdf.text, srdf.span), entry, sink)
        semantic = open_semantic(beside, loader, sink) if beside else None
        taken = semantic.arguments if semantic else None if beside else frozenset[str]()
        spec, arguments = self._opened(entry, site, taken, sink)
        if spec is None or semantic is None or beside is None:
            return None, arguments
        return with_semantic(spec, semantic, beside, loader, sink), arguments

    def _opened(
        self, entry: ModuleEntry, site: PathSite, taken: frozenset[str] | None, sink: Diagnostics
    ) -> tuple[SpecFile | None, Arguments]:
        """Return the file at a site, and the arguments that are left for it of those that its SRDF has not `taken`.

        None for an SRDF that could not be read: it may have taken any.
        """
        loader = self._shared.loader
        if not site.text.lower().endswith(XACRO):
            return open_use(site, loader, sink), entry.arguments.without(taken or ())
        from linkforge_compile.expand.xacro import open_xacro

        xacro = self._to_expand(site, entry, sink)
        return open_xacro(replace(xacro, taken=taken), loader, sink) if xacro else None, Arguments()

    def _to_expand(self, site: PathSite, entry: ModuleEntry, sink: Diagnostics) -> XacroUse | None:
        """Return the use of a file with the arguments of an entry."""
        from linkforge_compile.expand.xacro import XacroUse

        target = locate(site, self._shared.loader, sink)
        if target is None:
            return None
        return XacroUse(target.path, site.used, entry.arguments, entry.tree, site.packages, target.package)

    def _is_bounded(self, use: _Use, sink: Diagnostics) -> bool:
        """Whether a use leads on and to an end; reports why not."""
        where = use.given.use
        chain = use.chain
        files = [other.spec.file for other in chain]
        if use.spec.file in files[1:]:
            sink.report(_circle(chain[: files.index(use.spec.file, 1) + 1], self._compiled))
        elif len(chain) > MAX_DEPTH:
            sink.report(USE_TOO_DEEP.at(where, limit=MAX_DEPTH))
        else:
            return True
        return False


def _sites(use: _Use, names: FileNames) -> dict[SourceFile, MakeSite]:
    """Return how paths are read that a use's files wrote, and those around it."""
    return {**use.sites_around, **dict.fromkeys((use.spec.file, *use.spec.included), names.own.site)}


def _tree(use: _Use, tree: TreeEvaluator) -> YamlMap:
    """Return what a file says of the robot, computed, without its defaults."""
    computed = tree.node(robot_part(use.spec.tree), shapes())
    assert isinstance(computed, YamlMap), "a map that is computed is a map"
    return computed


def _entries(use: _Use, tree: TreeEvaluator) -> Iterator[ModuleEntry]:
    """Yield the entries of `modules`, each as often as it says; one without a name for what nobody can read."""
    written = use.spec.tree.get("modules")
    shape = shapes().under("modules")
    section = tree.node(written, shape, key="modules") if isinstance(written, YamlScalar) else written
    if isinstance(section, YamlMap):
        shape = shape if section is written else FREE
        for scope, entry in tree.entries(section, shape):
            yield read_entry(entry, scope, use.spec.part_at(entry.key.span).folder, use.trail)
    elif section is not None and not (isinstance(section, YamlScalar) and section.value is None):
        if not isinstance(section, YamlFault):
            tree.sink.report(MODULES_NOT_MAP.at(section.span, found=found(section)))
        yield ModuleEntry("", SourceRef(YamlFault(section.span), None, use.trail), is_named=False)


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
