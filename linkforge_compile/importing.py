"""Import a robot written as URDF, SRDF or xacro: write its spec, compile it, and report what is lost."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.analysis import Packages, Parameters, Settings, check_alone
from linkforge_compile.compilation import Compilation
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics, Note, Severity
from linkforge_compile.diagnostics.codes.importing import LOSSES, MESH_BESIDE_THE_URDF
from linkforge_compile.diagnostics.codes.modules import NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_PARAMETER
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import Arguments
from linkforge_compile.expand.instance import charge_entries
from linkforge_compile.formats import SRDF, URDF
from linkforge_compile.formats.render import render_srdf, render_urdf
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.gc_paused import gc_paused
from linkforge_compile.importers.document import Imported
from linkforge_compile.importers.origin import Origin, digest_of
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load import ImportSite, Loader, SpecFile, is_xacro
from linkforge_compile.lower import MeshSolids
from linkforge_compile.pipeline import compile_source
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlMap, YamlScalar, read

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.formats.urdf import Gazebo
    from linkforge_compile.load.xacro import Expansion

_IMPORTED = (URDF, SRDF)
"""The formats of the documents of an import, in their order."""

_WRONG_ARGUMENTS = (NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_PARAMETER)
"""Faults of arguments, after which the robot that was read may be another one than intended."""


@dataclass(frozen=True)
class Import:
    """The result of an import: the text of a spec, and the diagnostics.

    `text` is None if the file is no robot of its format, or does not accept the arguments. `origin` is what it was
    imported from; None for a text that is no file.
    """

    text: str | None
    diagnostics: tuple[Diagnostic, ...]
    origin: Origin | None = None

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self.diagnostics)

    @property
    def losses(self) -> tuple[Diagnostic, ...]:
        """The diagnostics about what of the robot is not in the spec."""
        return tuple(diagnostic for diagnostic in self.diagnostics if diagnostic.code in LOSSES)


def import_urdf(
    path: str | Path,
    *,
    srdf: str | Path | None = None,
    arguments: Parameters = (),
    packages: Packages | None = None,
    allow_outside: bool = False,
    output: str | Path | None = None,
    text: str | None = None,
) -> Import:
    """Read a URDF file, and the SRDF of the same robot, as a spec that compiles to the same robot.

    Errors are reported at their places in those files. A xacro is expanded first, with the arguments that it declares;
    its packages are searched in `packages` before other places, and it may read the files that `compile_file` reads,
    or any with `allow_outside`. `output` is the folder of the spec: meshes next to the URDF but not there are reported.
    `text` is the URDF if it is no file; `path` is its name then, and relative paths start in the folder of `path`.
    """
    settings = Settings(arguments, packages, allow_outside=allow_outside)
    urdf = _Urdf(Path(path), text, Path(output) if output else None)
    return on_fresh_stack(lambda: _imported(urdf, None if srdf is None else Path(srdf), settings))


class _Urdf(NamedTuple):
    """The URDF to import: a file, or a text with that name; `output` is the folder of the spec, None if unknown."""

    path: Path
    text: str | None
    output: Path | None


class ReadBack(NamedTuple):
    """A robot read from its own URDF and SRDF, None if those are refused, and the errors."""

    robot: Robot | None
    faults: tuple[Diagnostic, ...]


def as_read_back(robot: Robot, *, gazebo: Gazebo = "gz") -> ReadBack:
    """Return a robot read from its own URDF and SRDF, to compare it with one that was read from such files.

    Its sensors are Gazebo elements then, and it has no metadata.
    """
    sink = Diagnostics()
    try:
        back = on_fresh_stack(lambda: _read_back(robot, gazebo, sink))
    except BeyondLimitError as beyond:
        sink.abort(beyond)
        back = None
    return ReadBack(back, tuple(one for one in sink.sorted() if one.severity is Severity.ERROR))


@gc_paused()
@suggestion_budget()
def _read_back(robot: Robot, gazebo: Gazebo, sink: Diagnostics) -> Robot | None:
    from linkforge_compile.importers.srdf_with_urdf import with_srdf
    from linkforge_compile.importers.urdf import read_urdf

    loader = Settings().loader(None)
    file = SourceFile("<urdf>", render_urdf(robot, gazebo=gazebo))
    imported = read_urdf(file, sink, keeps_refused=True)
    if imported is None:
        return None
    check = _checker_of(SpecFile(file, imported.tree, None), loader)
    semantic = SourceFile("<srdf>", render_srdf(robot)) if robot.has_semantic else None
    result = with_srdf(imported, semantic, check, sink) if semantic else (imported, check(imported.tree))
    if result is None:
        return None
    sink.report_all(result[1].diagnostics)
    return None if sink.has_errors else result[1].robot


def _checker_of(spec: SpecFile, loader: Loader) -> Callable[[YamlMap], Compilation]:
    """Return a function that compiles the tree of a spec; it reads each mesh once for all its calls."""
    meshes = MeshSolids(loader.budget)
    return lambda tree: check_alone(meshes, replace(spec, tree=tree), loader)


@gc_paused()
@suggestion_budget()
def _imported(urdf: _Urdf, srdf: Path | None, settings: Settings) -> Import:
    sink = Diagnostics()
    loader = settings.loader(urdf.path)
    try:
        arguments = settings.arguments(loader, sink)
        text = _imported_text(urdf, srdf, settings, arguments, loader=loader, sink=sink)
    except BeyondLimitError as beyond:
        sink.abort(beyond)
        text = None
    report = group_alike(sink.sorted())
    if text is None or urdf.text is not None or not urdf.path.is_file():
        return Import(text, report)
    return Import(text, report, _origin(urdf.path, srdf, arguments, settings, loader))


def _origin(urdf: Path, srdf: Path | None, arguments: Arguments, settings: Settings, loader: Loader) -> Origin:
    values = ((name, entry.value) for name, entry in arguments.entries.items())
    assignments = tuple(f"{name}:={value.text}" for name, value in values if isinstance(value, YamlScalar))
    # Not the files again: one may be a pipe.
    texts = {source.path: source.text.encode() for source in loader.sources if source.path}
    others = (file.read_bytes() for file in loader.files if file not in texts and file.is_file())
    packages = {name: Path(place) for name, place in (settings.packages or {}).items()}
    digest = digest_of((*texts.values(), *others))
    return Origin(urdf, srdf, assignments, digest, packages, settings.allow_outside)


def _imported_text(
    urdf: _Urdf, srdf: Path | None, settings: Settings, arguments: Arguments, *, loader: Loader, sink: Diagnostics
) -> str | None:
    from linkforge_compile.importers.srdf_with_urdf import with_srdf

    semantic = _open_srdf(srdf, arguments, loader, sink) if srdf else None
    declared = semantic.arguments if semantic else None if srdf else frozenset()
    if urdf.text is None and is_xacro(urdf.path):
        folder = urdf.output or urdf.path.parent
        found = _read_xacro(urdf.path, arguments, declared, loader, sink, spec_folder=folder)
    else:
        found = _read_urdf(urdf, arguments, declared, loader, sink)
    if found is None or (srdf and semantic is None):
        return None
    file, robot = found
    # Before compiling: a robot that is too large for a spec is not compiled.
    charge_entries(robot.tree, 1, Budget())
    text = None if semantic else _spec_text(robot, sink)
    check = _checker_of(SpecFile(file, robot.tree, urdf.path.parent), loader)
    both = with_srdf(robot, semantic.text, check, sink, semantic.moved) if semantic else (robot, check(robot.tree))
    if both is None:
        return None
    # The tree has the spans of the files, so faults of the robot are reported there.
    whole, compiled = both
    sink.report_all(compiled.diagnostics)
    # A robot with an error contains replacement values, which are in neither of its documents.
    if compiled.robot is not None and not sink.has_errors:
        _check_imported(whole, compiled.robot, urdf.output, sink)
    if sink.places_of(_WRONG_ARGUMENTS):
        return None
    text = _spec_text(whole, sink) if text is None else text
    if not sink.has_errors:
        sink.report_all(_faults_of_text(text, urdf.path, settings))
    return text


def _check_imported(whole: Imported, robot: Robot, output: Path | None, sink: Diagnostics) -> None:
    """Report names in raw XML, what is written twice, losses and, for a spec in the folder `output`, mesh paths."""
    from linkforge_compile.formats.limits import check_raw_names, check_written_twice
    from linkforge_compile.formats.parts import doubtful_parts_of_urdf
    from linkforge_compile.formats.relative_paths import check_relative_mesh_paths

    sink.report_all(check_raw_names(robot))
    sink.report_all(check_written_twice(doubtful_parts_of_urdf(robot).with_extras))
    sink.report_all(_losses(whole, robot, sink.places_of(LOSSES)))
    if output is not None:
        sink.report_all(check_relative_mesh_paths(robot, output, MESH_BESIDE_THE_URDF, document="spec"))


def _faults_of_text(text: str, urdf: Path, settings: Settings) -> Iterator[Diagnostic]:
    """Yield the errors of a spec as it is written, at its lines, which its tree did not have."""
    compiled = compile_source(text, "<spec>", urdf.parent, settings._replace(parameters=None))
    yield from (one for one in compiled.diagnostics if one.severity is Severity.ERROR)


def _spec_text(imported: Imported, sink: Diagnostics) -> str:
    """Return the text of a spec; report what it loses.

    Raises:
        BeyondLimitError: if the spec is too large, at the robot, because the text is not shown.

    """
    from linkforge_compile.importers.losses import text_losses
    from linkforge_compile.syntax.writer import write

    budget = Budget()
    charge_entries(imported.tree, 1, budget)  # an SRDF has added to them
    text = write(imported.tree, *imported.comments)
    try:
        again = read(SourceFile("<spec>", text), Diagnostics(), budget)
    except BeyondLimitError:
        raise budget.beyond(Limit.VALUES, imported.tree.span) from None
    sink.report_all(text_losses(imported.tree, again))
    return text


_Read = tuple[SourceFile, Imported]


def _open_srdf(srdf: Path, arguments: Arguments, loader: Loader, sink: Diagnostics) -> Expansion | None:
    from linkforge_compile.expand.expand_uses import open_semantic
    from linkforge_compile.load.xacro import XacroUse

    # The user named it like the URDF, and a xacro of MoveIt includes files from its own package.
    loader.roots = loader.roots.with_those_around(srdf)
    return open_semantic(XacroUse(srdf, ImportSite(str(srdf), None)), arguments, loader, sink)


_Names = Collection[str] | None
"""The names of the arguments that the SRDF declares; None if unknown."""


def _read_urdf(urdf: _Urdf, arguments: Arguments, declared: _Names, loader: Loader, sink: Diagnostics) -> _Read | None:
    from linkforge_compile.importers.urdf import read_urdf

    named, text = urdf.path, urdf.text
    file = loader.open_xml(named, sink) if text is None else loader.add_xml(str(named), text)
    robot = read_urdf(file, sink, keeps_refused=True) if file else None
    # Reported after reading: a xacro without that suffix could accept them, and is reported as such.
    if file and robot and declared is not None:
        for name, entry in arguments.without(declared).entries.items():
            note = Note("a URDF takes no arguments", file.whole)
            sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=declared, notes=[note]))
    return (file, robot) if file and robot else None


def _read_xacro(
    xacro: Path, arguments: Arguments, declared: _Names, loader: Loader, sink: Diagnostics, *, spec_folder: Path
) -> _Read | None:
    from linkforge_compile.expand.arguments import xacro_arguments
    from linkforge_compile.load.xacro import XacroUse, read_xacro

    use = XacroUse(xacro, ImportSite(str(xacro), None), xacro_arguments(arguments, sink), used_elsewhere=declared)
    robot = read_xacro(use, loader, sink, keeps_refused=True, spec_folder=spec_folder)
    return (robot[0][0], robot[1]) if robot else None


def _losses(imported: Imported, robot: Robot, reported: Collection[Span]) -> Iterator[Diagnostic]:
    """Yield what the documents lose in the compiled robot, except at places with a report already."""
    from linkforge_compile.importers.losses import losses
    from linkforge_compile.importers.xml import read_xml

    for document, format_ in zip(imported.documents, _IMPORTED, strict=False):
        compiled = read_xml(SourceFile("<compiled>", format_.text(robot)), Diagnostics(), is_ours=True)
        assert compiled, "what we render is XML"
        yield from (loss for loss in losses(document, compiled) if loss.span not in reported)
