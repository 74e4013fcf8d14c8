"""`linkforge diff`: what differs between two robots, as lines for people or as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli import OK, UsageError
from linkforge_compile.cli.diff_page import require_html, write_page
from linkforge_compile.cli.diff_sides import SIDES, Side, as_urdfs, in_common_folders, load, parse_side, share_out
from linkforge_compile.cli.diff_text import difference_lines
from linkforge_compile.cli.options import add_format_options, add_spec_options, split_assignments
from linkforge_compile.cli.reports import add_report_options, report
from linkforge_compile.formats import URDF

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.cli.git_tree import GitTree
    from linkforge_compile.compare import Difference, RemovedName

DIFFERENT, NO_ROBOT = 1, 2
"""The exit codes of diff(1): 0 for no difference, 2 for trouble."""

_EXAMPLES = """\
A and B are specs, URDFs of any name or xacros. `-p` sets a parameter of each robot that has it, and `--variant` that of
specs; `--before` and `--after` set a parameter of only A or B, and have precedence. To compare a spec with a URDF, it
is compiled to a URDF first. The semantic part of a URDF is its SRDF, given by `--before-srdf` and `--after-srdf`;
without an SRDF, that part is not compared, and the output says so. Only errors are reported; use `linkforge check` for
the rest.
With `--git`, A and all files that it includes are read from a revision of its repository. You can omit B if it is the
same file; the same applies to `--before-package` and `--after-package`.
Exit codes: 0 if the robots are the same, 1 if they differ, 2 for wrong usage or an input that is not a robot.

examples:
  linkforge diff old.robot.yaml new.robot.yaml
  linkforge diff arm.urdf arm.robot.yaml --before-srdf arm.srdf
  linkforge diff arm.urdf.xacro arm.robot.yaml --before reach:=0.7 --tolerance 1e-9
  linkforge diff arm.robot.yaml arm.robot.yaml --before reach=0.7m --after reach=0.9m
  linkforge diff arm.robot.yaml arm.robot.yaml --after-variant sim
  linkforge diff arm.robot.yaml --git HEAD~1            as it was in a git revision, compared with now
  linkforge diff arm.robot.yaml --before-package ur_description=../ur_description_2.1
  linkforge diff old.urdf new.urdf --json
  linkforge diff arm.robot.yaml --git main --html -o diff.html      both robots over each other, changes in color
  xacro arm.urdf.xacro | linkforge diff - arm.robot.yaml
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge diff [options] A [B] [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words", metavar="A B", nargs="+", help="the robot before and the one after; - for standard input"
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="as JSON, for tools")
    form.add_argument(
        "--html", action="store_true", help="as a page that shows both robots over each other, opened in the browser"
    )
    parser.add_argument("-o", "--output", metavar="FILE.html", help="write the page of --html to this file")
    parser.add_argument(
        "--tolerance",
        type=_tolerance,
        default=None,
        metavar="T",
        help="ignore differences of poses up to T metres and radians, of other numbers up to T times them (1e-6)",
    )
    parser.add_argument("--git", metavar="REV", help="read A from this git revision, such as HEAD~1 or a branch")
    for side in SIDES:
        parser.add_argument(
            f"--{side}",
            metavar="NAME=VALUE",
            action="append",
            default=[],
            help=f"set a parameter only for the robot {side}",
        )
        parser.add_argument(
            f"--{side}-package",
            metavar="NAME=PATH",
            action="append",
            default=[],
            help=f"the folder of package://NAME/ only for the robot {side}",
        )
        parser.add_argument(f"--{side}-variant", metavar="NAME", help=f"the variant only of the robot {side}")
        parser.add_argument(f"--{side}-srdf", metavar="SRDF", help=f"the SRDF of the robot {side}, which is a URDF")
    add_spec_options(parser)
    add_format_options(parser, [URDF])
    add_report_options(parser)


def _tolerance(text: str) -> float:
    import argparse

    try:
        tolerance = float(text)
    except ValueError:
        tolerance = -1
    if not 0 <= tolerance < 1:
        raise argparse.ArgumentTypeError(f"takes a number from 0 to below 1, found '{text}'")
    return tolerance


class _Comparison(NamedTuple):
    """What differs between two robots.

    `is_semantic_missed` is True if one has a semantic part that the other, a URDF without SRDF, cannot have.
    `not_read_back` is the reason why a spec was compared as it is written, if it was.
    """

    sides: Sequence[Side]
    tolerance: float
    is_semantic_missed: bool
    not_read_back: str | None
    differences: Sequence[Difference]
    removed: Sequence[RemovedName]


def run(arguments: argparse.Namespace) -> int:
    require_html(arguments)
    words, assignments = split_assignments(arguments.words)
    if arguments.git is not None and words[:1] == ["-"]:
        raise UsageError("--git takes a file, not standard input")
    if len(words) == 1 and (arguments.git is not None or arguments.before_package or arguments.after_package):
        words *= 2
    if len(words) != 2:
        raise UsageError(f"takes two robots, found {len(words)}")
    if words == ["-", "-"]:
        raise UsageError("only one of the robots can come from standard input")
    if arguments.git is None:
        return _diff(words, assignments, None, arguments)
    from linkforge_compile.cli.git_tree import copied_tree

    with copied_tree(arguments.git, words[0]) as tree:
        return _diff(words, assignments, tree, arguments)


def _diff(words: list[str], assignments: list[str], tree: GitTree | None, arguments: argparse.Namespace) -> int:
    """Compare two robots, the first one in a revision of git, and print the result; return the exit code."""
    sides = [
        parse_side(name, word, arguments, revision)
        for name, word, revision in zip(SIDES, words, (tree, None), strict=True)
    ]
    common = share_out([*arguments.parameters, *assignments], sides, arguments)
    (before, faults), (after, more) = (load(side, pairs, arguments) for side, pairs in zip(sides, common, strict=True))
    if report([*faults, *more], arguments) or before is None or after is None:
        return NO_ROBOT
    (before, after), not_read_back = as_urdfs(sides, (before, after), arguments)
    before, after = in_common_folders(sides, (before, after), arguments)
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.compare import TOLERANCE, compare, removed_public_names

    tolerance = TOLERANCE if arguments.tolerance is None else arguments.tolerance
    semantic = all(side.has_semantic for side in sides)
    comparison = _Comparison(
        sides,
        tolerance,
        not semantic and (before.has_semantic or after.has_semantic),
        not_read_back,
        compare(before, after, tolerance=tolerance, semantic=semantic),
        removed_public_names(before, after, semantic=semantic),
    )
    if arguments.html:
        labels = (sides[0].label, sides[1].label)
        write_page((before, after), labels, comparison.differences, comparison.removed, arguments)
    else:
        text = _json_text(comparison) if arguments.json else "".join(f"{line}\n" for line in _lines(comparison))
        write_to_stdout(text)
    return DIFFERENT if comparison.differences else OK


def _lines(comparison: _Comparison) -> Iterator[str]:
    """Yield what differs, and what was not compared."""
    before, after = (side.label for side in comparison.sides)
    if comparison.differences:
        yield from difference_lines((before, after), comparison.differences, comparison.removed)
    else:
        yield f"{before} and {after} are the same robot"
    if comparison.not_read_back is not None:
        spec = next(side.word for side in comparison.sides if not side.is_urdf)
        yield f"{spec} is compared as written, since its URDF does not read back: {comparison.not_read_back}"
    if comparison.is_semantic_missed:
        without = [side.word for side in comparison.sides if not side.has_semantic]
        yield f"the semantic part is omitted: {' and '.join(without)} has none"


def _json_text(comparison: _Comparison) -> str:
    """Return the comparison as docs/diff.schema.json describes it."""
    from linkforge_compile.cli.output import json_text

    document: dict[str, object] = {"version": 1}
    for name, side in zip(SIDES, comparison.sides, strict=True):
        settings: dict[str, object] = {"parameters": side.parameters, "variant": side.variant, "srdf": side.srdf}
        settings |= {"packages": side.packages, "git": side.tree.name if side.tree else None}
        document |= {name: side.word, f"{name}_settings": settings}
    document |= {
        "tolerance": comparison.tolerance,
        "semantic_compared": all(side.has_semantic for side in comparison.sides),
        "not_read_back": comparison.not_read_back,
        "same": not comparison.differences,
        "breaking": [name._asdict() for name in comparison.removed],
        "differences": [{**vars(one), "path": "/".join(one.path)} for one in comparison.differences],
    }
    return json_text(document)
