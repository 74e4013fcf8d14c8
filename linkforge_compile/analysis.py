"""Compile a spec through all stages, and keep what each made: read, validate, expand, lower and check.

Stages pass values on and report faults to the sink; no stage stops at the first, so that one run reports everything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.checks import check
from linkforge_compile.compilation import Compilation
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics, Severity
from linkforge_compile.diagnostics.codes.modules import NOT_CHECKED
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import Arguments, Instance, Unset, arguments_from_text, arguments_from_values, expand
from linkforge_compile.formats import NO_OPTIONS, Options, formats_or_default, require_options
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.gc_paused import gc_paused
from linkforge_compile.limits import Budget
from linkforge_compile.load import ImportSite, Loader, SpecFile, is_xacro
from linkforge_compile.lower import MeshSolids, lower
from linkforge_compile.roots import ANYWHERE, Roots, exists
from linkforge_compile.source import SourceFile

if TYPE_CHECKING:
    from linkforge_compile.diagnostics.reports import Suppression
    from linkforge_compile.expand.module_cache import ModuleCache

Parameters: TypeAlias = Mapping[str, object] | Iterable[str]
"""Values by name, as Python values or text with units; or `name=value` pairs, as on the command line, which the
message about a missing one then suggests as well."""

Packages: TypeAlias = Mapping[str, str | Path]
"""The folder that `package://NAME/` stands for, by name; they come before every other place to look."""


class Analysis(NamedTuple):
    """A compile with what its stages made, also of a spec with errors.

    `spec` is the compiled file, None if it cannot be read. `instance` is its expanded tree and those of its modules,
    with YamlFaults for what is faulty. `robot` lacks what is faulty; that of the compilation is None then. `sources`
    are all texts that were read.
    """

    compilation: Compilation
    spec: SpecFile | None = None
    instance: Instance | None = None
    robot: Robot | None = None
    sources: tuple[SourceFile, ...] = ()


_Read: TypeAlias = Callable[[Loader, Diagnostics], SpecFile | None]


class Settings(NamedTuple):
    """How to compile a spec.

    `options` are those of the output formats, and `formats` the ones whose limits are reported, none for the default
    ones. `folders` are those where relative paths of meshes start, by the name of the format, as far as they are known.
    `whole` is the budget that this compile shares with others. `buffers` are texts that are read instead of files, such
    as those of an editor that are not saved, by the real path of the file. `beside` is another file that the user
    names: the spec may read what that one may. `cache` has modules of compiles with the same
    settings but for some parameters and the variant.
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
    buffers: Mapping[str, str] = MappingProxyType({})
    beside: Path | None = None
    cache: ModuleCache | None = None

    @property
    def packages_by_name(self) -> dict[str, Path]:
        """The folders of the packages that the user names."""
        return {name: Path(place) for name, place in (self.packages or {}).items()}

    @property
    def has_urdf(self) -> bool:
        """Whether a URDF is among the outputs; ValueError for an unknown format."""
        return any(one.has_urdf for one in formats_or_default(self.formats))

    def loader(self, place: Path | None) -> Loader:
        """Return the loader of one compile of a file or of a text in a folder; None for a text without a folder."""
        packages = self.packages_by_name
        roots = ANYWHERE if self.allow_outside else Roots.around(place, packages.values())
        if self.beside:
            roots = roots.with_those_around(self.beside)
        sources = self.cache.sources if self.cache else None
        return Loader(packages, roots, Budget(within=self.whole), self.buffers, sources)

    def arguments(self, loader: Loader, sink: Diagnostics) -> Arguments:
        """Return the parameters; the loader may then read the files that they name."""
        given = {} if self.parameters is None else self.parameters
        if isinstance(given, Mapping):
            arguments = arguments_from_values(given)
        else:
            arguments = arguments_from_text(tuple(given), sink)
        loader.roots = loader.roots.naming(arguments.named_files)
        return arguments


def analyse_path(path: str | Path, settings: Settings) -> Analysis:
    """Compile a spec file and return what its stages made."""
    file = Path(path)
    if not is_xacro(file):
        return _analyse(lambda loader, sink: loader.open(file, sink), file, settings)

    def read(loader: Loader, sink: Diagnostics) -> SpecFile | None:
        from linkforge_compile.expand.arguments import xacro_arguments
        from linkforge_compile.load.xacro import XacroUse, open_xacro

        arguments = xacro_arguments(settings.arguments(loader, sink), sink)
        return open_xacro(XacroUse(file, ImportSite(str(path), None), arguments), loader, sink)

    # What xacro expands has no parameters.
    return _analyse(read, file, settings._replace(parameters=None))


def analyse_source(text: str, name: str, folder: str | Path | None, settings: Settings) -> Analysis:
    """Compile a spec given as text and return what its stages made."""
    place = Path(folder) if folder is not None else None
    return _analyse(lambda loader, sink: loader.parse(text, name, place, sink), place, settings)


def _analyse(read: _Read, place: Path | None, settings: Settings) -> Analysis:
    return on_fresh_stack(lambda: _analyse_read(read, place, settings))


@gc_paused()
@suggestion_budget()
def _analyse_read(read: _Read, place: Path | None, settings: Settings) -> Analysis:
    require_options(settings.options)
    has_urdf = settings.has_urdf
    sink = Diagnostics()
    loader = settings.loader(place)
    meshes = MeshSolids(loader.budget, loader.files_read)
    loader.check_spec = partial(check_alone, meshes)
    spec, instance, robot = None, None, None
    suppressions: tuple[Suppression, ...] = ()
    try:
        spec = read(loader, sink)  # the loader reads and validates each file, modules' files as expand meets them
        if spec is not None:
            instance, robot = expand_and_lower(spec, settings, loader, meshes, sink)
        if robot is not None and robot.extra_elements:
            # Only of the compiled robot: an import keeps raw XML that has the name of another part.
            from linkforge_compile.formats.limits import check_raw_names

            sink.report_all(check_raw_names(robot))
        suppressions = loader.suppressions
    except BeyondLimitError as beyond:
        sink.abort(beyond)
    is_finished = not sink.has_errors and not any(diagnostic.code is NOT_CHECKED for diagnostic in sink)
    finished = robot if is_finished else None
    report = sink.sorted()
    if suppressions:
        from linkforge_compile.diagnostics.reports import apply_suppressions

        report = apply_suppressions(report, suppressions, is_whole=finished is not None and has_urdf)
    sought = _sought_files(finished, settings) if finished is not None else ()
    files = dict.fromkeys((*loader.files, *meshes.files, *filter(exists, sought)))
    unread = dict.fromkeys((*loader.unread, *meshes.unread, *(path for path in sought if not exists(path))))
    compilation = Compilation(finished, group_alike(report), tuple(files), tuple(unread))
    return Analysis(compilation, spec, instance, robot, loader.sources)


def _sought_files(robot: Robot, settings: Settings) -> tuple[Path, ...]:
    """Return the files on which the documents of the requested formats depend besides the spec."""
    formats = formats_or_default(settings.formats)
    return tuple(path for one in formats for path in one.sought_files(robot, settings.options))


def expand_and_lower(
    spec: SpecFile, settings: Settings, loader: Loader, meshes: MeshSolids, sink: Diagnostics
) -> tuple[Instance, Robot | None]:
    """Expand, lower and check a spec that was read; return its expanded tree and its robot, without what is faulty."""
    from linkforge_compile.core.resolver import FileSystemResolver

    arguments = settings.arguments(loader, sink)
    cache = settings.cache.of_compile(settings.variant, loader, sink) if settings.cache else None
    instance = expand(spec, arguments, loader, sink, unset=settings.unset, variant=settings.variant, cache=cache)
    lowered = lower(instance, sink, meshes, cache)
    # Meshes are looked for in the user's packages, the spec's, then those of its modules.
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
    return instance, lowered.robot


def check_alone(meshes: MeshSolids, spec: SpecFile, loader: Loader) -> Compilation:
    """Compile a spec by itself for its errors, within a budget of its own, sharing the meshes of the whole compile."""
    sink, was_reported = Diagnostics(), meshes.is_without_library
    try:
        with loader.separate_budget():
            _, robot = expand_and_lower(spec, Settings(), loader, meshes, sink)
    finally:
        meshes.is_without_library = was_reported  # this sink is discarded: the whole compile reports it
    faults = tuple(fault for fault in sink if fault.severity is Severity.ERROR)
    return Compilation(None if faults else robot, faults)
