"""A cache of modules for compiles of one spec that differ in some parameters, such as those of a sweep.

What a module becomes is kept with what making it did to its compile: the files that it read, what it spent of the
budget, and its warnings. A later compile that uses the module does the same, so that its result is that of a compile
without the cache:

- Nothing in such a module can differ, by the text of the files (`varied`) and the values of `for`.
- It is used only after the same files were read and may be read: the first use of a file reads it and pays for it.
- It is kept only while its compile has no errors. An error is reported once, perhaps by a part that a later compile
  lacks; everywhere else, what depends on it is missing without a message.
- Texts are the same SourceFile in all compiles, so that a warning that two modules have is still one.

The caller repeats a compile that has errors without the cache: one that exceeds a limit would perhaps not do so alone.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable
from functools import partial
from typing import NamedTuple, TypeVar, cast

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.instance import Instance
from linkforge_compile.expand.varied import Varied, varied_in_modules
from linkforge_compile.limits import Limit
from linkforge_compile.load.files_read import FilesRead
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.spec_tree import Place
from linkforge_compile.source import Located, SourceFile, Span
from linkforge_compile.syntax import YamlMap, YamlScalar

T = TypeVar("T")

_MOST = 4
"""How many results are kept for one use of a module, made after different files were read."""


class _Kept(NamedTuple):
    """What was made, what it depends on besides the use, and what making it reported, read and spent."""

    value: object
    given: tuple[object, ...]
    diagnostics: tuple[Diagnostic, ...]
    read: FilesRead
    spent: dict[Limit, int]


class ModuleCache:
    """The modules of compiles that differ in nothing but the values of some parameters and the variant.

    Their files must stay as they are.
    """

    def __init__(self, varied: Iterable[str]) -> None:
        """`varied` are the parameters of the spec whose values differ."""
        self.varied = frozenset(varied)
        self.sources: dict[Place, SourceFile] = {}
        """The texts of all compiles."""
        self.kept: defaultdict[Hashable, deque[_Kept]] = defaultdict(partial(deque, maxlen=_MOST))
        self._varied_in: dict[Hashable, dict[str, Varied]] = {}

    def of_compile(self, variant: str | None, loader: Loader, sink: Diagnostics) -> CacheOfCompile:
        """Return what one compile uses, whose files and limits are those of a loader."""
        return CacheOfCompile(self, variant, loader, sink)

    def varied_in(self, spec: SpecFile, varied: Varied, module: Located | None) -> Varied:
        """Return what may differ in a module of a file, by its key as written."""
        if varied is None or not isinstance(module, YamlScalar):
            return None
        key = (spec.file, *spec.included, varied)
        if key not in self._varied_in:
            self._varied_in[key] = varied_in_modules(spec.tree, varied)
        return self._varied_in[key].get(module.text)


class CacheOfCompile:
    """The cache as one compile uses it."""

    def __init__(self, cache: ModuleCache, variant: str | None, loader: Loader, sink: Diagnostics) -> None:
        self.varied, self.varied_in = cache.varied, cache.varied_in
        self._cache = cache
        self._variant, self._loader, self._sink = variant, loader, sink
        self._trees: set[YamlMap | None] = set()
        self._named_files = loader.named_files_outside
        self._is_making = False

    def expanded(self, use: Hashable, place: Span, make: Callable[[], Instance]) -> Instance:
        """Return the Instance of a module in which nothing differs; `use` identifies the use in the robot."""
        instance = self._once(("expanded", use), (), place, make)
        if not self._is_making:
            self._trees.add(instance.tree)
        return instance

    def has(self, module: Instance) -> bool:
        """Whether an Instance is from `expanded`, and not a part of one."""
        return module.tree is not None and module.tree in self._trees

    def lowered(self, module: Instance, given: Hashable, make: Callable[[], T]) -> T:
        """Return what an Instance of `expanded` is lowered to, which also depends on what is `given`."""
        use = tuple((place, place.module) for place in module.include_stack)
        return self._once(("lowered", use), (module.tree, given), module.include_stack[0], make)

    def _once(self, key: Hashable, given: tuple[object, ...], place: Span, make: Callable[[], T]) -> T:
        """Return what an earlier compile made, and replay what making it did; or make it, and keep it."""
        if self._is_making:
            return make()  # it is a part of what is being made
        loader = self._loader
        given = (*given, self._named_files, loader.files_read.names)
        kept = self._cache.kept[self._variant, key]
        found = next((one for one in kept if one.given == given), None)
        if found is None:
            return self._make(kept, given, make)
        for limit, amount in found.spent.items():
            loader.budget.spend(limit, amount, place)
        loader.files_read.add(found.read)
        self._sink.report_all(found.diagnostics)
        return cast("T", found.value)

    def _make(self, kept: deque[_Kept], given: tuple[object, ...], make: Callable[[], T]) -> T:
        budget, files = self._loader.budget, self._loader.files_read
        left, read = budget.left_of_all, files.copy()
        self._is_making = True
        try:
            with self._sink.recording() as diagnostics:
                value = make()
        finally:
            self._is_making = False
        if not self._sink.has_errors:
            spent = {limit: left[limit] - now for limit, now in budget.left_of_all.items() if now != left[limit]}
            kept.append(_Kept(value, given, tuple(diagnostics), files.since(read), spent))
        return value
