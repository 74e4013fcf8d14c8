"""`linkforge explain`: where a value of the finished robot comes from, and what a diagnostic's code means."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.one_spec import compile_spec, one_spec
from linkforge_compile.cli.options import add_spec_options, split_assignments
from linkforge_compile.cli.places import told
from linkforge_compile.cli.telling import add_telling_options, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.writers import Explanation, NameStory

_EXAMPLES = """\
PATH is that of the value in the finished robot: the language's keys in their long form, and final names.

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
        "words", metavar="SPEC PATH", nargs="*", help="the spec, and the path of a value in its robot; or the one CODE"
    )
    parser.add_argument("--codes", action="store_true", help="list the code of every diagnostic")
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.manual import is_code

    if arguments.codes or (len(arguments.words) == 1 and is_code(arguments.words[0])):
        return _print_manual(arguments)
    return _explain_value(arguments)


def _print_manual(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.colour import is_coloured
    from linkforge_compile.cli.manual import UnknownCodeError, page, register_table
    from linkforge_compile.cli.output import write_to_stdout

    words: list[str] = arguments.words
    if arguments.codes and words:
        raise UsageError(f"--codes lists all codes and takes no words, found '{words[0]}'")
    is_styled = is_coloured(sys.stdout, arguments.color)
    try:
        write_to_stdout(register_table() if arguments.codes else page(words[0], styled=is_styled))
    except UnknownCodeError as error:
        raise UsageError(f"{error} (--codes lists all)") from None
    return OK


def _explain_value(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) < 2:
        raise UsageError("takes a spec and a path, such as joints/elbow/limits/effort, or a code, such as LF4102")
    *specs, path = words
    compilation = compile_spec(one_spec(specs), assignments, arguments)
    if tell(compilation.diagnostics, arguments) or compilation.robot is None:
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
        yield from told("written", explanation.place)
        if explanation.expression:
            yield f"computed: {explanation.expression}"
            for name in explanation.names:
                yield from _name(name, "  ")
        if explanation.origin:
            yield from told("the value itself is written", explanation.origin)
    else:
        yield "nothing is written for it"
        yield from told("what it belongs to is written", explanation.place)
    for replaced in explanation.replaced:
        yield from told("instead of what is written", replaced)
    for included in explanation.place.file.includes:
        yield from told("included", included)
    for use in explanation.trail:
        yield from told("used", use)


def _name(name: NameStory, indent: str) -> Iterator[str]:
    yield f"{indent}{name.name} is {name.value}, {name.setting}"
    yield from (f"{indent}  instead of {beaten}" for beaten in name.instead_of)
    for inner in name.names:
        yield from _name(inner, f"{indent}  ")
