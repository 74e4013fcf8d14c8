"""The options that every command on a spec has."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NoReturn

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.formats import declared_options
from linkforge_compile.source.characters import on_one_line


class Parser(argparse.ArgumentParser):
    """Reads the words of one command."""

    def error(self, message: str) -> NoReturn:
        # It quotes words, and a script may take those from the names of files: they have no say over a terminal.
        super().error(on_one_line(message))


class Once(argparse.Action):
    """Takes the value of an option that may be given once, as every one is that collects nothing.

    Of two values, none is forgotten in silence.
    """

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        option_string: str | None = None,
    ) -> None:
        given: dict[str, object] = namespace.__dict__.setdefault("given", {})
        if option_string is not None and self.dest in given:
            raise argparse.ArgumentError(self, f"may be given once, found '{given[self.dest]}' and '{values}'")
        given[self.dest] = values
        setattr(namespace, self.dest, values)


def add_spec_and_values(parser: argparse.ArgumentParser) -> None:
    """Add the one spec of a command and the values of its parameters, which `split_assignments` tells apart."""
    parser.add_argument("words", metavar="SPEC", nargs="+", help="the spec, NAME.robot.yaml; - for standard input")


def add_spec_options(parser: argparse.ArgumentParser) -> None:
    add_parameter_option(parser, "set a parameter of the spec, such as reach=0.7m")
    parser.add_argument(
        "--variant",
        metavar="NAME",
        help="the variant of the spec that sets what -p does not, before the defaults",
    )
    add_package_option(parser)
    add_outside_option(parser)
    for option in declared_options():
        parser.add_argument(f"--{option.name}", choices=option.choices, default=option.default, help=option.help)


def format_options_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the values of the options that output formats declare."""
    return {option.name: getattr(arguments, option.name) for option in declared_options()}


def add_parameter_option(parser: argparse.ArgumentParser, what: str) -> None:
    parser.add_argument(
        "-p",
        "--parameter",
        metavar="NAME=VALUE",
        dest="parameters",
        action="append",
        default=[],
        help=f"{what}; ROS's NAME:=VALUE works too, with or without -p",
    )


def add_package_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--package",
        metavar="NAME=PATH",
        dest="packages",
        action="append",
        default=[],
        help="the folder that package://NAME/ stands for, before any other place it is looked for",
    )


def add_outside_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--allow-outside",
        action="store_true",
        help="let the spec read any file; else what it names lies in its package or repository (or its folder), in"
        " --package, AMENT_PREFIX_PATH or ROS_PACKAGE_PATH",
    )


def packages_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the `--package` options as folder by name; UsageError for one that is not NAME=PATH."""
    packages: dict[str, str] = {}
    for pair in arguments.packages:
        name, separator, folder = pair.partition("=")
        if not (name and separator and folder):
            raise UsageError(f"--package takes NAME=PATH, found '{pair}'")
        if not Path(folder).is_dir():
            raise UsageError(f"--package {pair}: there is no folder '{folder}'")
        packages[name] = folder
    return packages


def name_set_by(pair: str) -> str:
    """Return the name in `NAME=VALUE` or `NAME:=VALUE`."""
    return pair.partition("=")[0].removesuffix(":").strip()


def split_assignments(words: Iterable[str]) -> tuple[list[str], list[str]]:
    """Part the words of a command line into specs and ROS's `name:=value`."""
    specs: list[str] = []
    assignments: list[str] = []
    for word in words:
        (assignments if ":=" in word else specs).append(word)
    return specs, assignments
