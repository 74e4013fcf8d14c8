"""Modules that several compiles of one spec share, with all that making them does to a compile."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import NamedTuple, TypeAlias, TypeVar, cast

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.instance import Instance
from linkforge_compile.expand.varied import varied_in_modules
from linkforge_compile.limits import Limit
from linkforge_compile.load.files_read import FilesRead
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.spec_tree import Place
from linkforge_compile.source import SourceFile, Span

T = TypeVar("T")

_Names: TypeAlias = tuple[str, ...]

VariedInModules: TypeAlias = dict[str, "frozenset[str] | None"]
"""The parameters of each module that may vary, by its key as written; None if more of it may vary."""


class _Made(NamedTuple):
    """What was made, from what, and what making it reported, read and spent."""

    value: object
    given: tuple[object, ...]
    diagnostics: tuple[Diagnostic, ...]
    read: FilesRead
    spent: dict[Limit, int]


class SharedModules:
    """The modules that compiles of one spec share, which differ in nothing but parameters and the variant.

    Their files may not change meanwhile.
    """

    def __init__(self, varied: Iterable[str]) -> None:
        """`varied` are the parameters of the spec whose values differ."""
        self.varied = frozenset(varied)
        self.sources: dict[Place, SourceFile] = {}
        """The texts of earlier compiles; what is shared has places in them."""
        self.made: dict[Hashable, _Made] = {}
        self._varied_in: dict[tuple[object, ...], VariedInModules] = {}

    def of_compile(self, variant: str | None, loader: Loader, sink: Diagnostics) -> Sharing:
        """Return how one compile shares them."""
        return Sharing(self, variant, loader, sink)

    def varied_in_modules(self, spec: SpecFile, varied: frozenset[str]) -> VariedInModules:
        """Return what may vary in the modules of a file, `varied` of whose parameters may."""
        key = (spec.file, *spec.included, varied)
        if key not in self._varied_in:
            self._varied_in[key] = varied_in_modules(spec.tree, varied)
        return self._varied_in[key]


class Sharing:
    """The modules that one compile shares with earlier and later ones."""

    def __init__(self, shared: SharedModules, variant: str | None, loader: Loader, sink: Diagnostics) -> None:
        self.shared = shared
        self._variant, self._loader, self._sink = variant, loader, sink
        self._named_files = loader.named_files  # which modules may read
        self._names: set[_Names] = set()
        self._is_making = False

    def expanded(self, names: _Names, place: Span, make: Callable[[], Instance]) -> Instance:
        """Return a module, which an entry at a place uses; `names` are its own and those of the modules around it."""
        self._names.add(names)
        return self._once(("expanded", *names), (place,), place, make)

    def has(self, module: Instance) -> bool:
        """Whether a module is shared; those inside of it are shared with it."""
        return _names_of(module) in self._names

    def lowered(self, module: Instance, given: Hashable, make: Callable[[], T]) -> T:
        """Return what a shared module is lowered to, which also depends on what is `given`."""
        return self._once(("lowered", *_names_of(module)), (module.tree, given), module.include_stack[0], make)

    def _once(self, key: _Names, given: tuple[object, ...], place: Span, make: Callable[[], T]) -> T:
        """Return what an earlier compile made under a key of the same, and do to this compile what making it did."""
        if self._is_making:
            return make()
        loader, whole = self._loader, (self._variant, *key)
        given = (*given, self._named_files, *loader.files_read.sources)
        made = self.shared.made.get(whole)
        if made is None or made.given != given or not loader.budget.allows(made.spent):
            made = self.shared.made[whole] = self._make(given, make)
        else:
            for limit, amount in made.spent.items():
                loader.budget.spend(limit, amount, place)
            loader.files_read.add(made.read)
            self._sink.report_all(made.diagnostics)
        return cast("T", made.value)

    def _make(self, given: tuple[object, ...], make: Callable[[], object]) -> _Made:
        loader = self._loader
        files, left = loader.files_read.copy(), loader.budget.left_of_all
        self._is_making = True
        try:
            with self._sink.recording() as diagnostics:
                value = make()
        finally:
            self._is_making = False
        spent = {limit: left[limit] - now for limit, now in loader.budget.left_of_all.items() if now != left[limit]}
        return _Made(value, given, tuple(diagnostics), loader.files_read.since(files), spent)


def _names_of(module: Instance) -> _Names:
    return tuple(use.module for use in reversed(module.include_stack))
