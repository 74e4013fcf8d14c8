"""Expand each use of each file: compute its tree, apply defaults and overrides, and go on with its modules."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import DeletedNames, Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import MACRO_OF_NO_XACRO, SRDF_BESIDE_SPEC, USE_CYCLE, USE_TOO_DEEP
from linkforge_compile.expand.arguments import Arguments, Unset, report_unknown_variants, xacro_arguments
from linkforge_compile.expand.defaults import compute_defaults, with_defaults
from linkforge_compile.expand.evaluate import Evaluator, Expressions
from linkforge_compile.expand.expand_tree import expand_node
from linkforge_compile.expand.file_scope import CompileState, FileScope, Use
from linkforge_compile.expand.instance import Instance, NameReference, charge_entries, own_name, robot_part
from linkforge_compile.expand.module_cache import CacheOfCompile
from linkforge_compile.expand.modules import ModuleEntry, apply_override, read_modules
from linkforge_compile.expand.parameter_values import BoundArguments
from linkforge_compile.expand.varied import Varied
from linkforge_compile.load.loader import Loader, SpecFile, with_use_trace
from linkforge_compile.load.locations import (
    SPEC_ENDINGS,
    PathSite,
    is_xacro,
    locate,
    mesh_base,
    mesh_finder,
    name_from,
    names_xacro,
    open_use,
)
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.nodes import leaves_in

if TYPE_CHECKING:
    from linkforge_compile.load.xacro import Expansion, XacroUse

MAX_DEPTH = 50


def expand_uses(
    spec: SpecFile,
    arguments: Arguments,
    loader: Loader,
    sink: Diagnostics,
    *,
    unset: Unset,
    variant: str | None,
    cache: CacheOfCompile | None = None,
) -> Instance:
    """Compute every expression of a file and of the modules that it uses; see `expand`."""
    if report_unknown_variants(variant, spec, sink):
        # It may have set parameters, so missing ones are not reported.
        arguments = replace(arguments, is_partial=True)
    state = CompileState(spec, loader, Expressions(loader.budget), unset, variant, cache)
    varied = cache.varied if cache else None
    return _Expander(state, sink).expand(Use(spec, BoundArguments(arguments, sink), varied=varied))


class _Expander:
    """One compile: its shared state, and the files used so far."""

    def __init__(self, state: CompileState, sink: Diagnostics) -> None:
        self._state = state
        self._sink = sink
        self._used: set[SourceFile] = set()

    def expand(self, use: Use) -> Instance:
        """Expand one use of one file, and all that it uses."""
        if use.spec.file in self._used:
            self._state.expressions.charge_copy(use.spec.tree, use.bound.use or use.spec.file.whole)
        self._used.add(use.spec.file)
        stack = use.include_stack
        scope = FileScope(use, self._state, with_use_trace(self._sink, stack))
        scope.check_parameters()
        tree, defaults = _robot_tree(use.spec, scope.evaluator)
        entries = tuple(read_modules(use.spec, scope.evaluator, stack))
        removed = DeletedNames(scope.evaluator.disabled, scope.evaluator.disabled_prefixes)
        references = tuple(scope.references)
        written = tree
        for override in use.entry.overrides if use.entry else ():
            tree, entries, removed = apply_override(override, tree, entries, removed)
        if references and tree is not written:
            references = references_left(references, written, tree)
        charge_entries(tree, len(use.chain), self._state.loader.budget, use.bound.use)
        modules = tuple(self._module(entry, use, scope) for entry in entries)
        writers, compiled = use.writers(scope.packages), self._state.compiled
        scope.check_unused_variables()
        return Instance(
            use.entry.name if use.entry else own_name(tree),
            tree,
            entry=use.entry.ref if use.entry else None,
            prefix=use.entry.prefix if use.entry else "",
            mesh_bases={
                file: mesh_base(part, compiled) for file, (part, _) in writers.items() if part.folder is not None
            },
            include_stack=stack,
            modules=modules,
            references=references,
            find_mesh=mesh_finder(writers, self._state.loader),
            removed=removed,
            packages=scope.packages,
            defaults=defaults,
            overrides=tuple(one.patch for one in use.entry.overrides) if use.entry else (),
            names=scope.evaluator,
            spec=use.spec,
        )

    def _module(self, entry: ModuleEntry, outer: Use, scope: FileScope) -> Instance:
        """Return a module, from the cache if nothing in it differs from other compiles."""
        cache = self._state.cache
        varied = cache.varied_in(outer.spec, outer.varied, entry.ref.key) if cache else None
        make = partial(self._expand_module, entry, outer, scope, varied)
        if cache is None or varied != frozenset():
            return make()
        use = tuple(each.copy_in_file for each in (entry, *(around.entry for around in outer.chain)) if each)
        instance = cache.expanded(use, entry.ref.span, make)
        self._used.update(each.spec.file for each in instance.with_modules if each.spec)
        # A macro gives the entry other fields, which do not differ either.
        return instance if entry.ref.node.child("macro") is not None else replace(instance, entry=entry.ref)

    def _expand_module(self, entry: ModuleEntry, outer: Use, scope: FileScope, varied: Varied) -> Instance:
        if entry.use is None:
            return _unread(entry)
        sink = scope.evaluator.sink
        spec, entry = self._open_robot(entry, scope.site(entry.use.text, entry.use.span), scope)
        if spec is None or entry.use is None:
            return _unread(entry)
        bound = BoundArguments(entry.arguments, sink, entry.use.span)
        if any("modules" in one.patch.entries for one in entry.overrides):
            varied = None  # what differs in its modules is decided by the file alone
        use = Use(spec, bound, entry, outer, outer.writers(scope.packages), varied)
        instance = self.expand(use) if self._is_bounded(use, sink) else None
        return replace(instance, shared_link=entry.shared_link) if instance and entry.is_named else _unread(entry)

    def _open_robot(self, entry: ModuleEntry, site: PathSite, scope: FileScope) -> tuple[SpecFile | None, ModuleEntry]:
        """Return the file that an entry uses with its SRDF merged, and the entry with what no xacro has used."""
        loader, sink = self._state.loader, scope.evaluator.sink
        srdf = entry.ref.node.child("srdf")
        if not isinstance(srdf, YamlScalar):
            return self._open(entry, site, frozenset(), sink)
        if site.text.lower().endswith(SPEC_ENDINGS):
            sink.report(SRDF_BESIDE_SPEC.at(srdf.span, path=site.text))
            return None, entry
        srdf_use = _xacro_use(scope.site(srdf.text, srdf.span), loader, sink)
        semantic = open_semantic(srdf_use, entry.arguments, loader, sink) if srdf_use else None
        # An SRDF that cannot be read may have used any argument.
        used = semantic.arguments if semantic else None if srdf_use else frozenset[str]()
        spec, entry = self._open(entry, site, used, sink)
        if spec is None or semantic is None or srdf_use is None:
            return None, entry
        return _with_semantic(spec, semantic, srdf_use, loader, sink), entry

    def _open(
        self, entry: ModuleEntry, site: PathSite, used: frozenset[str] | None, sink: Diagnostics
    ) -> tuple[SpecFile | None, ModuleEntry]:
        """Return the file at a site, and the entry with what is left for it; its SRDF has `used` some, None if unknown.

        A macro of the file may have used other fields of the entry.
        """
        loader, macro = self._state.loader, entry.ref.node.child("macro")
        if not names_xacro(site, loader):
            if isinstance(macro, YamlScalar):
                sink.report(MACRO_OF_NO_XACRO.at(macro.span, path=site.text))
                return None, entry
            return open_use(site, loader, sink), replace(entry, arguments=entry.arguments.without(used or ()))
        use = _xacro_use(site, loader, sink)
        texts = xacro_arguments(entry.arguments, sink, takes_maps=macro is not None)
        entry = replace(entry, arguments=Arguments())
        if use is None:
            return None, entry
        if isinstance(macro, YamlScalar):
            from linkforge_compile.expand.macro_module import open_macro

            return open_macro(replace(use, arguments=texts), macro, entry, loader, sink)
        from linkforge_compile.load.xacro import open_xacro

        return open_xacro(replace(use, arguments=texts, used_elsewhere=used), loader, sink), entry

    def _is_bounded(self, use: Use, sink: Diagnostics) -> bool:
        """Whether a use is neither circular nor too deep; reports why not."""
        files = [other.spec.file for other in use.chain]
        if use.spec.file in files[1:]:
            sink.report(_cycle(use.chain[: files.index(use.spec.file, 1) + 1], self._state.compiled))
        elif len(files) > MAX_DEPTH:
            sink.report(USE_TOO_DEEP.at(use.bound.use, limit=MAX_DEPTH))
        else:
            return True
        return False


def _robot_tree(spec: SpecFile, evaluator: Evaluator) -> tuple[YamlMap, YamlMap | None]:
    """Return the computed tree of a file with its defaults merged, and the defaults, None for none."""
    tree = expand_node(robot_part(spec.tree), evaluator, shapes())
    assert isinstance(tree, YamlMap), "a map that is computed is a map"
    if spec.tree.get("defaults") is None:
        return tree, None
    defaults = compute_defaults(spec.tree, evaluator)
    return with_defaults(tree, defaults) if defaults else tree, defaults


def _unread(entry: ModuleEntry) -> Instance:
    """Return the Instance of a module that cannot be read; faults in its arguments are still reported."""
    if evaluator := entry.arguments.evaluator:
        for argument in entry.arguments.entries.values():
            evaluator.value(argument.value)
    return Instance(entry.name, None, entry.ref, entry.prefix if entry.is_named else "")


def _cycle(chain: tuple[Use, ...], compiled: SpecFile) -> Diagnostic:
    """Return the diagnostic for a chain of uses, the innermost first, that ends in the file it starts with."""
    path = [name_from(use.spec, compiled) for use in reversed(chain)]
    notes = [
        Note(f"'{name}' is used here", use.bound.use)
        for name, use in zip(path[1:-1], reversed(chain[1:-1]), strict=True)
    ]
    return USE_CYCLE.at(chain[0].bound.use, path=" → ".join(path), notes=notes)


def references_left(
    references: Iterable[NameReference], before: YamlNode, after: YamlNode
) -> tuple[NameReference, ...]:
    """Return the references in texts that an override has not removed from a tree."""
    removed = {Span(*leaf.span) for leaf in leaves_in(before)} - {Span(*leaf.span) for leaf in leaves_in(after)}
    return tuple(one for one in references if not any(map(one.where.span.lies_in, removed)))


def open_semantic(use: XacroUse, arguments: Arguments, loader: Loader, sink: Diagnostics) -> Expansion | None:
    """Read an SRDF, expanded with the arguments if it is a xacro; None after a reported error."""
    from linkforge_compile.load.xacro import Expansion, expand_xacro

    if loader.roots.hold(use.path) and is_xacro(use.path):
        # The URDF, which is read next, reports arguments that neither of the two uses.
        use = replace(use, arguments=xacro_arguments(arguments, sink), used_elsewhere=None)
        return expand_xacro(use, loader, sink)
    file = loader.open_xml(use.path, sink, use.used if use.used.where else None)
    return Expansion(file, (file,)) if file else None


def _xacro_use(site: PathSite, loader: Loader, sink: Diagnostics) -> XacroUse | None:
    """Return what a site names as a xacro, without arguments; None after a reported error."""
    from linkforge_compile.load.xacro import XacroUse

    target = locate(site, loader, sink)
    return XacroUse(target.path, site.used, packages=site.packages, package=target.package) if target else None


def _with_semantic(
    spec: SpecFile, semantic: Expansion, use: XacroUse, loader: Loader, sink: Diagnostics
) -> SpecFile | None:
    """Return a robot with its SRDF merged; None after a reported error. `use` names the SRDF."""
    from linkforge_compile.importers.document import Comments, Imported
    from linkforge_compile.importers.srdf_with_urdf import with_srdf

    def merged(tree: YamlMap) -> SpecFile:
        parts = {file: SpecFile(file, tree, use.path.parent, use.package) for file in semantic.files}
        return replace(spec, tree=tree, included={**spec.included, **parts})

    imported = Imported(spec.tree, Comments({}, {}), renamed=spec.renamed)
    inside = with_use_trace(sink, (use.used.where,))
    read = with_srdf(
        imported, semantic.text, lambda tree: loader.check_spec(merged(tree), loader), inside, semantic.moved
    )
    return merged(read[0].tree) if read else None
