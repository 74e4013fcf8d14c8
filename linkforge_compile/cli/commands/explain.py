"""`linkforge explain`: where a value of the finished robot was written, and through which files it came."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.one_spec import compile_spec, one_spec
from linkforge_compile.cli.options import add_spec_options, split_assignments, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.source import Span
    from linkforge_compile.writers import Explanation

_EXAMPLES = """\
PATH is that of the value in the finished robot: the language's keys in their long form, and final names.

examples:
  linkforge explain cell.robot.yaml joints/left_elbow/limits/effort
  linkforge explain cell.robot.yaml links/left_forearm/visual/0/origin/xyz
  linkforge explain cell.robot.yaml semantic/group_states/arm/home
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge explain [options] SPEC PATH [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="SPEC PATH", nargs="+", help="the spec, and the path of a value in its robot")
    add_spec_options(parser)


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) < 2:
        raise UsageError("takes a spec and a path, such as joints/elbow/limits/effort")
    *specs, path = words
    compilation = compile_spec(one_spec(specs), assignments, arguments)
    tell(compilation.diagnostics)
    if compilation.robot is None:
        return FAULTY_SPEC
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.writers import UnknownPathError, explain

    try:
        explanation = explain(compilation.robot, path)
    except UnknownPathError as error:
        from linkforge_compile.diagnostics.suggest import did_you_mean

        raise UsageError(f"{error}{did_you_mean(error.name, error.names)}") from None
    write_to_stdout("".join(f"{line}\n" for line in _lines(explanation)))
    return OK


def _lines(explanation: Explanation) -> Iterator[str]:
    yield explanation.text
    if explanation.place is None:
        yield "written in no file"
        return
    if explanation.is_written:
        yield from _told("written", explanation.place)
        if explanation.expression:
            yield f"computed: {explanation.expression}"
    else:
        yield "nothing is written for it"
        yield from _told("what it belongs to is written", explanation.place)
    for replaced in explanation.replaced:
        yield from _told("instead of what is written", replaced)
    for included in explanation.place.file.includes:
        yield from _told("included", included)
    for use in explanation.trail:
        yield from _told("used", use)


def _told(what: str, place: Span) -> Iterator[str]:
    from linkforge_compile.diagnostics.render import snippet

    yield f"{what} at {place}"
    yield from snippet(place)
