"""The compiler on one page: read, validate, expand, lower, check; rendering is what the result is for.

Values flow down, faults flow sideways into the sink, and no stage stops the line: one run tells everything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.backends import require_dialect, srdf_limits, urdf_limits
from linkforge_compile.checks import check
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics, Gaps, Severity
from linkforge_compile.diagnostics.codes.importing import LOSSES
from linkforge_compile.diagnostics.codes.modules import NOT_JUDGED
from linkforge_compile.diagnostics.ignores import heed
from linkforge_compile.lowering import MeshSolids, lower
from linkforge_compile.modules import (
    XACRO,
    Arguments,
    ListedParameter,
    Listing,
    Loader,
    Plain,
    SpecFile,
    Unset,
    Used,
    arguments_from_text,
    arguments_from_values,
    expand,
    list_parameters,
    variants_of,
)
from linkforge_compile.stack import with_room
from linkforge_compile.syntax import ignore_comments

if TYPE_CHECKING:
    from linkforge_compile.backends.urdf.sensor import Gazebo
    from linkforge_compile.core import Robot
    from linkforge_compile.syntax import YamlMap

__all__ = [
    "Compilation",
    "CompileError",
    "Import",
    "ListedParameter",
    "Listing",
    "Packages",
    "Parameters",
    "Plain",
    "check_file",
    "check_text",
    "check_variants",
    "compile_file",
    "compile_text",
    "import_urdf",
    "parameters_of",
]

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
    """What one compile gave: the robot and all that was told about the spec.

    `robot` is None where the spec has errors, and where a check left out what depends on parameters without a value.
    `files` lists every spec file that was read, the compiled one first, then the meshes read for their inertia.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...] = ()

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self.diagnostics)

    def result(self) -> Robot:
        """Return the robot; raise CompileError where there is none."""
        if self.robot is None:
            raise CompileError(self.diagnostics)
        return self.robot


def compile_file(
    path: str | Path,
    *,
    parameters: Parameters = (),
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    output: str | Path | None = None,
) -> Compilation:
    """Compile a spec file; a required parameter without a value is an error.

    `variant` is the one of the file's `variants` that sets what `parameters` do not, before the defaults. `gazebo`
    is the simulator, Gazebo Sim or Classic, whose limits are told; give it to `render_urdf` as well. `output` is the
    folder that the URDF is for: relative paths of meshes that lead nowhere from there are told; None for not known.

    Raises:
        ValueError: for another `gazebo` than `gz` or `classic`.

    """
    folder = Path(output) if output is not None else None
    return _compile_file(path, _Settings(parameters, packages, variant, gazebo, output=folder))


def compile_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters = (),
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
) -> Compilation:
    """Compile a spec given as text; `name` stands in its diagnostics, `folder` is where relative paths start."""
    return _compile(_text(text, name, folder), _Settings(parameters, packages, variant, gazebo))


def check_file(
    path: str | Path,
    *,
    parameters: Parameters = (),
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
) -> Compilation:
    """Tell all that is wrong with a spec file; what depends on a required parameter without a value is not judged."""
    return _compile_file(path, _Settings(parameters, packages, variant, gazebo, Unset.NOTE))


def check_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters = (),
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
) -> Compilation:
    """Tell all that is wrong with a spec given as text, as `check_file` does."""
    return _compile(_text(text, name, folder), _Settings(parameters, packages, variant, gazebo, Unset.NOTE))


def check_variants(
    path: str | Path, *, parameters: Parameters = (), packages: Packages | None = None, gazebo: Gazebo = "gz"
) -> dict[str | None, Compilation]:
    """Check a spec file with its defaults (None) and with each of its variants, by name."""
    variants = (None, *_variants(Path(path)))
    return {
        name: check_file(path, parameters=parameters, packages=packages, variant=name, gazebo=gazebo)
        for name in variants
    }


def _variants(path: Path) -> Iterable[str]:
    """Return the names of a spec's variants, none where it cannot be read: then its check says so."""
    try:
        spec = Loader().open(path, Diagnostics())
    except BeyondLimitError:
        return ()
    return variants_of(spec) if spec else ()


def parameters_of(path: str | Path) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
    """List the parameters and variants of a spec file, None where it cannot be read, and what is wrong with them."""
    sink, loader = Diagnostics(), Loader()
    listing = None
    try:
        spec = loader.open(Path(path), sink)
        listing = list_parameters(spec, loader, sink) if spec else None
    except BeyondLimitError as beyond:
        sink.end(beyond)
    return listing, sink.sorted()


@dataclass(frozen=True, slots=True)
class Import:
    """What reading a robot that was written elsewhere gave: a spec, and what is to be told about it.

    `text` is None where the file is not the robot that it is said to be.
    """

    text: str | None
    diagnostics: tuple[Diagnostic, ...]

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self.diagnostics)

    @property
    def losses(self) -> tuple[Diagnostic, ...]:
        """What of the robot is not in the spec."""
        return tuple(diagnostic for diagnostic in self.diagnostics if diagnostic.code in LOSSES)


def import_urdf(path: str | Path, *, srdf: str | Path | None = None, arguments: Parameters = ()) -> Import:
    """Read a URDF file, and the SRDF of the same robot, as a spec that compiles to the same robot.

    Its errors are told where those files have them. A xacro file is expanded with the arguments first.
    """
    return with_room(lambda: _imported(Path(path), None if srdf is None else Path(srdf), arguments))


def _imported(urdf: Path, srdf: Path | None, given: Parameters) -> Import:
    sink = Diagnostics()
    try:
        text = _imported_text(urdf, srdf, given, sink)
    except BeyondLimitError as beyond:
        sink.end(beyond)
        text = None
    return Import(text, sink.sorted())


def _imported_text(urdf: Path, srdf: Path | None, given: Parameters, sink: Diagnostics) -> str | None:
    from linkforge_compile.importers.srdf import with_srdf
    from linkforge_compile.importers.urdf import read_urdf
    from linkforge_compile.syntax import write

    loader = Loader()
    if urdf.suffix.lower() == XACRO:
        from linkforge_compile.modules.xacro import XacroUse, read_xacro

        arguments = _Settings(given, None, None, "gz").arguments(sink)
        expanded = read_xacro(XacroUse(urdf, Used(str(urdf), None), arguments), loader, sink)
        file, robot = (expanded.file, expanded.imported) if expanded else (None, None)
    else:
        file = loader.open_xml(urdf, sink)
        robot = read_urdf(file, sink) if file else None
    semantic = loader.open_xml(srdf, sink) if robot and srdf else None
    if file is None or robot is None or (srdf and semantic is None):
        return None
    judge = partial(_faults_of, SpecFile(file, robot.tree, urdf.parent), loader)
    judged = with_srdf(robot, semantic, judge, sink) if semantic else (robot, judge(robot.tree))
    if judged is None:
        return None
    # The tree has the spans of the files, so what is wrong with the robot is told there.
    whole, faults = judged
    sink.report_all(faults)
    return write(whole.tree, *whole.comments)


def _faults_of(spec: SpecFile, loader: Loader, tree: YamlMap) -> tuple[Diagnostic, ...]:
    judged = Diagnostics()
    _robot(replace(spec, tree=tree), _Settings((), None, None, "gz"), loader, MeshSolids(), judged)
    return tuple(fault for fault in judged if fault.severity is Severity.ERROR)


_Read: TypeAlias = Callable[[Loader, Diagnostics], SpecFile | None]


class _Settings(NamedTuple):
    """How to compile a spec."""

    parameters: Parameters
    packages: Packages | None
    variant: str | None
    gazebo: Gazebo
    unset: Unset = Unset.ERROR
    output: Path | None = None

    def arguments(self, sink: Diagnostics) -> Arguments:
        if isinstance(self.parameters, Mapping):
            return arguments_from_values(self.parameters)
        return arguments_from_text(tuple(self.parameters), sink)


def _compile_file(path: str | Path, settings: _Settings) -> Compilation:
    file = Path(path)
    if file.suffix.lower() != XACRO:
        return _compile(lambda loader, sink: loader.open(file, sink), settings)

    def read(loader: Loader, sink: Diagnostics) -> SpecFile | None:
        from linkforge_compile.modules.xacro import XacroUse, open_xacro

        return open_xacro(XacroUse(file, Used(str(path), None), settings.arguments(sink)), loader, sink)

    # The expansion has no parameters any more.
    return _compile(read, settings._replace(parameters=()))


def _text(text: str, name: str, folder: str | Path | None) -> _Read:
    place = Path(folder) if folder is not None else None
    return lambda loader, sink: loader.parse(text, name, place, sink)


def _compile(read: _Read, settings: _Settings) -> Compilation:
    return with_room(lambda: _compiled(read, settings))


def _compiled(read: _Read, settings: _Settings) -> Compilation:
    require_dialect(settings.gazebo)
    sink = Diagnostics()
    loader = Loader({name: Path(folder) for name, folder in (settings.packages or {}).items()})
    meshes = MeshSolids()
    robot = None
    try:
        spec = read(loader, sink)  # the loader reads and validates each file, modules' files as expand meets them
        robot = _robot(spec, settings, loader, meshes, sink) if spec else None
    except BeyondLimitError as beyond:
        sink.end(beyond)
    is_whole = not any(diagnostic.code is NOT_JUDGED for diagnostic in sink)
    if sink.has_errors or not is_whole:
        robot = None
    ignores = tuple(ignore for file in loader.sources for ignore in ignore_comments(file))
    report = heed(sink.sorted(), ignores, is_whole=robot is not None)
    return Compilation(robot, report, (*loader.files, *meshes.files))


def _robot(spec: SpecFile, settings: _Settings, loader: Loader, meshes: MeshSolids, sink: Diagnostics) -> Robot | None:
    arguments = settings.arguments(sink)
    instance = expand(spec, arguments, loader, sink, unset=settings.unset, variant=settings.variant)
    lowered = lower(instance, sink, meshes)
    for alone in lowered.unmerged:
        sink.report_all(check(alone.robot, Gaps(removed=alone.removed)))
    if lowered.robot is not None:
        sink.report_all(check(lowered.robot, lowered.gaps))
        sink.report_all(urdf_limits(lowered.robot, gazebo=settings.gazebo))
        sink.report_all(srdf_limits(lowered.robot))
        if settings.output is not None:
            from linkforge_compile.backends.relative_paths import lost_on_the_way

            sink.report_all(lost_on_the_way(lowered.robot, settings.output))
    return lowered.robot
