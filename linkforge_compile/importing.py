"""The way in: a robot that was written as URDF, SRDF or xacro becomes a spec, and is judged as one."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics, Note, Severity
from linkforge_compile.diagnostics.codes.importing import LOSSES, MESH_BESIDE_THE_URDF
from linkforge_compile.diagnostics.codes.modules import NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_PARAMETER
from linkforge_compile.diagnostics.suggest import suggesting
from linkforge_compile.expand import XACRO, Arguments, ImportSite, Loader, SpecFile
from linkforge_compile.expand.assembly import charge_entries
from linkforge_compile.formats import SRDF, URDF, render_srdf, render_urdf
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.importers.document import Imported
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.lower import MeshSolids
from linkforge_compile.pipeline import Judged, Packages, Parameters, Settings, gc_paused, judged
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlMap, read

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.expand.merge_srdf import Semantic
    from linkforge_compile.formats.urdf import Gazebo

_IMPORTED = (URDF, SRDF)
"""The formats of the documents of an import, in their order."""

_WRONG_ARGUMENTS = (NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_PARAMETER)
"""What is told of arguments that are not those that the files take: another robot is meant than the one read."""


@dataclass(frozen=True)
class Import:
    """What reading a robot that was written elsewhere gave: a spec, and what is to be told about it.

    `text` is None where the file is not the robot that it is said to be, or does not take the arguments.
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

    Its errors are told where those files have them. A xacro, of either, is expanded first with those of the arguments
    that it takes, its packages are looked for in `packages` before other places, and what it names is read where
    `compile_file` reads; `allow_outside` lets it read anything. `output` is the folder that the spec is for: meshes
    that lie beside the URDF and not there are told. `text` is the URDF where it is no file: `path` then is what it is
    called, and its folder the one where its relative paths start.
    """
    settings = Settings(arguments, packages, allow_outside=allow_outside, output=Path(output) if output else None)
    urdf = _Urdf(Path(path), text)
    return on_fresh_stack(lambda: _imported(urdf, None if srdf is None else Path(srdf), settings))


class _Urdf(NamedTuple):
    """What is imported: a file, or a text that is called so."""

    path: Path
    text: str | None


class ReadBack(NamedTuple):
    """A robot as its URDF and SRDF say it, None where those are refused, and the errors that say why."""

    robot: Robot | None
    faults: tuple[Diagnostic, ...]


def as_read_back(robot: Robot, *, gazebo: Gazebo = "gz") -> ReadBack:
    """Return a robot as its URDF and SRDF say it, for whoever lays it beside one that was read from those.

    Its sensors are Gazebo's then, and it has no metadata.
    """
    sink = Diagnostics()
    try:
        back = on_fresh_stack(lambda: _read_back(robot, gazebo, sink))
    except BeyondLimitError as beyond:
        sink.end(beyond)
        back = None
    return ReadBack(back, tuple(one for one in sink.sorted() if one.severity is Severity.ERROR))


@gc_paused()
@suggesting()
def _read_back(robot: Robot, gazebo: Gazebo, sink: Diagnostics) -> Robot | None:
    from linkforge_compile.importers.srdf import with_srdf
    from linkforge_compile.importers.urdf import read_urdf

    loader = Settings().loader(None)
    file = SourceFile("<urdf>", render_urdf(robot, gazebo=gazebo))
    imported = read_urdf(file, sink, keeps_refused=True)
    if imported is None:
        return None
    judge = _judge_of(SpecFile(file, imported.tree, None), loader)
    semantic = SourceFile("<srdf>", render_srdf(robot)) if robot.has_semantic else None
    both = with_srdf(imported, semantic, judge, sink) if semantic else (imported, judge(imported.tree))
    if both is None:
        return None
    sink.report_all(both[1].faults)
    return None if sink.has_errors else both[1].robot


def _judge_of(spec: SpecFile, loader: Loader) -> Callable[[YamlMap], Judged]:
    """Return what compiles a tree as that of a spec, by itself; of all that it is asked for, each mesh is read once."""
    meshes = MeshSolids(loader.budget)
    return lambda tree: judged(meshes, replace(spec, tree=tree), loader)


@gc_paused()
@suggesting()
def _imported(urdf: _Urdf, srdf: Path | None, settings: Settings) -> Import:
    sink = Diagnostics()
    try:
        text = _imported_text(urdf, srdf, settings, sink)
    except BeyondLimitError as beyond:
        sink.end(beyond)
        text = None
    return Import(text, sink.sorted())


def _imported_text(urdf: _Urdf, srdf: Path | None, settings: Settings, sink: Diagnostics) -> str | None:
    from linkforge_compile.formats.limits import check_written_twice
    from linkforge_compile.formats.parts import doubtful_parts_of_urdf
    from linkforge_compile.formats.relative_paths import lost_on_the_way
    from linkforge_compile.importers.srdf import with_srdf

    loader = settings.loader(urdf.path)
    arguments = settings.arguments(loader, sink)
    semantic = _open_srdf(srdf, arguments, loader, sink) if srdf else None
    taken = semantic.arguments if semantic else None if srdf else frozenset()
    if urdf.path.suffix.lower() == XACRO:
        found = _read_xacro(urdf.path, arguments, taken, loader, sink)
    else:
        found = _read_urdf(urdf, arguments, taken, loader, sink)
    if found is None or (srdf and semantic is None):
        return None
    file, robot = found
    # Before it is judged: of what is too large for a spec no more is to be known.
    charge_entries(robot.tree, 1, Budget())
    text = None if semantic else _spec_text(robot, sink)
    judge = _judge_of(SpecFile(file, robot.tree, urdf.path.parent), loader)
    both = with_srdf(robot, semantic.text, judge, sink, semantic.moved) if semantic else (robot, judge(robot.tree))
    if both is None:
        return None
    # The tree has the spans of the files, so what is wrong with the robot is told there.
    whole, compiled = both
    sink.report_all(compiled.faults)
    # A robot with an error has what stands in for that, which is in neither of its documents.
    if compiled.robot is not None and not sink.has_errors:
        sink.report_all(check_written_twice(doubtful_parts_of_urdf(compiled.robot).with_extras))
        sink.report_all(_losses(whole, compiled.robot, sink.places_of(LOSSES)))
        if settings.output is not None:
            sink.report_all(lost_on_the_way(compiled.robot, settings.output, MESH_BESIDE_THE_URDF))
    if sink.places_of(_WRONG_ARGUMENTS):
        return None
    return _spec_text(whole, sink) if text is None else text


def _spec_text(imported: Imported, sink: Diagnostics) -> str:
    """Return the text of a spec; report what that does not say, and raise BeyondLimitError where none can be so large.

    What is too large is told at the robot, for nobody sees the text.
    """
    from linkforge_compile.importers.losses import unread
    from linkforge_compile.syntax.writer import write

    budget = Budget()
    charge_entries(imported.tree, 1, budget)  # an SRDF has added to them
    text = write(imported.tree, *imported.comments)
    try:
        again = read(SourceFile("<spec>", text), Diagnostics(), budget)
    except BeyondLimitError:
        raise budget.beyond(Limit.VALUES, imported.tree.span) from None
    sink.report_all(unread(imported.tree, again))
    return text


_Read = tuple[SourceFile, Imported]


def _open_srdf(srdf: Path, arguments: Arguments, loader: Loader, sink: Diagnostics) -> Semantic | None:
    from linkforge_compile.expand.merge_srdf import open_semantic
    from linkforge_compile.expand.xacro_use import XacroUse

    # Its user named it as he named the URDF, and a xacro of MoveIt includes what lies in a package of its own.
    loader.roots = loader.roots.with_those_around(srdf)
    return open_semantic(XacroUse(srdf, ImportSite(str(srdf), None), arguments), loader, sink)


_Taken = Collection[str] | None
"""The names of arguments that the SRDF takes; None where nobody knows."""


def _read_urdf(urdf: _Urdf, arguments: Arguments, taken: _Taken, loader: Loader, sink: Diagnostics) -> _Read | None:
    from linkforge_compile.importers.urdf import read_urdf

    named, text = urdf
    file = loader.open_xml(named, sink) if text is None else loader.add_xml(str(named), text)
    robot = read_urdf(file, sink, keeps_refused=True) if file else None
    # A xacro that is not named as one, and is told as that, would take them.
    if file and robot and taken is not None:
        for name, entry in arguments.without(taken).entries.items():
            note = Note("a URDF takes no arguments", file.whole)
            sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=taken, notes=[note]))
    return (file, robot) if file and robot else None


def _read_xacro(xacro: Path, arguments: Arguments, taken: _Taken, loader: Loader, sink: Diagnostics) -> _Read | None:
    from linkforge_compile.expand.xacro import read_xacro
    from linkforge_compile.expand.xacro_use import XacroUse

    expanded = read_xacro(
        XacroUse(xacro, ImportSite(str(xacro), None), arguments, used_elsewhere=taken), loader, sink, keeps_refused=True
    )
    return (expanded.file, expanded.imported) if expanded else None


def _losses(imported: Imported, robot: Robot, told: Collection[Span]) -> Iterator[Diagnostic]:
    """Yield what of its documents a robot does not say as they do, but for what is told already."""
    from linkforge_compile.importers.losses import losses
    from linkforge_compile.importers.xml import read_xml

    for document, format_ in zip(imported.documents, _IMPORTED, strict=False):
        again = read_xml(SourceFile("<compiled>", format_.text(robot)), Diagnostics(), is_ours=True)
        assert again, "what we render is XML"
        yield from (loss for loss in losses(document, again) if loss.span not in told)
