"""`linkforge explain`: explains where a value of the robot comes from, or what a diagnostic means."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import add_spec_options, compile_spec, require_one_spec, split_assignments
from linkforge_compile.cli.reports import add_report_options, place_lines, report

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.export_spec import Explanation, UnknownPathError
    from linkforge_compile.formats.ros2_controllers.complete import Completed, Origin

_EXAMPLES = """\
PATH is the path of the value in the finished robot, with keys in their long form and final names.

examples:
  linkforge explain cell.robot.yaml joints/left_elbow/limits/effort
  linkforge explain cell.robot.yaml links/left_forearm/visual/0/origin/xyz
  linkforge explain cell.robot.yaml semantic/group_states/arm/home
  linkforge explain LF4102                  what a diagnostic means, with a wrong and a right spec
  linkforge explain --codes                 all of them
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = (
        "linkforge explain [options] SPEC PATH [NAME:=VALUE ...]\n"
        "       linkforge explain CODE\n"
        "       linkforge explain --codes"
    )
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words", metavar="SPEC PATH", nargs="*", help="the spec and the path of a value in its robot; or a CODE"
    )
    parser.add_argument("--codes", action="store_true", help="list the code of every diagnostic")
    add_spec_options(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.reports import is_code

    if arguments.codes or (len(arguments.words) == 1 and is_code(arguments.words[0])):
        return _print_manual(arguments)
    return _explain_value(arguments)


def _print_manual(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.cli.reports import is_colored, manual_page, register_table

    words: list[str] = arguments.words
    if arguments.codes and words:
        raise UsageError(f"--codes lists all codes and takes no words, found '{words[0]}'")
    is_styled = is_colored(sys.stdout, arguments.color)
    write_to_stdout(register_table() if arguments.codes else manual_page(words[0], styled=is_styled))
    return OK


def _explain_value(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) < 2:
        raise UsageError("takes a spec and a path, such as joints/elbow/limits/effort, or a code, such as LF4102")
    *specs, path = words
    compilation = compile_spec(require_one_spec(specs), assignments, arguments)
    # Warnings about the rest of the spec are not of interest here.
    arguments.quiet = True
    if report(compilation.diagnostics, arguments) or compilation.robot is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.core.models.controller import MANAGER
    from linkforge_compile.export_spec import UnknownPathError, explain
    from linkforge_compile.export_spec.explanation_lines import explanation_lines

    robot = compilation.robot
    if controllers := _explained_controllers(robot, path):
        manager = [one for one in robot.controllers if one.name == MANAGER]
        robot.controllers = [*(one.controller for one in controllers), *manager]
    try:
        explanation = explain(robot, path)
    except UnknownPathError as error:
        raise UsageError(f"{error}{_hint(error, robot, path)}") from None
    origin = _origin_at(controllers, path)
    lines = explanation_lines(explanation, place_lines) if origin is None else _lines(explanation, origin)
    write_to_stdout("".join(f"{line}\n" for line in lines))
    return OK


def _explained_controllers(robot: Robot, path: str) -> tuple[Completed, ...]:
    """Return the controllers of a robot's outputs if a path leads to a field of one, else none."""
    section, _, field = (*path.strip("/").split("/"), "", "")[:3]
    if section != "controllers" or field == "parameters":
        return ()
    from linkforge_compile.formats.ros2_controllers.complete import explained_controllers

    return explained_controllers(robot)


def _origin_at(controllers: Sequence[Completed], path: str) -> Origin | None:
    """Return where the field of a controller comes from that a path leads to; None for one at its own place."""
    _, name, field = (*path.strip("/").split("/"), "", "")[:3]
    origins = next((one.origins for one in controllers if one.controller.name == name), None)
    return origins.get(field, origins.get("")) if origins else None


_ONLY_IN_SPECS = {
    "parameters": "`linkforge params` lists those of a spec",
    "variables": "the value that uses it shows where it comes from",
    "modules": "what a module brings is among the links and joints, with its prefix",
    "mount": "the joint is among the `joints`",
    "defaults": "the entry that uses it shows where it comes from",
}
"""Sections of a spec that the finished robot does not have, with a hint where to look instead."""


def _hint(error: UnknownPathError, robot: Robot, path: str) -> str:
    from linkforge_compile.diagnostics.suggest import did_you_mean, nearest

    if not error.owner and error.name in _ONLY_IN_SPECS:
        return f", which is finished; {_ONLY_IN_SPECS[error.name]}"
    if not error.owner and error.name == "frames":
        return f", where a frame is a link and a fixed joint{_frame_hint(robot, path.strip('/').partition('/')[2])}"
    if hint := did_you_mean(error.name, error.names):
        return hint
    closest = nearest(error.name, error.paths)
    return "" if closest is None else f"; did you mean '{error.paths[closest]}'?"


def _frame_hint(robot: Robot, path: str) -> str:
    """Return a hint to the joint of a frame, which has its pose and other values."""
    found = [joint for joint in robot.joints if f"{path}/".startswith(f"{joint.child}/")]
    if not found:
        return ""
    joint = max(found, key=lambda each: len(each.child))
    return f"; look at 'joints/{joint.name}{path[len(joint.child) :]}'"


def _lines(explanation: Explanation, origin: Origin) -> Iterator[str]:
    yield explanation.text
    if origin.why:
        yield f"not written itself: {origin.why}"
    if origin.source and (origin.subject or not origin.why):
        written = f"{origin.subject} is written" if origin.why else "written"
        yield from place_lines(written, origin.source.at(*origin.path))
