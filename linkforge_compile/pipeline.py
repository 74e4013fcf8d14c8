"""Compile a spec: read, validate, expand, lower and check it.

Stages pass values on and report faults to the sink; no stage stops at the first, so that one run reports everything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.checks import check
from linkforge_compile.compilation import Compilation, CompileError
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics, Severity
from linkforge_compile.diagnostics.codes.modules import NOT_CHECKED, VARIANTS_BEYOND_LIMIT
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import Arguments, CliArgument, Unset, arguments_from_text, arguments_from_values, expand
from linkforge_compile.formats import NO_OPTIONS, Options, formats_or_default, require_options
from linkforge_compile.formats.urdf import Gazebo
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.gc_paused import gc_paused
from linkforge_compile.limits import Budget
from linkforge_compile.load import ImportSite, Loader, SpecFile, is_xacro
from linkforge_compile.lower import MeshSolids, lower
from linkforge_compile.roots import ANYWHERE, Roots, exists

if TYPE_CHECKING:
    from linkforge_compile.diagnostics.reports import Suppression
    from linkforge_compile.listing import Listing

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
"""Values by name, as Python values or text with units; or `name=value` pairs, as on the command line, which the
message about a missing one then suggests as well."""

Packages: TypeAlias = Mapping[str, str | Path]
"""The folder that `package://NAME/` stands for, by name; they come before every other place to look."""


def compile_file(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    output: str | Path | None = None,
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec file; a required parameter without a value is an error.

    `variant` is the one of the file's `variants` that sets what `parameters` do not, before the defaults, or several
    of them, `a+b`, of which the last one decides. `gazebo` is the simulator, Gazebo Sim or Classic, whose limits are
    reported; give it to `render_urdf` as well. `formats` are those whose limits are reported, URDF and SRDF if there
    are none, and `options` are theirs, such as `{"base": "free"}`; give these to `render` as well. `output` is the
    folder of the URDF, from which relative paths of meshes must lead to a file; None if it is not known.
    What a spec names is read in its own package or repository (else its folder), in `packages`, in those of
    AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, and where `parameters` name a file; `allow_outside` lets it read anything.

    Raises:
        ValueError: for an unknown format or option, and another `gazebo` than `gz` or `classic`.

    """
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    folders = {} if output is None else {_format_with_paths(formats): Path(output)}
    settings = Settings(parameters, packages, variant, options, Unset.ERROR, folders, allow_outside, formats)
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
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec given as text; `name` is its name in diagnostics, `folder` is where relative paths start."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.ERROR, {}, allow_outside, formats)
    return compile_source(text, name, folder, settings)


def check_file(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Report what is wrong with a spec file; what depends on a required parameter without a value is not checked."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.NOTE, {}, allow_outside, formats)
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
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Report what is wrong with a spec given as text, as `check_file` does."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.NOTE, {}, allow_outside, formats)
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

    Together they have the budget of five compiles: the one that exceeds it is the last that is checked, with LF3304.
    """
    settings = Settings(parameters, packages, None, {"gazebo": gazebo}, Unset.NOTE, allow_outside=allow_outside)
    return check_each_variant(Path(path), settings)


def check_each_variant(file: Path, settings: Settings) -> dict[str | None, Compilation | None]:
    """Check a spec file as `check_variants` does, with settings."""
    from linkforge_compile.expand.arguments import names_of_variants

    whole = Budget(times=5, code=VARIANTS_BEYOND_LIMIT)
    settings = settings._replace(whole=whole)
    names = (None, *names_of_variants(file, settings.loader(file)))
    return {name: None if whole.is_spent else compile_path(file, settings._replace(variant=name)) for name in names}


@suggestion_budget()
def parameters_of(
    path: str | Path, *, packages: Packages | None = None, allow_outside: bool = False
) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
    """List the parameters and variants of a spec file, None if it cannot be read, and what is wrong with them.

    Those of a xacro file are the arguments that it and its includes declare; a URDF declares none.
    """
    from linkforge_compile.listing import list_parameters

    sink, loader = Diagnostics(), Settings(packages=packages, allow_outside=allow_outside).loader(Path(path))
    listing = None
    try:
        if is_xacro(Path(path)):
            from linkforge_compile.listing import list_arguments

            listing = list_arguments(Path(path), loader, sink)
        elif spec := loader.open(Path(path), sink):
            listing = list_parameters(spec, loader, sink)
    except BeyondLimitError as beyond:
        sink.abort(beyond)
    return listing, sink.sorted()


_Read: TypeAlias = Callable[[Loader, Diagnostics], SpecFile | None]


class Settings(NamedTuple):
    """How to compile a spec.

    `options` are those of the output formats, and `formats` the ones whose limits are reported, none for the default
    ones. `folders` are those where relative paths of meshes start, by the name of the format, as far as they are known.
    `whole` is the budget that this compile shares with others.
    """

    parameters: Parameters | None = None
    packages: Packages | None = None
    variant: str | None = None
    options: Options = NO_OPTIONS
    unset: Unset = Unset.ERROR
    folders: Mapping[str, Path] = MappingProxyType({})
    allow_outside: bool = False
    formats: tuple[str, ...] = ()
    whole: Budget | None = None

    @property
    def has_urdf(self) -> bool:
        """Whether a URDF is among the outputs; ValueError for an unknown format."""
        return any(one.has_urdf for one in formats_or_default(self.formats))

    def loader(self, place: Path | None) -> Loader:
        """Return the loader of one compile of a file or of a text in a folder; None for a text without a folder."""
        packages = {name: Path(place) for name, place in (self.packages or {}).items()}
        roots = ANYWHERE if self.allow_outside else Roots.around(place, packages.values())
        return Loader(packages, roots, Budget(within=self.whole))

    def arguments(self, loader: Loader, sink: Diagnostics) -> Arguments:
        """Return the parameters; the loader may then read the files that they name."""
        given = {} if self.parameters is None else self.parameters
        if isinstance(given, Mapping):
            arguments = arguments_from_values(given)
        else:
            arguments = arguments_from_text(tuple(given), sink)
        loader.roots = loader.roots.naming(arguments.named_files)
        return arguments


def compile_path(path: str | Path, settings: Settings) -> Compilation:
    """Compile a spec file with settings."""
    file = Path(path)
    if not is_xacro(file):
        return _compile(lambda loader, sink: loader.open(file, sink), file, settings)

    def read(loader: Loader, sink: Diagnostics) -> SpecFile | None:
        from linkforge_compile.expand.arguments import xacro_arguments
        from linkforge_compile.load.xacro import XacroUse, open_xacro

        arguments = xacro_arguments(settings.arguments(loader, sink), sink)
        return open_xacro(XacroUse(file, ImportSite(str(path), None), arguments), loader, sink)

    # What xacro expands has no parameters.
    return _compile(read, file, settings._replace(parameters=None))


def compile_source(text: str, name: str, folder: str | Path | None, settings: Settings) -> Compilation:
    """Compile a spec given as text with settings."""
    place = Path(folder) if folder is not None else None
    return _compile(lambda loader, sink: loader.parse(text, name, place, sink), place, settings)


def _compile(read: _Read, place: Path | None, settings: Settings) -> Compilation:
    return on_fresh_stack(lambda: _compile_read(read, place, settings))


@gc_paused()
@suggestion_budget()
def _compile_read(read: _Read, place: Path | None, settings: Settings) -> Compilation:
    require_options(settings.options)
    has_urdf = settings.has_urdf
    sink = Diagnostics()
    loader = settings.loader(place)
    meshes = MeshSolids(loader.budget)
    loader.check_spec = partial(check_alone, meshes)
    robot = None
    suppressions: tuple[Suppression, ...] = ()
    try:
        spec = read(loader, sink)  # the loader reads and validates each file, modules' files as expand meets them
        robot = robot_of(spec, settings, loader, meshes, sink) if spec else None
        if robot is not None and robot.extra_elements:
            # Only of the compiled robot: an import keeps raw XML that has the name of another part.
            from linkforge_compile.formats.limits import check_raw_names

            sink.report_all(check_raw_names(robot))
        suppressions = loader.suppressions
    except BeyondLimitError as beyond:
        sink.abort(beyond)
    if sink.has_errors or any(diagnostic.code is NOT_CHECKED for diagnostic in sink):
        robot = None
    report = sink.sorted()
    if suppressions:
        from linkforge_compile.diagnostics.reports import apply_suppressions

        report = apply_suppressions(report, suppressions, is_whole=robot is not None and has_urdf)
    sought = _sought_files(robot, settings) if robot is not None else ()
    files = dict.fromkeys((*loader.files, *meshes.files, *filter(exists, sought)))
    unread = dict.fromkeys((*loader.unread, *meshes.unread, *(path for path in sought if not exists(path))))
    return Compilation(robot, group_alike(report), tuple(files), tuple(unread))


def _sought_files(robot: Robot, settings: Settings) -> tuple[Path, ...]:
    """Return the files on which the documents of the requested formats depend besides the spec."""
    formats = formats_or_default(settings.formats)
    return tuple(path for one in formats for path in one.sought_files(robot, settings.options))


def robot_of(spec: SpecFile, settings: Settings, loader: Loader, meshes: MeshSolids, sink: Diagnostics) -> Robot | None:
    """Expand, lower and check a spec that was read; return its robot, without what is faulty."""
    from linkforge_compile.core.resolver import FileSystemResolver

    arguments = settings.arguments(loader, sink)
    instance = expand(spec, arguments, loader, sink, unset=settings.unset, variant=settings.variant)
    lowered = lower(instance, sink, meshes)
    # Meshes are looked for in the user's packages, the spec's, and then those of its modules.
    resolver = FileSystemResolver(packages={**instance.packages_of_all, **loader.packages}, roots=loader.roots)
    for robot, unresolved in lowered.robots:
        robot.resource_resolver = resolver
        sink.report_all(check(robot, unresolved.with_access(loader.roots.hold), has_urdf=settings.has_urdf))
    if lowered.robot is not None:
        for one in formats_or_default(settings.formats):
            sink.report_all(one.limits(lowered.robot, settings.options))
        if settings.folders:
            from linkforge_compile.formats.relative_paths import check_mesh_paths_of_formats

            folders, options = settings.folders, settings.options
            sink.report_all(check_mesh_paths_of_formats(lowered.robot, folders, options, start=spec.folder))
    return lowered.robot


def _format_with_paths(formats: Sequence[str]) -> str:
    """Return the first format with relative paths, URDF if none has."""
    return next((one.name for one in formats_or_default(formats) if one.has_relative_paths), "urdf")


def check_alone(meshes: MeshSolids, spec: SpecFile, loader: Loader) -> Compilation:
    """Compile a spec by itself for its errors, within a budget of its own, sharing the meshes of the whole compile."""
    sink, was_reported = Diagnostics(), meshes.is_without_library
    try:
        with loader.separate_budget():
            robot = robot_of(spec, Settings(), loader, meshes, sink)
    finally:
        meshes.is_without_library = was_reported  # this sink is discarded: the whole compile reports it
    faults = tuple(fault for fault in sink if fault.severity is Severity.ERROR)
    return Compilation(None if faults else robot, faults)
