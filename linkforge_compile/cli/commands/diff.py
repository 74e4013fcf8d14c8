"""`linkforge diff`: what differs between two robots, for whoever reviews the change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK, UsageError
from linkforge_compile.cli.options import Once, add_spec_options, packages_of, split_assignments
from linkforge_compile.cli.telling import add_telling_options, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.compare import Difference, Vanished
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic

DIFFERENT, NO_ROBOT = 1, 2
"""Exit codes, as diff(1) has them: 0 is for the same, and 2 for trouble."""

_SIDES = ("before", "after")

_EXAMPLES = """\
A and B are specs or URDFs (.urdf, .xml, .xacro); `-p`, `--variant` and `--package` go to every spec among them,
`--before` and `--after` to A or B alone. Beside a URDF the semantic part is left out, which is said. Only errors of
theirs are told; `linkforge check` tells the rest.
Exit codes: 0 for the same robot, 1 for another one, 2 for wrong usage and for what is no robot.

examples:
  linkforge diff old.robot.yaml new.robot.yaml
  linkforge diff arm.urdf arm.robot.yaml --tolerance 1e-9
  linkforge diff arm.robot.yaml arm.robot.yaml --before reach=0.7m --after reach=0.9m
  linkforge diff arm.robot.yaml arm.robot.yaml --after-variant sim
  linkforge diff old.urdf new.urdf --json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge diff [options] A B [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="A B", nargs="+", help="the robot before and the one after; - for a spec")
    parser.add_argument("--json", action="store_true", help="as JSON, for tools")
    parser.add_argument(
        "--tolerance",
        type=_tolerance,
        default=None,
        metavar="T",
        help="what is taken for the same: poses within T m and T rad, other numbers within that share (1e-6)",
    )
    for side in _SIDES:
        parser.add_argument(
            f"--{side}",
            metavar="NAME=VALUE",
            action="append",
            default=[],
            help=f"set a parameter of the robot {side} alone",
        )
        parser.add_argument(
            f"--{side}-variant", metavar="NAME", action=Once, help=f"the variant of the robot {side} alone"
        )
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) != 2:
        raise UsageError(f"takes two robots, found {len(words)}")
    if words == ["-", "-"]:
        raise UsageError("only one of the robots can come from standard input")
    before, after = (
        _robot(word, assignments, _for_side(side, word, arguments)) for side, word in zip(_SIDES, words, strict=True)
    )
    if before is None or after is None:
        return NO_ROBOT
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.compare import TOLERANCE, compare, vanished

    tolerance = TOLERANCE if arguments.tolerance is None else arguments.tolerance
    semantic = not any(map(_is_urdf, words))
    differences = compare(before, after, tolerance=tolerance, semantic=semantic)
    gone = vanished(before, after, semantic=semantic)
    if arguments.json:
        write_to_stdout(_json_text(words, tolerance, semantic, differences, gone))
    else:
        lines = (*_lines(words, differences, gone), *_left_out(words, (before, after)))
        write_to_stdout("".join(f"{line}\n" for line in lines))
    return DIFFERENT if differences else OK


def _for_side(side: str, word: str, arguments: argparse.Namespace) -> argparse.Namespace:
    """Return the arguments as they are for the robot of one side."""
    from argparse import Namespace

    parameters: list[str] = getattr(arguments, side)
    variant: str | None = getattr(arguments, f"{side}_variant")
    if _is_urdf(word) and (variant or (parameters and not _is_xacro(word))):
        raise UsageError(f"'{word}' has no {'variants' if variant else 'parameters'}")
    ours = Namespace(**vars(arguments))
    ours.parameters = [*arguments.parameters, *parameters]
    ours.variant = variant or arguments.variant
    return ours


def _left_out(words: Sequence[str], robots: Sequence[Robot]) -> Iterator[str]:
    """Yield the line that says that the semantic part is not compared, where one of the robots has one."""
    if any(robot.says_semantic for robot in robots) and any(map(_is_urdf, words)):
        yield f"the semantic part is left out: {' and '.join(filter(_is_urdf, words))} has none"


def _tolerance(text: str) -> float:
    import argparse

    try:
        tolerance = float(text)
    except ValueError:
        tolerance = -1
    if not 0 <= tolerance < 1:
        raise argparse.ArgumentTypeError(f"takes a number from 0 to below 1, found '{text}'")
    return tolerance


def _is_urdf(word: str) -> bool:
    return Path(word).suffix.lower() in {".urdf", ".xml", ".xacro"}


def _is_xacro(word: str) -> bool:
    return Path(word).suffix.lower() == ".xacro"


def _robot(word: str, assignments: list[str], arguments: argparse.Namespace) -> Robot | None:
    if _is_urdf(word):
        from linkforge_compile.importing import import_urdf
        from linkforge_compile.pipeline import compile_text

        imported = import_urdf(
            word,
            arguments=[*arguments.parameters, *assignments] if _is_xacro(word) else (),
            packages=packages_of(arguments),
            allow_outside=arguments.allow_outside,
        )
        if tell((*_errors(imported.diagnostics), *imported.losses), arguments) or imported.text is None:
            return None
        compilation = compile_text(imported.text, name=word, folder=Path(word).parent)
    else:
        from linkforge_compile.cli.one_spec import compile_spec

        compilation = compile_spec(word, assignments, arguments)
    return None if tell(_errors(compilation.diagnostics), arguments) else compilation.robot


def _errors(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    from linkforge_compile.diagnostics import Severity

    return [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]


def _lines(words: Sequence[str], differences: Sequence[Difference], gone: Sequence[Vanished]) -> Iterator[str]:
    if not differences:
        yield f"{words[0]} and {words[1]} are the same robot"
        return
    yield f"{words[0]} → {words[1]}: {_count(differences)}"
    if gone:
        yield from ("", "breaking: names that are gone, on which others may rely")
        width = max(len(name.kind) for name in gone)
        yield from (f"  {name.kind:{width}}  {name.name}" + (f", now {name.now}" if name.now else "") for name in gone)
    for section, members in groupby(differences, key=lambda difference: difference.path[0]):
        yield from ("", section)
        for name, group in groupby(members, key=lambda difference: difference.path[1 : _DEPTH.get(section, 2)]):
            yield from _part_lines("/".join(name), list(group))


_DEPTH = {"semantic": 3}
"""How many steps of a path lead to what stands in a line of its own."""

_SIGNS = {"added": "+", "removed": "-", "renamed": ">", "moved": ">", "changed": "~"}


def _part_lines(name: str, differences: Sequence[Difference]) -> Iterator[str]:
    """Yield the lines about one part: what became of it as a whole, then what of it differs."""
    steps = name.count("/") + 2 if name else 1
    whole = [difference for difference in differences if len(difference.path) <= steps]
    for difference in whole:
        yield f"  {_SIGNS[difference.kind]} {name}: {difference.text}" if name else f"  {difference.text}"
    inner = [difference for difference in differences if len(difference.path) > steps]
    if inner and not whole:
        yield f"  ~ {name}"
    for difference in inner:
        sign = "" if difference.kind == "changed" else f"{_SIGNS[difference.kind]} "
        yield f"      {sign}{'/'.join(difference.path[steps:])}: {difference.text}"


def _count(differences: Sequence[Difference]) -> str:
    kinds = [difference.kind for difference in differences]
    return ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds), key=list(_SIGNS).index))


def _json_text(
    words: Sequence[str], tolerance: float, semantic: bool, differences: Sequence[Difference], gone: Sequence[Vanished]
) -> str:
    import json

    whole = {
        "version": 1,
        "before": words[0],
        "after": words[1],
        "tolerance": tolerance,
        "semantic_compared": semantic,
        "same": not differences,
        "breaking": [name._asdict() for name in gone],
        "differences": [
            {
                "kind": difference.kind,
                "path": "/".join(difference.path),
                "before": difference.before,
                "after": difference.after,
                "text": difference.text,
            }
            for difference in differences
        ],
    }
    return json.dumps(whole, ensure_ascii=False, indent=2) + "\n"
