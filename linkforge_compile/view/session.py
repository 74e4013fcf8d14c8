"""The state of a live viewer, without a network: settings, the last good scene, problems of the spec, and versions."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from enum import Enum
from pathlib import Path
from threading import Condition
from typing import NamedTuple, TypeAlias

from linkforge_compile.analysis import Settings, analyse_path
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.reports import Selection
from linkforge_compile.expand import CliArgument
from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.listing import Listing
from linkforge_compile.pipeline import parameters_of
from linkforge_compile.roots import identity
from linkforge_compile.view.files import RobotFiles, collect_files, not_reported
from linkforge_compile.view.scene import Scene, SceneView, make_scene
from linkforge_compile.view.updates import Update, problems_of, shown_settings, values_of

PAGE = "<viewer page>"
"""The place, in diagnostics, of a value that was set in the page."""

ViewOf: TypeAlias = "Callable[[Robot], SceneView] | None"
"""Returns how a robot is shown at first; None without options."""


class Unchanged(Enum):
    """The value for a variant that a page does not change; None selects no variant."""

    UNCHANGED = "unchanged"


UNCHANGED = Unchanged.UNCHANGED

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
"""The files that changed, and the names of other things that did."""


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
        """Return what a page needs if it has the scene of a version; 0 for no scene."""
        return {
            "version": self.version,
            "scene": self.scene if version < self.scene_version else None,
            "problems": problems_of(self.diagnostics, self.files.missing),
            "settings": shown_settings(self.settings, self.listing),
        }

    def content_of(self, digest: str) -> tuple[str, bytes] | None:
        """Return the kind and the bytes of a file of this scene or the previous one; None for any other file."""
        file = self.files.files.get(digest) or self.former_files.files.get(digest)
        return (file.kind, file.content) if file else None


def compile_state(
    spec: Path, settings: Settings, last: State, selection: Selection = ALL, view_of: ViewOf = None
) -> State:
    """Compile a spec and return the next state; of a spec with errors, only the problems are new.

    Values that the page set for parameters that the spec no longer declares have no effect.
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
        # The change that corrects it may be in the files of the last scene.
        return state._replace(watched=tuple(dict.fromkeys((*state.watched, *last.watched))))
    return _with_scene(state, compilation.robot, view_of(compilation.robot) if view_of else None)


def _with_scene(state: State, robot: Robot, view: SceneView | None) -> State:
    files = collect_files(robot)
    # The others are among the problems.
    listed = files._replace(missing=not_reported(files.missing, state.diagnostics))
    scene = make_scene(robot, listed, view, is_live=True)
    scene["version"] = state.scene_version
    by_file = {identity(path): path for path in reversed((*state.watched, *files.paths))}
    state = state._replace(watched=tuple(reversed(by_file.values())))
    if scene == state.scene:
        return state._replace(files=state.files._replace(missing=files.missing))
    scene["version"] = state.version
    return state._replace(scene=scene, scene_version=state.version, files=files, former_files=state.files)


class Session:
    """The state that pages show: one thread renews it, and others choose settings and wait for updates."""

    def __init__(self, spec: Path, settings: Settings, selection: Selection = ALL, view_of: ViewOf = None) -> None:
        self._spec, self._settings, self._selection, self._view_of = spec, settings, selection, view_of
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
        """Compile with the latest settings, and give the result to all threads that wait."""
        began = time.time_ns()
        with self._news:
            settings = self._settings
        state = compile_state(self._spec, settings, self._state, self._selection, self._view_of)
        self._watcher.track(state.watched, began)
        with self._news:
            self._state = state
            self._news.notify_all()
        return state

    def choose(self, values: Mapping[str, str | None], variant: str | None | Unchanged = UNCHANGED) -> None:
        """Set parameters, None to the default, and the variant, None for none; the next `renew` compiles with them."""
        with self._news:
            before = values_of(self._settings.parameters)
            after = {name: text for name, text in {**before, **values}.items() if text is not None}
            changed = [f"parameter {name}" for name in values if before.get(name) != after.get(name)]
            if not isinstance(variant, Unchanged) and variant != self._settings.variant:
                changed.append("the variant")
                self._settings = self._settings._replace(variant=variant)
            parameters = {name: CliArgument(PAGE, name, text) for name, text in after.items()}
            self._settings = self._settings._replace(parameters=parameters)
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
        """Return the state once it is newer than a version; the current one after the time or once it is closed."""
        with self._news:
            self._news.wait_for(lambda: self._is_closed or self._state.version > version, seconds)
            return self._state

    def close(self) -> None:
        """Release all threads that wait."""
        with self._news:
            self._is_closed = True
            self._news.notify_all()


def _with_declared_only(settings: Settings, listing: Listing | None) -> Settings:
    """Remove values from the page for undeclared parameters; those of the command line are reported."""
    if listing is None or not isinstance(settings.parameters, Mapping):
        return settings
    declared = {one.name for one in listing.parameters}
    return settings._replace(
        parameters={name: value for name, value in settings.parameters.items() if name in declared}
    )
