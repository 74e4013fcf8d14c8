"""`linkforge migrate`: a xacro as specs, with its macros as modules."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    add_outside_option,
    add_package_option,
    packages_of,
    require_one_spec,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, print_status, report, status_at_intervals

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.migration.prove import Proved

_ENDING = ".robot.yaml"

_EXAMPLES = """\
Macros become modules with parameters, properties become variables, arguments become parameters, and conditions become
`when`. The xacro is read without running it; then the specs are compiled and compared with what xacro expands, for each
value of a boolean argument and each word that one is compared with, in all combinations. Nothing is written unless all
are the same robot.

examples:
  linkforge migrate arm.urdf.xacro -o robots/
  linkforge migrate ur.urdf.xacro ur_type:=ur5e name:=ur -o robots/
  linkforge migrate ur.urdf.xacro ur_type:=ur5e name:=ur -o robots/ --verify     compare the specs that are there
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge migrate [options] ROBOT.urdf.xacro [ARGUMENT:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="ROBOT.urdf.xacro", nargs="+", help="the xacro of the whole robot")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FOLDER",
        default=".",
        help="the folder of the specs (here), or the robot's file, such as robots/arm.robot.yaml",
    )
    parser.add_argument("--force", action="store_true", help="replace existing specs with other content")
    parser.add_argument(
        "--draft",
        action="store_true",
        help="write the specs even if they give a different robot, to correct them by hand",
    )
    parser.add_argument(
        "--verify", action="store_true", help="compare the specs in the folder with the xacro, and write nothing"
    )
    parser.add_argument(
        "--seconds",
        metavar="N",
        type=float,
        default=300,
        help="the maximum time of the translation and the comparison (default: 300)",
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON, for tools")
    add_package_option(parser)
    add_outside_option(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    files, assignments = split_assignments(arguments.words)
    xacro = Path(require_one_spec(files))
    if not xacro.is_file():
        raise UsageError(f"'{xacro}' is not a file")
    if not arguments.seconds > 0:
        raise UsageError(f"--seconds takes a number above 0, found {arguments.seconds:g}")
    from linkforge_compile.analysis import Settings
    from linkforge_compile.diagnostics import Diagnostics
    from linkforge_compile.migration.deadline import Deadline
    from linkforge_compile.migration.prove import Migrator

    settings = Settings((), packages_of(arguments), allow_outside=arguments.allow_outside)
    (folder, stem), sink = _output(Path(arguments.output)), Diagnostics()
    given = dict(_split(word) for word in assignments)
    deadline = Deadline(arguments.seconds, status_at_intervals(arguments))
    migrator = Migrator(xacro, given, folder, settings.loader(xacro), sink, deadline, stem)
    proved = migrator.verify() if arguments.verify else migrator.run()
    if unknown := next((name for name in given if name not in proved.names), None):
        from linkforge_compile.diagnostics.suggest import did_you_mean

        raise UsageError(f"{xacro} has no argument '{unknown}'{did_you_mean(unknown, proved.names)}")
    report(proved.diagnostics, arguments)
    _print(proved, arguments)
    if not arguments.verify and (proved.is_equal or (arguments.draft and proved.files)):
        _write(proved, folder, arguments)
    elif not arguments.verify:
        way_out = "; --draft writes the specs as they are, to correct them by hand" if proved.files else ""
        print_status(f"nothing is written{way_out}", arguments)
    elif proved.comparisons and not proved.is_equal:
        print_status("the specs are not equal to the xacro: correct them, or migrate again with --force", arguments)
    return OK if proved.is_equal else FAULTY_SPEC


def _output(path: Path) -> tuple[Path, str]:
    """Return the folder of the specs, and the name of the robot's without its ending; empty for that of the xacro."""
    if path.is_dir() or path.suffix not in (".yaml", ".yml"):
        return path, ""
    if not path.name.endswith(_ENDING):
        raise UsageError(f"'{path}' is not the name of a spec; -o takes a folder, or a file that ends in {_ENDING}")
    return path.parent, path.name.removesuffix(_ENDING)


def _split(word: str) -> tuple[str, str]:
    name, _, value = word.partition(":=" if ":=" in word else "=")
    return name, value


def _print(proved: Proved, arguments: argparse.Namespace) -> None:
    from linkforge_compile.cli.output import json_text, write_to_stdout
    from linkforge_compile.migration.report import figure_lines, proof_lines

    proof, figures = proved.proof, proved.figures
    if arguments.json:
        document: dict[str, object] = {"version": 1, "same": proved.is_equal}
        document |= {} if arguments.verify else {"files": list(proved.files)}
        document |= (figures._asdict() if figures else {}) | (proof.as_json() if proof else {})
        write_to_stdout(json_text(document))
        return
    lines = [*(proof_lines(proof) if proof else ()), *(figure_lines(figures) if figures else ())]
    write_to_stdout("".join(f"{line}\n" for line in lines))


def _write(proved: Proved, folder: Path, arguments: argparse.Namespace) -> None:
    from linkforge_compile.cli.output import write_changed

    contents = {folder / name: text for name, text in proved.files.items()}
    there = {path: path.read_text("utf-8", "replace") for path in contents if path.is_file()}
    others = [str(path) for path, text in there.items() if text != contents[path]]
    if others and not arguments.force:
        have = "has other content" if len(others) == 1 else "have other content"
        raise UsageError(f"nothing is written: {', '.join(others)} {have}; use --force to replace it")
    write_changed(contents)
    state = "" if proved.is_equal else ", a draft that is not proved; mend it, and run this again with --verify"
    print_status(f"wrote {', '.join(str(path) for path in contents)}{state}", arguments)
