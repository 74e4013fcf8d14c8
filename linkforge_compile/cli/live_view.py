"""Serves the live viewer of a spec, and compiles the spec again after each change of a file or a parameter."""

from __future__ import annotations

import argparse
import os
import sys
import webbrowser
from collections.abc import Callable
from pathlib import Path
from threading import Thread

from linkforge_compile.cli import FAULTY_SPEC, UsageError
from linkforge_compile.cli.not_shown import report_not_shown
from linkforge_compile.cli.options import compile_spec, settings_of
from linkforge_compile.cli.output import write_to_stdout
from linkforge_compile.cli.reports import (
    format_diagnostics,
    print_failure,
    print_status,
    report,
    selection_of,
    write_to_stderr,
)
from linkforge_compile.cli.specs import count
from linkforge_compile.cli.watching import Watched, repeat_on_changes
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.roots import is_file
from linkforge_compile.view.files import not_reported
from linkforge_compile.view.html import NoPageError, html_of
from linkforge_compile.view.scene import SceneView
from linkforge_compile.view.server import ViewServer
from linkforge_compile.view.session import Session, State


def view_live(
    spec: str, assignments: list[str], view_of: Callable[[Robot], SceneView], arguments: argparse.Namespace
) -> int:
    """Serve a spec until Ctrl-C; FAULTY_SPEC for no file. `view_of` returns how its robot is shown first.

    Raises:
        UsageError: The port is not free, or the page is not built.

    """
    if spec == "-":
        raise UsageError("takes a file, not standard input, which changes once; add -o FILE.html for a page")
    if not is_file(Path(spec)):
        report(compile_spec(spec, assignments, arguments).diagnostics, arguments)
        return FAULTY_SPEC
    session = Session(
        Path(spec), settings_of(assignments, arguments), selection_of(arguments), _FirstView(view_of, arguments)
    )
    # Before the server starts and the browser opens, as options may be wrong.
    states = [session.renew()]
    server = _make_server(session, arguments.port or 0)

    def renew() -> Watched:
        state = states.pop() if states else session.renew()
        _report(state, arguments)
        return Watched(state.watched, session.poll, pause=session.pause)

    server.start()
    try:
        _announce(server, arguments)
        repeat_on_changes("view", renew, arguments)
    finally:
        server.stop()


class _FirstView:
    """Returns how a robot is shown first; of one that was edited, and lacks what the options name, without these."""

    def __init__(self, view_of: Callable[[Robot], SceneView], arguments: argparse.Namespace) -> None:
        self._view_of, self._arguments = view_of, arguments
        self._has_succeeded = False

    def __call__(self, robot: Robot) -> SceneView:
        try:
            view = self._view_of(robot)
        except UsageError as error:
            if not self._has_succeeded:
                raise
            print_failure(f"linkforge view: {error}", self._arguments)
            return {"panels": True}
        self._has_succeeded = True
        return view


def _make_server(session: Session, port: int) -> ViewServer:
    try:
        html_of(session.state.scene, None)
        return ViewServer(session, lambda scene: html_of(scene, None), port)
    except NoPageError as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        raise UsageError(f"--port {port}: {error.strerror}; omit it to use any free port") from error


def _announce(server: ViewServer, arguments: argparse.Namespace) -> None:
    """Print the address, which is all that standard output gets, and open the browser."""
    write_to_stdout(f"{server.url}\n")
    if ssh := os.environ.get("SSH_CONNECTION", "").split():
        port, host = server.server_port, ssh[2] if len(ssh) > 2 else "HOST"
        print_status(f"over ssh, first run on your machine: ssh -L {port}:127.0.0.1:{port} {host}", arguments)
    if not arguments.no_browser and _has_window():
        # In a thread, because some browsers return only once they are closed.
        Thread(target=webbrowser.open, args=(server.url,), daemon=True).start()


def _has_window() -> bool:
    """Whether a browser would have a window; one in the terminal cannot show the page."""
    if sys.platform in {"win32", "darwin"}:
        return True
    return any(os.environ.get(name) for name in ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY", "WSL_DISTRO_NAME"))


def _report(state: State, arguments: argparse.Namespace) -> None:
    write_to_stderr(format_diagnostics(state.diagnostics, arguments, [state.diagnostics]))
    scene = state.scene
    if not state.scene_version:
        print_status("there is no robot to show yet", arguments)
    elif not state.is_current:
        print_status("the last robot without errors remains", arguments)
    else:
        links, joints = count(len(scene["links"]), "link"), count(len(scene["joints"]), "joint")
        report_not_shown(not_reported(state.files.missing, state.diagnostics), arguments)
        print_status(f"shows {scene['name']}: {links}, {joints}", arguments)
