"""The compiler on one page: read, validate, expand, lower, check; rendering is what the result is for.

Values flow down, faults flow sideways into the sink, and no stage stops the line: one run tells everything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.backends import srdf_limits, urdf_limits
from linkforge_compile.checks import check
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Gaps
from linkforge_compile.lowering import lower
from linkforge_compile.modules import (
    Loader,
    SpecFile,
    Unset,
    arguments_from_text,
    arguments_from_values,
    expand,
)

if TYPE_CHECKING:
    from linkforge_compile.core import Robot

Parameters: TypeAlias = Mapping[str, object] | Iterable[str]
"""Values by name, as Python values or text with units; or `name=value` pairs as the command line has them."""

Packages: TypeAlias = Mapping[str, str | Path]
"""The folder that `package://NAME/` stands for, by name; they come before every other place to look."""


class CompileError(Exception):
    """A spec with errors was asked for its robot; `diagnostics` has every one of them."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        self.diagnostics = diagnostics
        super().__init__("\n".join(str(diagnostic) for diagnostic in diagnostics))

    def __reduce__(self) -> tuple[type[CompileError], tuple[tuple[Diagnostic, ...]]]:
        return CompileError, (self.diagnostics,)


@dataclass(frozen=True, slots=True)
class Compilation:
    """What one compile gave: the robot (None where the spec has errors) and all that was told about the spec.

    `files` lists every spec file that was read, the compiled one first.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...] = ()

    def result(self) -> Robot:
        """Return the robot; raise CompileError where the spec has errors."""
        if self.robot is None:
            raise CompileError(self.diagnostics)
        return self.robot


def compile_file(path: str | Path, *, parameters: Parameters = (), packages: Packages | None = None) -> Compilation:
    """Compile a spec file; a required parameter without a value is an error."""
    return _compile(lambda loader, sink: loader.open(Path(path), sink), parameters, packages, Unset.ERROR)


def compile_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters = (),
    packages: Packages | None = None,
) -> Compilation:
    """Compile a spec given as text; `name` stands in its diagnostics, `folder` is where relative paths start."""
    place = Path(folder) if folder is not None else None
    return _compile(lambda loader, sink: loader.parse(text, name, place, sink), parameters, packages, Unset.ERROR)


def check_file(path: str | Path, *, parameters: Parameters = (), packages: Packages | None = None) -> Compilation:
    """Tell all that is wrong with a spec file; what depends on a required parameter without a value is not judged."""
    return _compile(lambda loader, sink: loader.open(Path(path), sink), parameters, packages, Unset.NOTE)


def _compile(
    read: Callable[[Loader, Diagnostics], SpecFile | None],
    parameters: Parameters,
    packages: Packages | None,
    unset: Unset,
) -> Compilation:
    sink = Diagnostics()
    loader = Loader({name: Path(folder) for name, folder in (packages or {}).items()})
    spec = read(loader, sink)  # the loader reads and validates each file, modules' files as expand meets them
    robot = _robot(spec, parameters, loader, sink, unset) if spec else None
    if sink.has_errors:
        robot = None
    return Compilation(robot, sink.sorted(), loader.files)


def _robot(spec: SpecFile, parameters: Parameters, loader: Loader, sink: Diagnostics, unset: Unset) -> Robot | None:
    if isinstance(parameters, Mapping):
        arguments = arguments_from_values(parameters)
    else:
        arguments = arguments_from_text(tuple(parameters), sink)
    instance = expand(spec, arguments, loader, sink, unset=unset)
    lowered = lower(instance, sink)
    for component in lowered.unmerged:
        sink.report_all(check(component, Gaps()))
    if lowered.robot is not None:
        sink.report_all(check(lowered.robot, lowered.gaps))
        sink.report_all(urdf_limits(lowered.robot))
        sink.report_all(srdf_limits(lowered.robot))
    return lowered.robot
