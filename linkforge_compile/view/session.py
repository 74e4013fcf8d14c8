"""What a live viewer holds, without a network: settings, the last good scene, problems of the spec, and versions."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from threading import Condition
from typing import TYPE_CHECKING, NamedTuple, TypeAlias, TypedDict

from linkforge_compile.analysis import Parameters, Settings, analyse_path
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Severity
from linkforge_compile.diagnostics.render_text import MOST_SHOWN, snippet
from linkforge_compile.diagnostics.reports import Selection, count_losses
from linkforge_compile.expand import CliArgument, arguments_from_text
from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.formats.mesh_paths import mesh_paths, places_of_files, texture_paths
from linkforge_compile.listing import ListedParameter, Listing, Plain, as_written
from linkforge_compile.pipeline import parameters_of
from linkforge_compile.view.files import RobotFiles, collect_files
from linkforge_compile.view.scene import Scene, make_scene

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

PANEL = "<parameters>"
"""The name of the page's panel as the place of a value, in diagnostics."""

ALL = Selection()
"""What is reported without options: everything."""

NO_SCENE: Scene = {
    "name": "",
    "links": [],
    "joints": [],
    "states": [],
    "files": {},
    "missing": [],
    "view": {"panels": True},
    "live": True,
    "version": 0,
}
"""What a page shows until the spec has been compiled without errors."""

Changes: TypeAlias = tuple[Path | str, ...]
"""Files, and what else has changed, by its name."""


class Problem(TypedDict):
    """A diagnostic as the page shows it; file, line and column are None for one without a place in a file.

    `page` is the address of the code's manual page, below that of the viewer. `hints` are its notes and fixes, and
    `snippet` is the line at fault with a caret under the words, "" for none.
    """

    severity: str
    code: str
    message: str
    file: str | None
    line: int | None
    column: int | None
    page: str
    hints: list[str]
    snippet: str


class ParameterSetting(TypedDict):
    """A parameter as its widget shows it; numbers are in `unit`, an SI unit.

    `value` is what the user set, as text; None for the default, which the chosen variant may replace.
    """

    name: str
    type: str | None
    unit: str | None
    value: str | None
    default: str | None
    minimum: Plain
    maximum: Plain
    choices: list[Plain] | None
    description: str


class ShownSettings(TypedDict):
    """What the user may set, with what is set."""

    parameters: list[ParameterSetting]
    variants: list[str]
    variant: str | None


class Update(TypedDict):
    """What a page receives; `scene` is None if it shows that already."""

    version: int
    scene: Scene | None
    problems: list[Problem]
    settings: ShownSettings


class State(NamedTuple):
    """What all pages show, after one compile.

    `scene` is that of the last compile without errors, and was new in `scene_version`, 0 for none yet. `is_current` is
    false if the latest compile had errors. `files` are those of the scene, `former_files` those of the scene before,
    which a page may still be loading. `watched` are the files on which it all depends, whether or not they exist.
    """

    version: int = 0
    scene: Scene = NO_SCENE
    scene_version: int = 0
    is_current: bool = False
    files: RobotFiles = RobotFiles()
    former_files: RobotFiles = RobotFiles()
    diagnostics: tuple[Diagnostic, ...] = ()
    settings: Settings = Settings()
    listing: Listing | None = None
    watched: tuple[Path, ...] = ()

    def update_since(self, version: int) -> Update:
        """Return what a page needs that has the scene of a version; 0 for none."""
        return {
            "version": self.version,
            "scene": self.scene if version < self.scene_version else None,
            "problems": _problems(self.diagnostics),
            "settings": _shown_settings(self.settings, self.listing),
        }

    def content_of(self, digest: str) -> tuple[str, bytes] | None:
        """Return the kind and the bytes of a file of the scene or of the one before; None for no such file."""
        file = self.files.files.get(digest) or self.former_files.files.get(digest)
        return (file.kind, file.content) if file else None


def compile_state(spec: Path, settings: Settings, selection: Selection, last: State) -> State:
    """Compile a spec and return what is shown next; what is new in a spec with errors is its problems.

    What the page sets of parameters that the spec no longer declares has no effect.
    """
    listing, _ = parameters_of(spec, packages=settings.packages, allow_outside=settings.allow_outside)
    listing = listing or last.listing
    settings = _with_declared_only(settings, listing)
    compilation = analyse_path(spec, settings).compilation
    state = last._replace(
        version=last.version + 1,
        is_current=compilation.robot is not None,
        diagnostics=selection.of(compilation.diagnostics),
        settings=settings,
        listing=listing,
        watched=tuple(dict.fromkeys((spec, *compilation.files, *compilation.unread))),
    )
    if compilation.robot is None:
        # The files of the last scene may be what was changed to correct it.
        return state._replace(watched=tuple(dict.fromkeys((*state.watched, *last.watched))))
    return _with_scene(state, compilation.robot)


def _with_scene(state: State, robot: Robot) -> State:
    files = collect_files(robot)
    scene = make_scene(robot, files, is_live=True)
    scene["version"] = state.scene_version
    shapes = places_of_files(robot, chain(mesh_paths(robot), texture_paths(robot)))
    state = state._replace(watched=tuple(dict.fromkeys((*state.watched, *shapes))))
    if scene == state.scene:
        return state
    scene["version"] = state.version
    return state._replace(scene=scene, scene_version=state.version, files=files, former_files=state.files)


class Session:
    """The state that pages show: one thread renews it, and others choose settings and wait for updates."""

    def __init__(self, spec: Path, settings: Settings, selection: Selection = ALL) -> None:
        self._spec, self._settings, self._selection = spec, settings, selection
        self._state = State()
        self._watcher = FileWatcher([spec])
        self._news = Condition()
        self._chosen: dict[str, None] = {}
        """What was set since the last poll."""
        self._is_closed = False

    @property
    def state(self) -> State:
        return self._state

    @property
    def is_closed(self) -> bool:
        return self._is_closed

    def renew(self) -> State:
        """Compile with the latest settings, and give the result to those who wait."""
        began = time.time_ns()
        with self._news:
            settings = self._settings
        state = compile_state(self._spec, settings, self._selection, self._state)
        self._watcher.track(state.watched, began)
        with self._news:
            self._state = state
            self._news.notify_all()
        return state

    def choose(self, values: Mapping[str, str], variant: str | None) -> None:
        """Set parameters, all others to their defaults, and the variant; the next `renew` compiles with them."""
        with self._news:
            before = values_of(self._settings.parameters)
            names = dict.fromkeys((*before, *values))
            changed = [f"parameter {name}" for name in names if before.get(name) != values.get(name)]
            changed += ["the variant"] if variant != self._settings.variant else []
            parameters = {name: CliArgument(PANEL, name, text) for name, text in values.items()}
            self._settings = self._settings._replace(parameters=parameters, variant=variant)
            self._chosen |= dict.fromkeys(changed)
            self._news.notify_all()

    def poll(self) -> Changes:
        """Return the files that changed and the parameters that were set since the last poll."""
        with self._news:
            chosen, self._chosen = tuple(self._chosen), {}
        return *chosen, *self._watcher.poll()

    def pause(self, seconds: float) -> None:
        """Sleep, but no longer than until a parameter is set."""
        with self._news:
            self._news.wait_for(lambda: self._chosen, seconds)

    def wait(self, version: int, seconds: float) -> State:
        """Return the state once it is newer than a version; after the time, or once it is closed, as it is."""
        with self._news:
            self._news.wait_for(lambda: self._is_closed or self._state.version > version, seconds)
            return self._state

    def close(self) -> None:
        """Release all who wait."""
        with self._news:
            self._is_closed = True
            self._news.notify_all()


def values_of(parameters: Parameters | None) -> dict[str, str]:
    """Return what parameters are set to, as text by name."""
    if isinstance(parameters, Mapping):
        return {name: value.text for name, value in parameters.items() if isinstance(value, CliArgument)}
    entries = arguments_from_text(tuple(parameters or ()), Diagnostics()).entries
    return {name: as_written(entry.value) for name, entry in entries.items()}


def _with_declared_only(settings: Settings, listing: Listing | None) -> Settings:
    """Leave out what the page set of parameters that are not declared; those of the command line are reported."""
    if listing is None or not isinstance(settings.parameters, Mapping):
        return settings
    declared = {one.name for one in listing.parameters}
    return settings._replace(
        parameters={name: value for name, value in settings.parameters.items() if name in declared}
    )


def _shown_settings(settings: Settings, listing: Listing | None) -> ShownSettings:
    if listing is None:
        return {"parameters": [], "variants": [], "variant": settings.variant}
    values, by_variant = values_of(settings.parameters), dict[str, str]()
    for name in (settings.variant or "").split("+"):
        by_variant |= listing.variants.get(name, {})
    return {
        "parameters": [_shown(one, values.get(one.name), by_variant.get(one.name)) for one in listing.parameters],
        "variants": list(listing.variants),
        "variant": settings.variant,
    }


def _shown(parameter: ListedParameter, value: str | None, of_variant: str | None) -> ParameterSetting:
    default = parameter.default if of_variant is None else of_variant
    if of_variant is None and "$(" in (default or ""):
        default = parameter.computed or default
    return {
        "name": parameter.name,
        "type": parameter.type,
        "unit": parameter.unit,
        "value": value,
        "default": default,
        "minimum": parameter.minimum,
        "maximum": parameter.maximum,
        "choices": parameter.choices,
        "description": parameter.description,
    }


def _problems(diagnostics: Iterable[Diagnostic]) -> list[Problem]:
    """Return the diagnostics that a report in text shows, errors first."""
    diagnostics = tuple(diagnostics)
    shown = [one for one in count_losses(diagnostics, [diagnostics]) if not one.is_only_counted]
    shown.sort(key=lambda one: list(Severity).index(one.severity))
    return [_problem(one) for one in shown[:MOST_SHOWN]]


def _problem(one: Diagnostic) -> Problem:
    span = one.span if one.span and one.span.file.path else None
    return {
        "severity": one.severity.value,
        "code": one.code.id,
        "message": one.message,
        "file": span.file.shown if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
        "page": f"codes/{one.code.id}",
        "hints": list(_hints(one)),
        "snippet": "\n".join(snippet(one.span)),
    }


def _hints(one: Diagnostic) -> Iterator[str]:
    for note in one.notes:
        yield f"{note.span}: {note.message}" if note.span else note.message
    yield from (fix.title for fix in one.fixes)
