"""The argument parser, and options that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NoReturn

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.formats import declared_options
from linkforge_compile.source.characters import on_one_line


class Parser(argparse.ArgumentParser):
    """Parses the arguments of one command; its errors cannot send control characters to a terminal."""

    def error(self, message: str) -> NoReturn:
        # The message quotes words, which a script may have taken from names of files.
        super().error(on_one_line(message))


class StoreOnce(argparse.Action):
    """Stores the value of an option, and rejects a second value, which argparse's own action would prefer silently."""

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
    """Add a spec and ROS's NAME:=VALUE as one list of words, which `split_assignments` separates."""
    parser.add_argument("words", metavar="SPEC", nargs="+", help="the spec, NAME.robot.yaml; - for standard input")


def add_spec_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that choose how a spec is compiled."""
    add_parameter_option(parser, "set a parameter of the spec, such as reach=0.7m")
    parser.add_argument(
        "--variant",
        metavar="NAME",
        help="the variant of the spec whose values replace the defaults; -p replaces those of the variant",
    )
    add_package_option(parser)
    add_outside_option(parser)
    for option in declared_options():
        parser.add_argument(f"--{option.name}", choices=option.choices, default=option.default, help=option.help)


def format_options_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the values of the options that output formats declare."""
    return {option.name: getattr(arguments, option.name) for option in declared_options()}


def add_parameter_option(parser: argparse.ArgumentParser, description: str) -> None:
    parser.add_argument(
        "-p",
        "--parameter",
        metavar="NAME=VALUE",
        dest="parameters",
        action="append",
        default=[],
        help=f"{description}; ROS's NAME:=VALUE works too, with or without -p",
    )


def add_package_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--package",
        metavar="NAME=PATH",
        dest="packages",
        action="append",
        default=[],
        help="the folder of package://NAME/, which is used before any other place is searched",
    )


def add_outside_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--allow-outside",
        action="store_true",
        help="let the spec read any file (default: only files in its package or repository, or else its folder, and"
        " in --package, AMENT_PREFIX_PATH and ROS_PACKAGE_PATH)",
    )


def packages_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the `--package` options as folders by name; UsageError if one is not NAME=PATH."""
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
    """Separate the words of a command line into specs and `NAME:=VALUE`."""
    specs: list[str] = []
    assignments: list[str] = []
    for word in words:
        (assignments if ":=" in word else specs).append(word)
    return specs, assignments
