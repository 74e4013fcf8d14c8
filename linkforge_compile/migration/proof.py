"""Compare what migrated specs compile to with what xacro expands, for combinations of the arguments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.analysis import Settings
from linkforge_compile.compare import compare
from linkforge_compile.compilation import Compilation
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.diagnostics.codes.modules import OUTSIDE_ROOTS
from linkforge_compile.importing import as_read_back, import_urdf
from linkforge_compile.load import Loader
from linkforge_compile.migration.combinations import Arguments
from linkforge_compile.migration.deadline import Deadline
from linkforge_compile.migration.plain_paths import with_plain_paths
from linkforge_compile.migration.without_effect import leave_out
from linkforge_compile.pipeline import compile_path, compile_source
from linkforge_compile.roots import identity

if TYPE_CHECKING:
    from linkforge_compile.core import Robot

TOLERANCE = 1e-9
"""The relative error that a number may have, and the absolute one of a pose [m, rad]: that of another order of sums."""


class Comparison(NamedTuple):
    """One combination: what differs, and why there is nothing to compare, if so.

    `refused` is what is wrong with the xacro for these arguments: then nothing is proved. `fault` is what is wrong with
    the spec, and `errors` are those of its compile. `is_late` if the time was over before.
    """

    arguments: Arguments
    differences: tuple[str, ...] = ()
    refused: str | None = None
    fault: str | None = None
    is_late: bool = False
    errors: tuple[Diagnostic, ...] = ()

    @property
    def is_equal(self) -> bool:
        return not (self.is_failure or self.refused or self.is_late)

    @property
    def is_failure(self) -> bool:
        return bool(self.differences or self.fault)


class Specs(NamedTuple):
    """Specs to compare: the path of the robot's, the names of its parameters by argument, and texts that are no files.

    The `texts` are by file name, in the folder of the robot's.
    """

    path: Path
    names: Mapping[str, str]
    texts: Mapping[str, str] = MappingProxyType({})


class Prover:
    """Proves the specs of one xacro; the robots that xacro expands are kept for the next attempt."""

    def __init__(self, main: Path, loader: Loader, deadline: Deadline | None = None) -> None:
        """`loader` has the packages, and whether the user allows to read anything."""
        self._main, self._deadline = main, deadline or Deadline()
        self._settings = Settings((), {**loader.packages}, allow_outside=loader.roots.is_anywhere)
        self._translations = 0
        self._expanded: dict[tuple[tuple[str, str], ...], Robot | tuple[Diagnostic, ...]] = {}

    def compare(self, specs: Specs, combinations: Sequence[Arguments]) -> list[Comparison]:
        """Return the comparison of each combination."""
        compared: list[Comparison] = []
        self._translations += 1
        phase = f"translation {self._translations}: " if self._translations > 1 else ""
        for number, arguments in enumerate(combinations):
            self._deadline.tell(f"{phase}compared {number} of {len(combinations)} combinations of arguments")
            late = Comparison(arguments, is_late=True)
            compared.append(late if self._deadline.is_over else self._compared(specs, arguments))
        return compared

    def faults_of_xacro(self, arguments: Arguments) -> tuple[Diagnostic, ...]:
        """Return the errors in the robot that xacro expands."""
        expanded = self._expansion(arguments)
        return expanded if isinstance(expanded, tuple) else ()

    def compiled(self, specs: Specs, combinations: Iterable[Arguments]) -> Iterator[Robot]:
        """Yield the robots that specs compile to."""
        for arguments in combinations:
            robot = self._compile(specs, arguments).robot
            if robot is not None:
                yield robot

    def outside_of(self, specs: Specs, arguments: Arguments) -> Diagnostic | None:
        """Return the report of a file that the xacro may read, and a compile of the specs alone may not."""
        alone = self._compile(specs, arguments, is_alone=True)
        return next((one for one in alone.diagnostics if one.code is OUTSIDE_ROOTS), None)

    def _compile(self, specs: Specs, arguments: Arguments, *, is_alone: bool = False) -> Compilation:
        pairs = [f"{specs.names[name]}={value}" for name, value in arguments.items() if name in specs.names]
        folder = specs.path.parent
        buffers = {identity(folder / name): text for name, text in specs.texts.items()}
        settings = self._settings._replace(parameters=pairs, buffers=buffers, beside=None if is_alone else self._main)
        return compile_path(specs.path, settings)

    def _compared(self, specs: Specs, arguments: Arguments) -> Comparison:
        expected = self._expansion(arguments)
        if isinstance(expected, tuple):
            return Comparison(arguments, refused=_first_error(expected))
        compilation = self._compile(specs, arguments)
        if compilation.robot is None:
            errors = _errors_in(compilation.diagnostics)
            return Comparison(arguments, fault=_first_error(errors), errors=errors)
        robot, faults = as_read_back(compilation.robot)
        if robot is None:
            return Comparison(arguments, fault=_first_error(faults))
        leave_out(robot)
        found = compare(expected, with_plain_paths(robot), tolerance=TOLERANCE, semantic=False)
        return Comparison(arguments, tuple(f"{'/'.join(one.path)}: {one.text}" for one in found))

    def _expansion(self, arguments: Arguments) -> Robot | tuple[Diagnostic, ...]:
        key = tuple(sorted(arguments.items()))
        if key not in self._expanded:
            self._expanded[key] = self._expand(arguments)
        return self._expanded[key]

    def _expand(self, arguments: Arguments) -> Robot | tuple[Diagnostic, ...]:
        pairs = [f"{name}:={value}" for name, value in arguments.items()]
        packages, allow_outside = self._settings.packages, self._settings.allow_outside
        imported = import_urdf(self._main, arguments=pairs, packages=packages, allow_outside=allow_outside)
        if imported.text is None:
            return _errors_in(imported.diagnostics)
        compilation = compile_source(imported.text, str(self._main), self._main.parent, self._settings)
        if compilation.robot is None:  # the import's errors have their places in the xacro
            return _errors_in(imported.diagnostics) or _errors_in(compilation.diagnostics)
        leave_out(compilation.robot)
        return with_plain_paths(compilation.robot)


def _errors_in(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(one for one in diagnostics if one.severity is Severity.ERROR)


def _first_error(diagnostics: Iterable[Diagnostic]) -> str:
    errors = _errors_in(diagnostics)
    if not errors:
        return "unknown"
    where = errors[0].span
    place = f"{where.file.shown}:{where.line}: " if where else ""
    return f"{place}{errors[0].message} [{errors[0].code.id}]"
