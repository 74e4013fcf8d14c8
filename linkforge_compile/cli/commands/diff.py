"""`linkforge diff`: what differs between two robots, as lines for people or as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli import OK, UsageError
from linkforge_compile.cli.options import (
    STDIN,
    add_spec_options,
    compile_spec,
    is_xml,
    name_set_by,
    packages_of,
    read_unseekable,
    require_file,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, errors_of, report
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.compare import Difference, RemovedName
    from linkforge_compile.core import Robot

DIFFERENT, NO_ROBOT = 1, 2
"""The exit codes of diff(1): 0 for no difference, 2 for trouble."""

_SIDES = ("before", "after")

_EXAMPLES = """\
A and B are specs, URDFs of any name or xacros. `-p` sets a parameter of each robot that has it, and `--variant` that of
specs; `--before` and `--after` set one of A or B alone, and have precedence. A spec is compared with a URDF as the URDF
that it compiles to. The semantic part of a URDF is its SRDF, given by `--before-srdf` and `--after-srdf`; without one
that part is not compared, and the output says so. Only errors are reported; use `linkforge check` for the rest.
Exit codes: 0 for the same robot, 1 for a different one, 2 for wrong usage and for an input that is no robot.

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
        help="equal are poses within T metres and T radians, and other numbers within the relative error T (1e-6)",
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


class _Side(NamedTuple):
    """One of the two robots as the command line gives it.

    `assignments` and the variant are those of this side alone. `text` is the content of standard input or a pipe, None
    for a file.
    """

    word: str
    assignments: Sequence[str]
    variant: str | None
    srdf: str | None
    text: str | None
    is_urdf: bool

    @property
    def parameters(self) -> dict[str, str]:
        return {name_set_by(pair): pair.partition("=")[2] for pair in self.assignments}

    @property
    def label(self) -> str:
        """The name in a heading, with the settings of this side: `arm.robot.yaml (reach=0.7m)`."""
        settings = [f"variant {self.variant}"] if self.variant else []
        settings += [f"{name}={value}" for name, value in self.parameters.items()]
        settings += [self.srdf] if self.srdf else []
        return on_one_line(f"{self.word} ({', '.join(settings)})" if settings else self.word)

    @property
    def parameter_files(self) -> list[str]:
        """The files that may declare parameters: a spec, or the xacros of a URDF and an SRDF."""
        files = [self.word] if not self.is_urdf or _is_xacro(self.word) else []
        return [*files, self.srdf] if self.srdf and _is_xacro(self.srdf) else files

    @property
    def has_semantic(self) -> bool:
        return not self.is_urdf or self.srdf is not None


class _Comparison(NamedTuple):
    """What differs between two robots.

    `is_semantic_missed` is True if one has a semantic part that the other, a URDF without SRDF, cannot have.
    `not_read_back` is the reason why a spec was compared as it is written, if it was.
    """

    sides: Sequence[_Side]
    tolerance: float
    is_semantic_missed: bool
    not_read_back: str | None
    differences: Sequence[Difference]
    removed: Sequence[RemovedName]


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    if len(words) != 2:
        raise UsageError(f"takes two robots, found {len(words)}")
    if words == ["-", "-"]:
        raise UsageError("only one of the robots can come from standard input")
    sides = [_parse_side(name, word, arguments) for name, word in zip(_SIDES, words, strict=True)]
    common = _share_out([*arguments.parameters, *assignments], sides, arguments)
    before, after = (_load(side, pairs, arguments) for side, pairs in zip(sides, common, strict=True))
    if before is None or after is None:
        return NO_ROBOT
    (before, after), not_read_back = _as_urdfs(sides, (before, after), arguments)
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
    write_to_stdout(_json_text(comparison) if arguments.json else "".join(f"{line}\n" for line in _lines(comparison)))
    return DIFFERENT if comparison.differences else OK


def _parse_side(name: str, word: str, arguments: argparse.Namespace) -> _Side:
    """Return the robot of one side with its own settings; UsageError for settings that it cannot have."""
    values = vars(arguments)
    assignments: list[str] = values[name]
    variant: str | None = values[f"{name}_variant"]
    srdf: str | None = values[f"{name}_srdf"]
    require_file(f"--{name}-srdf", srdf)
    if word.lower().endswith((".srdf", ".srdf.xacro")):
        raise UsageError(f"'{word}' is an SRDF; give it with its robot: --{name}-srdf {word}")
    text = read_unseekable(word)
    side = _Side(word, assignments, variant, srdf, text, is_xml(word, text))
    if side.is_urdf and (variant or (assignments and not side.parameter_files)):
        raise UsageError(f"'{word}' has no {'variants' if variant else 'parameters'}")
    if srdf and not side.is_urdf:
        raise UsageError(f"--{name}-srdf goes with a URDF; '{word}' has 'semantic' for it")
    return side


def _share_out(common: Sequence[str], sides: Sequence[_Side], arguments: argparse.Namespace) -> list[list[str]]:
    """Return for each side the common settings of parameters that it has, and those that neither side has.

    UsageError for a parameter or variant if both sides are URDFs.
    """
    if common and not any(side.parameter_files for side in sides):
        raise UsageError(f"nothing takes '{common[0]}': a URDF has no parameters")
    if arguments.variant and all(side.is_urdf for side in sides):
        raise UsageError(f"nothing takes '--variant {arguments.variant}': a URDF has no variants")
    is_unknown = any(side.text is not None and not side.is_urdf for side in sides)  # a spec that can be read only once
    if not common or is_unknown or len({(side.word, side.srdf) for side in sides}) == 1:
        return [list(common) for _ in sides]
    from linkforge_compile.pipeline import parameters_of

    packages, outside = packages_of(arguments), arguments.allow_outside
    names: list[set[str]] = []
    for side in sides:
        listings = (parameters_of(file, packages=packages, allow_outside=outside)[0] for file in side.parameter_files)
        names.append({one.name for listing in listings if listing for one in listing.parameters})
    known = set().union(*names)
    return [[pair for pair in common if (name := name_set_by(pair)) in own or name not in known] for own in names]


def _load(side: _Side, common: Iterable[str], arguments: argparse.Namespace) -> Robot | None:
    """Return the robot of a side; None if it has errors, which are reported."""
    from argparse import Namespace

    own = Namespace(**vars(arguments))
    own.parameters = [*(pair for pair in common if name_set_by(pair) not in side.parameters), *side.assignments]
    own.variant = side.variant or arguments.variant
    if side.is_urdf:
        from linkforge_compile.importing import import_urdf
        from linkforge_compile.pipeline import compile_text

        name = STDIN if side.word == "-" else side.word
        imported = import_urdf(
            name,
            srdf=side.srdf,
            arguments=own.parameters if side.parameter_files else (),
            packages=packages_of(arguments),
            allow_outside=arguments.allow_outside,
            text=side.text,
        )
        if report((*errors_of(imported.diagnostics), *imported.losses), arguments) or imported.text is None:
            return None
        compilation = compile_text(imported.text, name=name, folder=Path(side.word).parent)
    else:
        compilation = compile_spec(side.word, [], own, text=side.text)
    return None if report(errors_of(compilation.diagnostics), arguments) else compilation.robot


def _as_urdfs(
    sides: Sequence[_Side], robots: tuple[Robot, Robot], arguments: argparse.Namespace
) -> tuple[tuple[Robot, Robot], str | None]:
    """Return the robots; a spec that is compared with a URDF becomes the URDF that it compiles to.

    Also return why that URDF cannot be read back, in which case the spec stays as written; None if it can.
    """
    is_spec = [not side.is_urdf for side in sides]
    if all(is_spec) or not any(is_spec):
        return robots, None
    from linkforge_compile.importing import as_read_back

    robot, faults = as_read_back(robots[is_spec.index(True)], gazebo=arguments.gazebo)
    if robot is None:
        return robots, faults[0].message
    return ((robot, robots[1]) if is_spec[0] else (robots[0], robot)), None


def _is_xacro(word: str) -> bool:
    from linkforge_compile.expand import is_xacro

    return is_xacro(Path(word))


def _lines(comparison: _Comparison) -> Iterator[str]:
    """Yield the numbers of differences, the removed names, each part by section, and what was not compared."""
    before, after = (side.label for side in comparison.sides)
    if comparison.differences:
        kinds = Counter[str](difference.kind for difference in comparison.differences)
        yield f"{before} → {after}: {', '.join(f'{kinds[kind]} {kind}' for kind in _SIGNS if kind in kinds)}"
        yield from _removed_lines(comparison.removed)
        for section, members in groupby(comparison.differences, key=lambda difference: difference.path[0]):
            yield from ("", section)
            for part, group in groupby(members, key=lambda difference: difference.path[1 : _DEPTH.get(section, 2)]):
                yield from _part_lines(part, list(group))
    else:
        yield f"{before} and {after} are the same robot"
    if comparison.not_read_back is not None:
        spec = next(side.word for side in comparison.sides if not side.is_urdf)
        yield f"{spec} is compared as written, since its URDF does not read back: {comparison.not_read_back}"
    if comparison.is_semantic_missed:
        without = [side.word for side in comparison.sides if not side.has_semantic]
        yield f"the semantic part is left out: {' and '.join(without)} has none"


_DEPTH = {"semantic": 3}
"""The length of the path to a part that is printed on a line of its own, by section; 2 in other sections."""

_SIGNS = {"added": "+", "removed": "-", "renamed": ">", "moved": ">", "changed": "~"}

_INTERFACE = " interface"


def _removed_lines(removed: Sequence[RemovedName]) -> Iterator[str]:
    """Yield the kind and name of each removed name, and the interfaces of a joint in one line."""
    if not removed:
        return
    yield from ("", "breaking: names that are gone, on which others may rely")
    width = max(len(name.kind) for name in removed)
    for (kind, owner, now), names in groupby(removed, key=_owner):
        text = owner + (f", now {now}" if now else "")
        if kind.endswith(_INTERFACE):
            interfaces = [name.name.rpartition("/")[2] for name in names]
            text = f"{owner}: {', '.join(interfaces)}" + (f", now of {now}" if now else "")
        yield f"  {kind:{width}}  {text}"


def _owner(name: RemovedName) -> tuple[str, str, str | None]:
    if not name.kind.endswith(_INTERFACE):
        return name.kind, name.name, name.now
    return name.kind, name.name.rpartition("/")[0], name.now.rpartition("/")[0] if name.now else None


def _part_lines(part: tuple[str, ...], differences: Sequence[Difference]) -> Iterator[str]:
    """Yield what happened to a part as a whole, then what differs in it."""
    name, steps = "/".join(part), len(part) + 1
    whole = [difference for difference in differences if len(difference.path) <= steps]
    for difference in whole:
        sign = _SIGNS[difference.kind]
        yield f"  {sign} {name}: {difference.text}" if name else f"  {sign} {difference.text}"
    inner = [difference for difference in differences if len(difference.path) > steps]
    if inner and not whole:
        yield f"  ~ {name}"
    for difference in inner:
        sign = "" if difference.kind == "changed" else f"{_SIGNS[difference.kind]} "
        yield f"      {sign}{'/'.join(difference.path[steps:])}: {difference.text}"


def _json_text(comparison: _Comparison) -> str:
    """Return the comparison as docs/diff.schema.json describes it."""
    import json

    document: dict[str, object] = {"version": 1}
    for name, side in zip(_SIDES, comparison.sides, strict=True):
        settings = {"parameters": side.parameters, "variant": side.variant, "srdf": side.srdf}
        document |= {name: side.word, f"{name}_settings": settings}
    document |= {
        "tolerance": comparison.tolerance,
        "semantic_compared": all(side.has_semantic for side in comparison.sides),
        "not_read_back": comparison.not_read_back,
        "same": not comparison.differences,
        "breaking": [name._asdict() for name in comparison.removed],
        "differences": [{**vars(one), "path": "/".join(one.path)} for one in comparison.differences],
    }
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"
