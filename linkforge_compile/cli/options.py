"""The argument parser, options that several commands share, and the robots that they read and compile."""

from __future__ import annotations

import argparse
import os
import re
import stat
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, BinaryIO, NoReturn

from linkforge_compile import formats
from linkforge_compile.cli import UsageError
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.formats import declared_options
from linkforge_compile.limits import FACTOR_VARIABLE, MAX_FILE_BYTES, parse_factor
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    from linkforge_compile.analysis import Settings
    from linkforge_compile.formats import Format
    from linkforge_compile.pipeline import Compilation

STDIN = "<stdin>"
"""The name of standard input in diagnostics."""


_POSITIONAL = "\0"
"""Marks a word as positional; no word of a command line can contain it."""


class Parser(argparse.ArgumentParser):
    """Parses the arguments of one command; its errors cannot send control characters to a terminal."""

    _words: Sequence[str] = ()

    def parse_words(self, words: Sequence[str]) -> argparse.Namespace:
        """Parse options and positional words in any order; what comes after `--` is positional."""
        # Python 3.11 parses intermixed words twice and forgets the `--` in between.
        end = words.index("--") if "--" in words else len(words)
        self._words = words
        marked = [_POSITIONAL + word if word.startswith("-") and word != "-" else word for word in words[end + 1 :]]
        arguments = self.parse_intermixed_args([*words[:end], *words[end : end + 1], *marked])
        for name, value in vars(arguments).items():
            if isinstance(value, str):
                setattr(arguments, name, value.removeprefix(_POSITIONAL))
            elif isinstance(value, list):
                value[:] = [word.removeprefix(_POSITIONAL) if isinstance(word, str) else word for word in value]
        return arguments

    def error(self, message: str) -> NoReturn:
        # The message quotes words, which a script may have taken from names of files.
        super().error(on_one_line(message.replace(_POSITIONAL, "") + self._hint_at_minus(message)))

    def _hint_at_minus(self, message: str) -> str:
        """Return the way out if the value of an option is taken for an option, as it begins with a minus."""
        if match := re.fullmatch(r"argument (?:-\w/)?(--[\w-]+): expected one argument", message):
            option = match[1]
            for word, value in pairwise(self._words):
                if word == option and re.match(r"-[\d.]", value):
                    return f"; write {option}={value}, as a minus begins an option otherwise"
        return ""


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


def add_spec_and_values(
    parser: argparse.ArgumentParser, help_: str = "the spec, NAME.robot.yaml; - for standard input"
) -> None:
    """Add a spec and ROS's NAME:=VALUE as one list of words, which `split_assignments` separates."""
    parser.add_argument("words", metavar="SPEC", nargs="+", help=help_)


def add_spec_options(parser: argparse.ArgumentParser, *, variants_help: str = "") -> None:
    """Add the options that choose how a spec is compiled.

    With `variants_help`, `--variant` may be given several times, and `variants` of the arguments is their list.
    """
    add_parameter_option(parser, "set a parameter of the spec, such as reach=0.7m")
    about = "the variant of the spec whose values replace the defaults; sim+lab combines several, and the last one has "
    about += "precedence; -p has precedence over variants"
    if variants_help:
        help_ = f"{about}; {variants_help}"
        parser.add_argument("--variant", metavar="NAME", dest="variants", action="append", default=[], help=help_)
        parser.set_defaults(variant=None)
    else:
        parser.add_argument("--variant", metavar="NAME", help=about)
    add_package_option(parser)
    add_outside_option(parser)


def add_format_options(parser: argparse.ArgumentParser, formats: Sequence[Format] | None = None) -> None:
    """Add the options that formats declare, all for None, for commands that render them or check their limits."""
    for option in declared_options() if formats is None else (option for one in formats for option in one.options):
        if option.is_flag:
            name, (off, on) = f"--{option.name}", option.choices
            parser.add_argument(name, action="store_const", const=on, default=off, help=option.help)
            continue
        parser.add_argument(f"--{option.name}", choices=option.choices, default=option.default, help=option.help)


def format_options_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the values of the options that output formats declare; the defaults for a command without them."""
    return {option.name: getattr(arguments, option.name, option.default) for option in declared_options()}


def refuse_options_of_other_formats(arguments: argparse.Namespace, requested: Sequence[str], option_of: str) -> None:
    """Refuse an option that has no effect, because none of the formats that `option_of` requested has it."""
    values = format_options_of(arguments)
    for option in declared_options():
        owners = [one.name for one in formats.FORMATS if option in one.options]
        if values[option.name] != option.default and not set(owners).intersection(requested):
            raise UsageError(
                f"--{option.name} is an option of {alternatives(owners)}, found {alternatives(requested, 'and')}; "
                f"add {option_of} {owners[0]}, or leave it out"
            )


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
        help="the folder of package://NAME/, which has precedence over all other search paths",
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
    return parse_packages(arguments.packages, "--package")


def parse_packages(pairs: Iterable[str], option: str, start: Path = Path()) -> dict[str, str]:
    """Return the values of an option as folders by name, from `start`; UsageError if one is not NAME=PATH."""
    packages: dict[str, str] = {}
    for pair in pairs:
        name, separator, folder = pair.partition("=")
        if not (name and separator and folder):
            raise UsageError(f"{option} takes NAME=PATH, found '{pair}'")
        if not (start / folder).is_dir():
            raise UsageError(f"{option} {pair}: there is no folder '{start / folder}'")
        packages[name] = str(start / folder)
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


def require_one_spec(specs: list[str]) -> str:
    """Return the only spec of a command line; UsageError if there is none, or several."""
    if specs == [""]:
        raise UsageError("takes one spec, found '': is a variable of the shell empty?")
    if len(specs) == 1:
        return specs[0]
    if not specs:
        raise UsageError("takes one spec, found none")
    assignment = next((word for word in specs if "=" in word), None)
    hint = f"; write '-p {assignment}' to set a parameter" if assignment else ""
    raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}{hint}")


def compile_spec(
    spec: str,
    assignments: list[str],
    arguments: argparse.Namespace,
    *,
    folders: Mapping[str, Path] = MappingProxyType({}),
    text: str | None = None,
    formats: tuple[str, ...] = (),
    variant: str | None = None,
) -> Compilation:
    """Compile a spec with the options of `add_spec_options`.

    `variant` is the one where the options may list several. `folders` are where relative paths start, by format.
    `text` is the content of a spec that was read already, because it can be read only once. `formats` are the
    requested ones.
    """
    settings = settings_of(assignments, arguments)._replace(folders=folders, formats=formats)
    return _compile(spec, settings if variant is None else settings._replace(variant=variant), text)


def check_spec(
    spec: str,
    assignments: list[str],
    arguments: argparse.Namespace,
    variant: str | None,
    buffers: Mapping[str, str] = MappingProxyType({}),
) -> Compilation:
    """Check a spec, in a variant, with the other options of `add_spec_options`.

    `buffers` are texts that are read instead of files, by real path.
    """
    return _compile(spec, check_settings_of(assignments, arguments)._replace(variant=variant, buffers=buffers))


def _compile(spec: str, settings: Settings, text: str | None = None) -> Compilation:
    from linkforge_compile.pipeline import compile_path, compile_source

    if spec == "-" or text is not None:
        text = read_stdin() if text is None else text
        return compile_source(text, STDIN if spec == "-" else spec, Path.cwd(), settings)
    return compile_path(spec, settings)


def check_settings_of(assignments: list[str], arguments: argparse.Namespace) -> Settings:
    """Return the settings of a check, for which a parameter may lack its value."""
    from linkforge_compile.expand import Unset

    return settings_of(assignments, arguments)._replace(unset=Unset.NOTE, formats=tuple(arguments.formats))


def settings_of(assignments: list[str], arguments: argparse.Namespace) -> Settings:
    """Return what the options that every command on a spec has say; UsageError for a wrong value."""
    from linkforge_compile.analysis import Settings

    if (factor := os.environ.get(FACTOR_VARIABLE)) and parse_factor(factor) is None:
        raise UsageError(f"{FACTOR_VARIABLE} takes a whole number from 1 to 999999999, found '{factor}'")
    return Settings(
        [*arguments.parameters, *assignments],
        packages_of(arguments),
        arguments.variant,
        format_options_of(arguments),
        allow_outside=arguments.allow_outside,
    )


def read_stdin() -> str:
    """Return the text on standard input, a spec in UTF-8 or XML; UsageError if it is larger than a file may be."""
    if sys.stdin is None:
        raise UsageError("cannot read standard input: it is closed")
    return _read_text(sys.stdin.buffer, "standard input")


def require_file(option: str, word: str | None) -> None:
    """Refuse `-` as the value of an option, because standard input may be the robot."""
    if word == "-":
        raise UsageError(f"{option} takes a file; standard input may be the robot")


def read_unseekable(word: str) -> str | None:
    """Return the text of standard input or a pipe, which can be read only once; None for a file."""
    if word == "-":
        return read_stdin()
    try:
        if not stat.S_ISFIFO(os.stat(word).st_mode):  # noqa: PTH116
            return None
        with Path(word).open("rb") as pipe:
            return _read_text(pipe, f"'{word}'")
    except (OSError, ValueError):
        return None  # reading it as a file reports the reason


def is_xml(word: str, text: str | None) -> bool:
    """Whether a robot is XML, by its name or its first bytes; `text` is its content if it was read already."""
    from linkforge_compile.source.characters import begins_xml

    if Path(word).suffix.lower() in {".urdf", ".xml", ".xacro"}:
        return True
    if text is not None:
        return begins_xml(text)
    try:
        with Path(word).open("rb") as file:
            return begins_xml(file.read(4096))
    except (OSError, ValueError):
        return False


def _read_text(stream: BinaryIO, name: str) -> str:
    content = stream.read(MAX_FILE_BYTES + 1)
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(f"{name} is larger than {MAX_FILE_BYTES // 1024**2} MiB")
    from linkforge_compile.source.characters import UnreadableError, text_of

    try:
        return text_of(content)
    except UnreadableError as error:
        raise UsageError(f"{name} cannot be read: {error}") from None


def whole_number(least: int, most: int = sys.maxsize) -> Callable[[str], int]:
    """Return what parses the value of an option as a whole number in a range."""

    def parse(text: str) -> int:
        number = int(text) if text.isascii() and text.isdigit() and len(text) <= 40 else -1
        if not least <= number <= most:
            limit = "" if most == sys.maxsize else f" to {most}"
            raise argparse.ArgumentTypeError(f"takes a whole number from {least}{limit}, found '{text[:40]}'")
        return number

    return parse


def usable_processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
