"""The compiler on one page: read, validate, expand, lower, check; rendering is what the result is for.

Values flow down, faults flow sideways into the sink, and no stage stops the line: one run tells everything.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.checks import check
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics, Severity
from linkforge_compile.diagnostics.codes.bounds import VARIANTS_BEYOND_LIMIT
from linkforge_compile.diagnostics.codes.modules import NOT_JUDGED
from linkforge_compile.diagnostics.suggest import suggesting
from linkforge_compile.expand import (
    XACRO,
    Arguments,
    CliArgument,
    ImportSite,
    Loader,
    SpecFile,
    Unset,
    arguments_from_text,
    arguments_from_values,
    expand,
)
from linkforge_compile.formats import NO_OPTIONS, Options, limits, require_options
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.limits import Budget
from linkforge_compile.lower import MeshSolids, lower
from linkforge_compile.roots import ANYWHERE, Roots

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics.ignores import Ignore
    from linkforge_compile.expand.listing import Listing
    from linkforge_compile.formats.urdf import Gazebo

__all__ = [
    "CliArgument",
    "Compilation",
    "CompileError",
    "Packages",
    "Parameters",
    "Settings",
    "check_file",
    "check_text",
    "check_variants",
    "compile_file",
    "compile_text",
    "parameters_of",
    "robot_of",
]

Parameters: TypeAlias = Mapping[str, object] | Iterable[str]
"""Values by name, as Python values or text with units; or `name=value` pairs as the command line has them, which
diagnostics then say of a missing one as well."""

Packages: TypeAlias = Mapping[str, str | Path]
"""The folder that `package://NAME/` stands for, by name; they come before every other place to look."""


@contextmanager
def gc_paused() -> Iterator[None]:
    """Pause the garbage collector: a robot holds no cycles, and to look for them takes a third of a long compile.

    The collector is one for all threads: of two compiles at once, the first that ends resumes it.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


class CompileError(Exception):
    """A spec with errors was asked for its robot; `diagnostics` has every one of them."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        self.diagnostics = diagnostics
        super().__init__("\n".join(str(diagnostic) for diagnostic in diagnostics))

    def __reduce__(self) -> tuple[type[CompileError], tuple[tuple[Diagnostic, ...]]]:
        return CompileError, (self.diagnostics,)


@dataclass(frozen=True)
class Compilation:
    """What one compile gave: the robot and all that was told about the spec.

    `robot` is None where the spec has errors, and where a check left out what depends on parameters without a value.
    `files` lists every file that it was made from: the compiled one first, what it includes, uses and reads values
    from, then the meshes read for their inertia. `unread` lists those that were asked for and could not be read: when
    one of them is there, the result is another.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...] = ()
    unread: tuple[Path, ...] = ()

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
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    output: str | Path | None = None,
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec file; a required parameter without a value is an error.

    `variant` is the one of the file's `variants` that sets what `parameters` do not, before the defaults. `gazebo`
    is the simulator, Gazebo Sim or Classic, whose limits are told; give it to `render_urdf` as well. `output` is the
    folder that the URDF is for: relative paths of meshes that lead nowhere from there are told; None for not known.
    What a spec names is read in its own package or repository (else its folder), in `packages`, in those of
    AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, and where `parameters` name a file; `allow_outside` lets it read anything.

    Raises:
        ValueError: for another `gazebo` than `gz` or `classic`.

    """
    folder = Path(output) if output is not None else None
    settings = Settings(parameters, packages, variant, {"gazebo": gazebo}, output=folder, allow_outside=allow_outside)
    return compile_path(path, settings)


def compile_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec given as text; `name` stands in its diagnostics, `folder` is where relative paths start."""
    settings = Settings(parameters, packages, variant, {"gazebo": gazebo}, allow_outside=allow_outside)
    return compile_source(text, name, folder, settings)


def check_file(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    allow_outside: bool = False,
) -> Compilation:
    """Tell all that is wrong with a spec file; what depends on a required parameter without a value is not judged."""
    settings = Settings(parameters, packages, variant, {"gazebo": gazebo}, Unset.NOTE, allow_outside=allow_outside)
    return compile_path(path, settings)


def check_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    allow_outside: bool = False,
) -> Compilation:
    """Tell all that is wrong with a spec given as text, as `check_file` does."""
    settings = Settings(parameters, packages, variant, {"gazebo": gazebo}, Unset.NOTE, allow_outside=allow_outside)
    return compile_source(text, name, folder, settings)


def check_variants(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    gazebo: Gazebo = "gz",
    allow_outside: bool = False,
) -> dict[str | None, Compilation | None]:
    """Check a spec file with its defaults (None) and each of its variants, by name; None for those not checked.

    Together they may take what five compiles may: LF3304 is told of the one that takes more, the last that is checked.
    """
    settings = Settings(parameters, packages, None, {"gazebo": gazebo}, Unset.NOTE, allow_outside=allow_outside)
    return check_each_variant(Path(path), settings)


def check_each_variant(file: Path, settings: Settings) -> dict[str | None, Compilation | None]:
    """Check a spec file as `check_variants` does, with settings."""
    from linkforge_compile.expand.variants import names_of_variants

    whole = Budget(times=5, code=VARIANTS_BEYOND_LIMIT)
    settings = settings._replace(whole=whole)
    names = (None, *names_of_variants(file, settings.loader(file)))
    return {name: None if whole.is_spent else compile_path(file, settings._replace(variant=name)) for name in names}


@suggesting()
def parameters_of(
    path: str | Path, *, packages: Packages | None = None, allow_outside: bool = False
) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
    """List the parameters and variants of a spec file, None where it cannot be read, and what is wrong with them.

    Those of a xacro file are the arguments that it and what it includes declare; none is declared by a URDF.
    """
    from linkforge_compile.expand.listing import list_parameters

    sink, loader = Diagnostics(), Settings(packages=packages, allow_outside=allow_outside).loader(Path(path))
    listing = None
    try:
        if Path(path).suffix.lower() == XACRO:
            from linkforge_compile.expand.listing import list_arguments

            listing = list_arguments(Path(path), loader, sink)
        elif spec := loader.open(Path(path), sink):
            listing = list_parameters(spec, loader, sink)
    except BeyondLimitError as beyond:
        sink.end(beyond)
    return listing, sink.sorted()


_Read: TypeAlias = Callable[[Loader, Diagnostics], SpecFile | None]


class Settings(NamedTuple):
    """How to compile a spec.

    `options` are those of the output formats, and `formats` the ones requested, whose limits are reported beside those
    of the default ones. `whole` is the budget that this compile shares with others.
    """

    parameters: Parameters | None = None
    packages: Packages | None = None
    variant: str | None = None
    options: Options = NO_OPTIONS
    unset: Unset = Unset.ERROR
    output: Path | None = None
    allow_outside: bool = False
    formats: tuple[str, ...] = ()
    whole: Budget | None = None

    def loader(self, place: Path | None) -> Loader:
        """Return what reads the files of one compile, the compiled one at a place; None for a text without one."""
        packages = {name: Path(place) for name, place in (self.packages or {}).items()}
        roots = ANYWHERE if self.allow_outside else Roots.around(place, packages.values())
        return Loader(packages, roots, Budget(within=self.whole))

    def arguments(self, loader: Loader, sink: Diagnostics) -> Arguments:
        """Return the parameters; the loader may read the files that they name."""
        said = {} if self.parameters is None else self.parameters
        arguments = arguments_from_values(said) if isinstance(said, Mapping) else arguments_from_text(tuple(said), sink)
        loader.roots = loader.roots.naming(arguments.named_files)
        return arguments


def compile_path(path: str | Path, settings: Settings) -> Compilation:
    file = Path(path)
    if file.suffix.lower() != XACRO:
        return _compile(lambda loader, sink: loader.open(file, sink), file, settings)

    def read(loader: Loader, sink: Diagnostics) -> SpecFile | None:
        from linkforge_compile.expand.xacro import open_xacro
        from linkforge_compile.expand.xacro_use import XacroUse

        return open_xacro(XacroUse(file, ImportSite(str(path), None), settings.arguments(loader, sink)), loader, sink)

    # The expansion has no parameters any more.
    return _compile(read, file, settings._replace(parameters=None))


def compile_source(text: str, name: str, folder: str | Path | None, settings: Settings) -> Compilation:
    place = Path(folder) if folder is not None else None
    return _compile(lambda loader, sink: loader.parse(text, name, place, sink), place, settings)


def _compile(read: _Read, place: Path | None, settings: Settings) -> Compilation:
    return on_fresh_stack(lambda: _compile_read(read, place, settings))


@gc_paused()
@suggesting()
def _compile_read(read: _Read, place: Path | None, settings: Settings) -> Compilation:
    require_options(settings.options)
    sink = Diagnostics()
    loader = settings.loader(place)
    meshes = MeshSolids(loader.budget)
    loader.check_spec = lambda spec, loader: judged(meshes, spec, loader).faults
    robot = None
    ignores: tuple[Ignore, ...] = ()
    try:
        spec = read(loader, sink)  # the loader reads and validates each file, modules' files as expand meets them
        robot = robot_of(spec, settings, loader, meshes, sink) if spec else None
        if robot is not None and robot.extra_elements:
            # Not asked of a robot that is judged: an import keeps raw what has the name of another.
            from linkforge_compile.formats.raw_names import check_raw_names

            sink.report_all(check_raw_names(robot))
        ignores = loader.ignores
    except BeyondLimitError as beyond:
        sink.end(beyond)
    if sink.has_errors or any(diagnostic.code is NOT_JUDGED for diagnostic in sink):
        robot = None
    report = sink.sorted()
    if ignores:
        from linkforge_compile.diagnostics.ignores import heed

        report = heed(report, ignores, is_whole=robot is not None)
    return Compilation(robot, report, (*loader.files, *meshes.files), (*loader.unread, *meshes.unread))


def robot_of(spec: SpecFile, settings: Settings, loader: Loader, meshes: MeshSolids, sink: Diagnostics) -> Robot | None:
    """Expand, lower and check a spec that was read: the robot, as far as its faults leave one."""
    from linkforge_compile.core.resolver import FileSystemResolver

    arguments = settings.arguments(loader, sink)
    instance = expand(spec, arguments, loader, sink, unset=settings.unset, variant=settings.variant)
    lowered = lower(instance, sink, meshes)
    # Meshes are looked for in the user's packages, the spec's, and then those of its modules.
    resolver = FileSystemResolver(packages={**instance.packages_of_all, **loader.packages}, roots=loader.roots)
    for robot, unresolved in lowered.robots:
        robot.resource_resolver = resolver
        sink.report_all(check(robot, unresolved.with_access(loader.roots.hold)))
    if lowered.robot is not None:
        sink.report_all(limits(lowered.robot, settings.options, settings.formats))
        if settings.output is not None:
            from linkforge_compile.formats.relative_paths import lost_on_the_way

            sink.report_all(lost_on_the_way(lowered.robot, settings.output))
    return lowered.robot


class Judged(NamedTuple):
    """What a spec compiles to by itself, None where it has errors, and those."""

    robot: Robot | None
    faults: tuple[Diagnostic, ...]


def judged(meshes: MeshSolids, spec: SpecFile, loader: Loader) -> Judged:
    """Compile a spec by itself at a cost of its own; it reads the meshes that are read for the whole."""
    sink, was_told = Diagnostics(), meshes.is_without_library
    with loader.separate_budget():
        robot = robot_of(spec, Settings(), loader, meshes, sink)
    meshes.is_without_library = was_told  # this sink is nobody's: the robot tells it where it is used
    faults = tuple(fault for fault in sink if fault.severity is Severity.ERROR)
    return Judged(None if faults else robot, faults)
