"""`linkforge view`: a robot in the browser, as a page that works offline, or as a picture."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.not_shown import report_not_shown
from linkforge_compile.cli.options import (
    add_spec_and_values,
    add_spec_options,
    compile_spec,
    require_one_spec,
    split_assignments,
    whole_number,
)
from linkforge_compile.cli.poses import positions_of
from linkforge_compile.cli.reports import add_report_options, print_status, progress_after, report
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.core.models.joint import SINGLE_AXIS
from linkforge_compile.diagnostics.enumerations import alternatives

if TYPE_CHECKING:
    from linkforge_compile.cli.output import Content
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.view.files import RobotFiles
    from linkforge_compile.view.picture import Size
    from linkforge_compile.view.scene import Scene, SceneCamera, SceneView

_FORMATS_BY_ENDING = {".html": "html", ".htm": "html", ".png": "png"}

LAYERS = ("visuals", "collisions", "frames", "axes", "centers", "inertias", "grid", "labels")
"""What the page can show, as in `view/page/src/state.ts`."""

DEFAULT_SIZE = "1280x960"

MAX_SIDE = 8192
"""The widest and highest picture that browsers draw [pixels]."""

MAX_PORT = 65535

_EXAMPLES = """\
Without -o, it opens the robot in the browser, and shows each change of the spec and of its parameters until Ctrl-C.
Errors are shown over the last robot without errors. docs/view.md describes how to view a robot on another machine.

With -o, it writes a file. A page contains the meshes and works without a network: you can turn the robot, move its
joints, and show its frames, axes, masses and collisions. Chrome, Chromium or Edge draws a picture without a window,
even on machines without a graphics card; to use another browser, set LINKFORGE_BROWSER.

examples:
  linkforge view arm.robot.yaml                                 in the browser, live
  linkforge view arm.robot.yaml --no-browser --port 8123        print the address only
  linkforge view arm.robot.yaml -o arm.html                     a page to open, to send, or to keep in CI
  linkforge view arm.robot.yaml -o arm.png --pose arm/home      a picture in state `home` of group `arm`
  linkforge view arm.urdf -o arm.png --pose elbow=30deg         or with joints where the options have them
  linkforge view arm.robot.yaml -o arm.png --camera=-40,25      seen from 40 deg right of x, 25 deg above
  linkforge view arm.robot.yaml -o arm.png --show collisions,frames --size 800x600
  linkforge view arm.urdf.xacro -o arm.html reach:=0.7          any robot that `compile` accepts
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge view [options] SPEC [-o FILE] [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_spec_and_values(parser)
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        dest="outputs",
        action="append",
        default=[],
        help="write the page, FILE.html, or the picture, FILE.png, without opening a browser; repeat it for the "
        "other one",
    )
    parser.add_argument(
        "--format",
        choices=sorted(set(_FORMATS_BY_ENDING.values())),
        help="the format of an output with another suffix, or of -o -",
    )
    _add_first_view_options(parser)
    _add_live_options(parser)
    add_spec_options(parser)
    add_report_options(parser)


def _add_first_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for how the robot is shown first."""
    parser.add_argument(
        "--pose",
        metavar="STATE",
        dest="poses",
        action="append",
        default=[],
        help="the positions of the joints: GROUP/STATE, STATE of every group that has it, or JOINT=VALUE; repeat it "
        "for "
        "others (default: 0, or the middle of limits that exclude 0)",
    )
    parser.add_argument(
        "--camera",
        metavar="AZIMUTH,ELEVATION[,DISTANCE]",
        type=_camera,
        help="the position of the camera: degrees about z from x, degrees above the ground, and metres from the centre "
        "of the robot (default: far enough to show all of it)",
    )
    parser.add_argument(
        "--size",
        metavar="WIDTHxHEIGHT",
        type=_size,
        default=DEFAULT_SIZE,
        help=f"of a picture, in pixels (default: {DEFAULT_SIZE})",
    )
    parser.add_argument(
        "--show",
        metavar="LAYER[,...]",
        type=_layers,
        help=f"the layers to show instead of visuals and grid: {', '.join(LAYERS)}",
    )


def _add_live_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the page that a server shows."""
    parser.add_argument(
        "--port",
        metavar="N",
        type=whole_number(0, MAX_PORT),
        help="serve the page on this port of 127.0.0.1 (default: any free port)",
    )
    parser.add_argument(
        "--no-browser", action="store_true", help="print the address of the page without opening a browser"
    )


def run(arguments: argparse.Namespace) -> int:
    specs, assignments = split_assignments(arguments.words)
    spec = require_one_spec(specs)
    if not arguments.outputs:
        return _view_live(spec, assignments, arguments)
    outputs = _outputs(arguments)
    compilation = compile_spec(spec, assignments, arguments)
    if report(compilation.diagnostics, arguments) or compilation.robot is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import refuse_to_replace, write_document
    from linkforge_compile.view.files import collect_files, not_reported
    from linkforge_compile.view.scene import make_scene

    robot = compilation.robot
    view = _view(robot, arguments)
    files = collect_files(robot)
    refuse_to_replace((*compilation.files, *files.paths), outputs)
    report_not_shown(not_reported(files.missing, compilation.diagnostics), arguments)
    if "png" in outputs.values():
        _hint_at_layers(robot, arguments)
    scene = make_scene(robot, files, view)
    contents = {path: _content(form, scene, files, arguments) for path, form in outputs.items()}
    for path, content in contents.items():
        write_document(content, path, arguments)
    return OK


def _view_live(spec: str, assignments: list[str], arguments: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C."""
    if arguments.format or arguments.size != _size(DEFAULT_SIZE):
        option = "--format" if arguments.format else "--size"
        raise UsageError(f"{option} is about a file; add -o FILE.html for a page, or -o FILE.png for a picture")
    from linkforge_compile.cli.live_view import view_live

    return view_live(spec, assignments, lambda robot: _view(robot, arguments), arguments)


def _outputs(arguments: argparse.Namespace) -> dict[Path | None, str]:
    """Return the format of each output, None for standard output."""
    if arguments.port is not None or arguments.no_browser:
        option = "--port" if arguments.port is not None else "--no-browser"
        raise UsageError(f"{option} is about the page in a browser, which -o does not open")
    outputs: dict[Path | None, str] = {}
    for word in arguments.outputs:
        path = file_to_write(word)
        form = arguments.format or _FORMATS_BY_ENDING.get(Path(word).suffix.lower())
        if form is None:
            raise UsageError(f"-o takes a file that ends in .html or .png, found '{word}'; or name its --format")
        if path in outputs:
            raise UsageError(f"-o '{word}' is given twice")
        outputs[path] = form
    return outputs


def _view(robot: Robot, arguments: argparse.Namespace) -> SceneView:
    """Return what the options say about how the robot is shown first."""
    view: SceneView = {"panels": True}
    if arguments.poses:
        view["pose"] = positions_of(robot, arguments.poses)
    if arguments.camera:
        view["camera"] = arguments.camera
    if arguments.show:
        view["layers"] = arguments.show
    return view


def _hint_at_layers(robot: Robot, arguments: argparse.Namespace) -> None:
    """Say what to show of a robot that has nothing in the layers of a picture."""
    parts = [link.inertial for link in robot.links if link.inertial]
    has_parts = {
        "visuals": any(link.visuals for link in robot.links),
        "collisions": any(link.collisions for link in robot.links),
        "axes": any(joint.type in SINGLE_AXIS for joint in robot.joints),
        **dict.fromkeys(("centers", "inertias"), any(part.mass for part in parts)),
    }
    layers = [layer for layer in arguments.show or ["visuals"] if layer != "grid"]
    if not layers or any(has_parts.get(layer, True) for layer in layers):
        return
    others = ",".join(layer for layer in ("collisions", "frames") if has_parts.get(layer, True))
    print_status(f"the picture is empty: the robot has no {alternatives(layers)}; use --show {others}", arguments)


def _content(form: str, scene: Scene, files: RobotFiles, arguments: argparse.Namespace) -> Content:
    """Return the page or the picture of a scene; UsageError if this machine cannot make it."""
    from linkforge_compile.view.files import MissingFile
    from linkforge_compile.view.html import NoPageError, html_of
    from linkforge_compile.view.picture import WAIT, PictureError, draw_picture, find_browser

    try:
        if form == "html":
            return html_of(scene, files)
        browser = find_browser()
        html = html_of({**scene, "view": {**scene["view"], "panels": False}}, files, last=WAIT)
        with progress_after(f"drawing with {Path(browser[0]).name}", arguments):
            picture = draw_picture(html, arguments.size, browser)
        shapes = [(files.users.get(digest), reason) for digest, reason in picture.not_shown.items()]
        report_not_shown([MissingFile(use.resource, reason, use) for use, reason in shapes if use], arguments)
        return picture.png
    except (NoPageError, PictureError) as error:
        raise UsageError(str(error)) from error


def _camera(text: str) -> SceneCamera:
    try:
        numbers = [float(number) for number in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in {2, 3} or not all(map(math.isfinite, numbers)):
        raise argparse.ArgumentTypeError(f"takes AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres, found '{text}'")
    azimuth, elevation, *distance = numbers
    if not -90 <= elevation <= 90:
        raise argparse.ArgumentTypeError(f"takes an elevation from -90 to 90 degrees, found '{text}'")
    if distance and distance[0] <= 0:
        raise argparse.ArgumentTypeError(f"takes a distance above 0 m, found '{text}'")
    camera: SceneCamera = {"azimuth": azimuth, "elevation": elevation}
    return {**camera, "distance": distance[0]} if distance else camera


def _size(text: str) -> Size:
    from linkforge_compile.view.picture import Size

    width, _, height = text.lower().partition("x")
    sides = [int(side) for side in (width, height) if side.isascii() and side.isdigit()]
    if len(sides) != 2 or not all(0 < side <= MAX_SIDE for side in sides):
        raise argparse.ArgumentTypeError(f"takes WIDTHxHEIGHT, each up to {MAX_SIDE} pixels, found '{text}'")
    return Size(*sides)


def _layers(text: str) -> list[str]:
    from linkforge_compile.diagnostics.suggest import did_you_mean

    layers = [layer.strip() for layer in text.split(",")]
    if unknown := next((layer for layer in layers if layer not in LAYERS), None):
        hint = did_you_mean(unknown, LAYERS) or f"; there are {', '.join(LAYERS)}"
        raise argparse.ArgumentTypeError(f"there is no layer '{unknown}'{hint}")
    return layers
