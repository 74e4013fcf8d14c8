"""Compare what migrated specs compile to with what xacro expands, for combinations of the arguments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.analysis import Settings
from linkforge_compile.compare import compare
from linkforge_compile.compilation import Compilation
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.importing import as_read_back, import_urdf
from linkforge_compile.migration.combinations import OTHER_WORD, Arguments
from linkforge_compile.migration.without_effect import leave_out
from linkforge_compile.pipeline import compile_path, compile_text

if TYPE_CHECKING:
    from linkforge_compile.core import Robot

TOLERANCE = 1e-9
"""The relative error that a number may have, and the absolute one of a pose [m, rad]: that of another order of sums."""


class Comparison(NamedTuple):
    """One combination: what differs, and why there is nothing to compare, if so.

    `refused` is what is wrong with the xacro for these arguments: then nothing is proved. `fault` is what is wrong with
    the spec.
    """

    arguments: Arguments
    differences: tuple[str, ...] = ()
    refused: str | None = None
    fault: str | None = None

    @property
    def is_equal(self) -> bool:
        return not (self.differences or self.fault or self.refused)


class Prover:
    """Proves the specs of one xacro; the robots that xacro expands are kept for the next attempt."""

    def __init__(self, main: Path, packages: Mapping[str, Path], *, allow_outside: bool) -> None:
        self._main, self._packages, self._allow_outside = main, packages, allow_outside
        self._expanded: dict[tuple[tuple[str, str], ...], Robot | str] = {}

    def compare(self, spec: Path, names: Mapping[str, str], combinations: Iterable[Arguments]) -> list[Comparison]:
        """Return the comparison of each combination; `names` are those of the parameters by argument."""
        compared = (self._compared(spec, names, arguments) for arguments in combinations)
        return [one for one in compared if not (one.refused and OTHER_WORD in one.arguments.values())]

    def compiled(self, spec: Path, names: Mapping[str, str], combinations: Iterable[Arguments]) -> Iterator[Robot]:
        """Yield the robots that a spec compiles to."""
        for arguments in combinations:
            robot = self._compile(spec, names, arguments).robot
            if robot is not None:
                yield robot

    def _compile(self, spec: Path, names: Mapping[str, str], arguments: Arguments) -> Compilation:
        pairs = [f"{names[name]}={value}" for name, value in arguments.items() if name in names]
        return compile_path(spec, Settings(pairs, {**self._packages}, allow_outside=True))

    def _compared(self, spec: Path, names: Mapping[str, str], arguments: Arguments) -> Comparison:
        expected = self._expansion(arguments)
        if isinstance(expected, str):
            return Comparison(arguments, refused=expected)
        compilation = self._compile(spec, names, arguments)
        if compilation.robot is None:
            return Comparison(arguments, fault=_first_error(compilation.diagnostics))
        back, _ = as_read_back(compilation.robot)
        robot = back or compilation.robot
        leave_out(robot)
        found = compare(expected, robot, tolerance=TOLERANCE, semantic=False)
        return Comparison(arguments, tuple(f"{'/'.join(one.path)}: {one.text}" for one in found))

    def _expansion(self, arguments: Arguments) -> Robot | str:
        key = tuple(sorted(arguments.items()))
        if key not in self._expanded:
            self._expanded[key] = self._expand(arguments)
        return self._expanded[key]

    def _expand(self, arguments: Arguments) -> Robot | str:
        pairs = [f"{name}:={value}" for name, value in arguments.items()]
        imported = import_urdf(
            self._main, arguments=pairs, packages={**self._packages}, allow_outside=self._allow_outside
        )
        if imported.text is None:
            return _first_error(imported.diagnostics)
        compilation = compile_text(
            imported.text,
            name=str(self._main),
            folder=self._main.parent,
            packages={**self._packages},
            allow_outside=True,
        )
        if compilation.robot is None:
            return _first_error(compilation.diagnostics)
        leave_out(compilation.robot)
        return compilation.robot


def _first_error(diagnostics: Iterable[Diagnostic]) -> str:
    errors = [one for one in diagnostics if one.severity is Severity.ERROR]
    if not errors:
        return "unknown"
    where = errors[0].span
    place = f"{where.file.shown}:{where.line}: " if where else ""
    return f"{place}{errors[0].message} [{errors[0].code.id}]"
