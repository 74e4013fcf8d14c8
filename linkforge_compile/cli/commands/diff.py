"""`linkforge diff`: what differs between two robots, for whoever reviews the change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.differences import Comparison, Side
from linkforge_compile.cli.exits import OK, UsageError
from linkforge_compile.cli.one_spec import STDIN, compile_spec, is_xml, once_only, require_file
from linkforge_compile.cli.options import add_spec_options, name_set_by, packages_of, split_assignments
from linkforge_compile.cli.telling import add_telling_options, tell

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic

DIFFERENT, NO_ROBOT = 1, 2
"""Exit codes, as diff(1) has them: 0 is for the same, and 2 for trouble."""

_SIDES = ("before", "after")

_EXAMPLES = """\
A and B are specs, URDFs of any name or xacros. `-p` goes to each of them that has the parameter and `--variant` to
specs; `--before` and `--after` go to A or B alone, and come before what `-p` and a variant say. A spec is laid beside a
URDF as the URDF that it compiles to. The semantic part of a URDF is its SRDF, which `--before-srdf` and `--after-srdf`
name; without it that part is left out, which is said. Only their errors are told; `linkforge check` tells the rest.
Exit codes: 0 for the same robot, 1 for another one, 2 for wrong usage and for what is no robot.

examples:
  linkforge diff old.robot.yaml new.robot.yaml
  linkforge diff arm.urdf arm.robot.yaml --before-srdf arm.srdf
  linkforge diff arm.urdf.xacro arm.robot.yaml --before reach:=0.7 --tolerance 1e-9
  linkforge diff arm.robot.yaml arm.robot.yaml --before reach=0.7m --after reach=0.9m
  linkforge diff arm.robot.yaml arm.robot.yaml --after-variant sim
  linkforge diff old.urdf new.urdf --json
  xacro arm.urdf.xacro | linkforge diff - arm.robot.yaml
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge diff [options] A B [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words", metavar="A B", nargs="+", help="the robot before and the one after; - for standard input"
    )
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
        parser.add_argument(f"--{side}-variant", metavar="NAME", help=f"the variant of the robot {side} alone")
        parser.add_argument(f"--{side}-srdf", metavar="SRDF", help=f"the SRDF of the robot {side}, which is a URDF")
    add_spec_options(parser)
    add_telling_options(parser)


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) != 2:
        raise UsageError(f"takes two robots, found {len(words)}")
    if words == ["-", "-"]:
        raise UsageError("only one of the robots can come from standard input")
    sides = [_side(side, word, arguments) for side, word in zip(_SIDES, words, strict=True)]
    common = [*arguments.parameters, *assignments]
    _refuse_what_none_takes(sides, common, arguments.variant)
    taken = _shared_out(common, sides, arguments)
    before, after = (
        _robot(side, _for_side(name, side, pairs, arguments))
        for name, side, pairs in zip(_SIDES, sides, taken, strict=True)
    )
    if before is None or after is None:
        return NO_ROBOT
    (before, after), not_read_back = _beside_each_other(sides, (before, after), arguments)
    from linkforge_compile.cli.differences import json_of, lines_of
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.compare import TOLERANCE, compare, removed_public_names

    tolerance = TOLERANCE if arguments.tolerance is None else arguments.tolerance
    semantic = not any(map(_has_no_semantic, sides))
    differences = compare(before, after, tolerance=tolerance, semantic=semantic)
    gone = removed_public_names(before, after, semantic=semantic)
    comparison = Comparison(sides[0], sides[1], tolerance, semantic, not_read_back, differences, gone)
    if arguments.json:
        write_to_stdout(json_of(comparison))
    else:
        lines = (*lines_of(comparison), *_as_written(comparison), *_left_out(sides, (before, after)))
        write_to_stdout("".join(f"{line}\n" for line in lines))
    return DIFFERENT if differences else OK


def _side(name: str, word: str, arguments: argparse.Namespace) -> Side:
    """Return the robot of one side and what is set for it alone; UsageError for what it cannot have."""
    values = vars(arguments)
    parameters: list[str] = values[name]
    variant: str | None = values[f"{name}_variant"]
    srdf: str | None = values[f"{name}_srdf"]
    require_file(f"--{name}-srdf", srdf)
    if word.lower().endswith((".srdf", ".srdf.xacro")):
        raise UsageError(f"'{word}' is an SRDF; give it with its robot: --{name}-srdf {word}")
    text = once_only(word)
    settings = {name_set_by(pair): pair.partition("=")[2] for pair in parameters}
    side = Side(word, settings, variant, srdf, text, is_urdf=is_xml(word, text))
    if side.is_urdf and (variant or (parameters and not _takes_parameters(side))):
        raise UsageError(f"'{word}' has no {'variants' if variant else 'parameters'}")
    if srdf and not side.is_urdf:
        raise UsageError(f"--{name}-srdf goes with a URDF; '{word}' has 'semantic' for it")
    return side


def _refuse_what_none_takes(sides: Sequence[Side], common: Sequence[str], variant: str | None) -> None:
    if common and not any(map(_takes_parameters, sides)):
        raise UsageError(f"nothing takes '{common[0]}': a URDF has no parameters")
    if variant and all(side.is_urdf for side in sides):
        raise UsageError(f"nothing takes '--variant {variant}': a URDF has no variants")


def _takes_parameters(side: Side) -> bool:
    return not side.is_urdf or any(_is_xacro(file) for file in (side.word, side.srdf) if file)


def _shared_out(common: Sequence[str], sides: Sequence[Side], arguments: argparse.Namespace) -> list[list[str]]:
    """Return what each side takes of what is set for both: what it has, and what none has, to be told there."""
    is_unknown = any(side.text is not None and not side.is_urdf for side in sides)  # which can be read once only
    if not common or is_unknown or len({(side.word, side.srdf) for side in sides}) == 1:
        return [list(common) for _ in sides]
    names = [_parameters_of(side, arguments) for side in sides]
    known = frozenset().union(*names)
    return [[pair for pair in common if (name := name_set_by(pair)) in own or name not in known] for own in names]


def _parameters_of(side: Side, arguments: argparse.Namespace) -> frozenset[str]:
    """Return the names of what a side takes."""
    from linkforge_compile.pipeline import parameters_of

    files = [side.word] if not side.is_urdf or _is_xacro(side.word) else []
    files += [side.srdf] if side.srdf and _is_xacro(side.srdf) else []
    packages = packages_of(arguments)
    listings = (parameters_of(file, packages=packages, allow_outside=arguments.allow_outside)[0] for file in files)
    return frozenset(one.name for listing in listings if listing for one in listing.parameters)


def _for_side(name: str, side: Side, common: Iterable[str], arguments: argparse.Namespace) -> argparse.Namespace:
    """Return the arguments as they are for the robot of one side: what is set for it alone comes before the rest."""
    from argparse import Namespace

    ours = Namespace(**vars(arguments))
    ours.parameters = [*(pair for pair in common if name_set_by(pair) not in side.parameters), *vars(arguments)[name]]
    ours.variant = side.variant or arguments.variant
    return ours


def _beside_each_other(
    sides: Sequence[Side], robots: Sequence[Robot], arguments: argparse.Namespace
) -> tuple[Sequence[Robot], str | None]:
    """Return the robots, a spec beside a URDF as what it compiles to: it has words for what a URDF says in Gazebo's.

    With them comes why that does not read back, where the spec is left as written.
    """
    urdfs = [side.is_urdf for side in sides]
    if all(urdfs) or not any(urdfs):
        return robots, None
    from linkforge_compile.importing import as_read_back

    spec = urdfs.index(False)
    robot, faults = as_read_back(robots[spec], gazebo=arguments.gazebo)
    if robot is None:
        return robots, faults[0].message
    return ((robot, robots[1]) if spec == 0 else (robots[0], robot)), None


def _has_no_semantic(side: Side) -> bool:
    return side.is_urdf and side.srdf is None


def _as_written(comparison: Comparison) -> Iterator[str]:
    """Yield the line that says that a spec beside a URDF is not compared as the URDF that it compiles to."""
    if comparison.not_read_back is not None:
        spec = next(side.word for side in (comparison.before, comparison.after) if not side.is_urdf)
        yield f"{spec} is compared as written, since its URDF does not read back: {comparison.not_read_back}"


def _left_out(sides: Sequence[Side], robots: Sequence[Robot]) -> Iterator[str]:
    """Yield the line that says that the semantic part is not compared, where one of the robots has one."""
    without = [side.word for side in sides if _has_no_semantic(side)]
    if without and any(robot.says_semantic for robot in robots):
        yield f"the semantic part is left out: {' and '.join(without)} has none"


def _tolerance(text: str) -> float:
    import argparse

    try:
        tolerance = float(text)
    except ValueError:
        tolerance = -1
    if not 0 <= tolerance < 1:
        raise argparse.ArgumentTypeError(f"takes a number from 0 to below 1, found '{text}'")
    return tolerance


def _is_xacro(word: str) -> bool:
    return Path(word).suffix.lower() == ".xacro"


def _robot(side: Side, arguments: argparse.Namespace) -> Robot | None:
    if side.is_urdf:
        from linkforge_compile.importing import import_urdf
        from linkforge_compile.pipeline import compile_text

        name = STDIN if side.word == "-" else side.word
        imported = import_urdf(
            name,
            srdf=side.srdf,
            arguments=arguments.parameters if _takes_parameters(side) else (),
            packages=packages_of(arguments),
            allow_outside=arguments.allow_outside,
            text=side.text,
        )
        if tell((*_errors(imported.diagnostics), *imported.losses), arguments) or imported.text is None:
            return None
        compilation = compile_text(imported.text, name=name, folder=Path(side.word).parent)
    else:
        compilation = compile_spec(side.word, [], arguments, text=side.text)
    return None if tell(_errors(compilation.diagnostics), arguments) else compilation.robot


def _errors(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    from linkforge_compile.diagnostics import Severity

    return [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
