"""Completes command lines: answers a shell through argcomplete, and finds what a word may be."""

from __future__ import annotations

import argparse
import os
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from argcomplete.completers import BaseCompleter
from argcomplete.finders import CompletionFinder
from argcomplete.lexers import split_line

from linkforge_compile import formats
from linkforge_compile.cli import UsageError
from linkforge_compile.cli.options import Parser, name_set_by, packages_of, split_assignments
from linkforge_compile.diagnostics.codes import REGISTER

if TYPE_CHECKING:
    from linkforge_compile.listing import ListedParameter, Listing


Described = dict[str, str]
"""Completions with their descriptions, "" for none."""

_SPECS = (".robot.yaml", ".robot.yml", ".urdf", ".xacro")
_ENDINGS = {"import": (".urdf", ".xacro"), "where": ("",), "format": (".yaml", ".yml")}
"""The endings of the files that are the words of a command, other than robots; "" for any file."""

_TAKE_SEVERAL = {"compile": None, "check": None, "collisions": None, "format": None, "diff": 2}
"""Commands on several files, with the most that they take, None for any number."""

_TAKE_NO_VALUES = ("format", "params", "where")
"""Commands without `NAME:=VALUE`."""


class Candidates(BaseCompleter):
    """What a word may be for one command, with the words before the cursor parsed."""

    def __init__(self, command: str, given: argparse.Namespace) -> None:
        self._command = command
        self._given = given
        words = getattr(given, "words", None) or [getattr(given, "spec", None) or getattr(given, "file", None) or ""]
        self._words, self._assignments = split_assignments(filter(None, words))

    def __call__(
        self, *, prefix: str, action: argparse.Action, parser: argparse.ArgumentParser, parsed_args: argparse.Namespace
    ) -> Described:
        try:
            return self._candidates(prefix, action)
        except (UsageError, OSError):
            return {}

    def _candidates(self, prefix: str, action: argparse.Action) -> Described:
        match action.dest:
            case "words" | "spec" | "file":
                return self._of_words(prefix)
            case "name" if self._command == "where":
                return self._names_in_output()
            case "parameters" | "before" | "after":
                return self._of_parameters(prefix, "=")
            case "variant" | "variants" | "before_variant" | "after_variant":
                return self._of_variants(prefix)
            case "formats" | "names":
                return {one.name: one.description for one in formats.FORMATS}
            case "packages" | "before_package" | "after_package":
                name, equals, folder = prefix.partition("=")
                return {f"{name}={path}": "" for path in _paths(folder, ())} if equals else {}
            case "poses":
                return self._of_poses()
            case "show":
                from linkforge_compile.cli.commands.view import LAYERS

                return _after(prefix, ",", dict.fromkeys(LAYERS, ""))
            case "select" | "ignore":
                return _after(prefix, ",", {code.id: code.title for code in REGISTER.values()})
        return self._of_files(prefix, action.metavar)

    def _of_words(self, prefix: str) -> Described:
        if ":=" in prefix:
            return self._of_parameters(prefix, ":=")
        if self._command == "explain":
            return self._of_explained(prefix)
        most = _TAKE_SEVERAL.get(self._command, 1)
        is_full = most is not None and len(self._words) >= most
        files = [] if is_full else _paths(prefix, _ENDINGS.get(self._command, _SPECS))
        parameters = {} if self._command in _TAKE_NO_VALUES else self._of_parameters(prefix, ":=")
        return {**parameters, **dict.fromkeys(files, "")}

    def _of_explained(self, prefix: str) -> Described:
        if self._words:
            is_full = len(self._words) > 1
            return {**self._of_parameters(prefix, ":="), **({} if is_full else self._paths_in_robot(prefix))}
        codes = {code.id: code.title for code in REGISTER.values()} if prefix.startswith("LF") else {}
        return {**codes, **dict.fromkeys(_paths(prefix, _SPECS), "")}

    def _of_files(self, prefix: str, metavar: str | tuple[str, ...] | None) -> Described:
        match metavar:
            case "FOLDER":
                return dict.fromkeys(_paths(prefix, ()), "")
            case "[FORMAT=]FOLDER":
                name, equals, folder = prefix.rpartition("=")
                return {f"{name}{equals}{path}": "" for path in _paths(folder, ())}
            case "FILE" | "PATH" | "SRDF" | "ROBOT.srdf":
                return dict.fromkeys(_paths(prefix, ("",)), "")
        return {}

    def _of_parameters(self, prefix: str, sign: str) -> Described:
        """Return `NAME:=` for the parameters without a value on this line, or the values of the one in `prefix`."""
        parameters = {one.name: one for listing in self._listings() for one in listing.parameters}
        name, equals, _ = prefix.partition(sign)
        if equals:
            return {f"{name}{sign}{value}": "" for value in _values(parameters.get(name))}
        options = getattr(self._given, "parameters", None) or []
        is_set = set(map(name_set_by, (*self._assignments, *options)))
        return {f"{one.name}{sign}": _about(one) for one in parameters.values() if one.name not in is_set}

    def _of_variants(self, prefix: str) -> Described:
        variants: Described = {}
        for listing in self._listings():
            for name, settings in listing.variants.items():
                variants[name] = ", ".join(f"{key}={value}" for key, value in settings.items())
        return _after(prefix, "+", variants)

    def _listings(self) -> Iterator[Listing]:
        from linkforge_compile.pipeline import parameters_of

        packages = packages_of(self._given) if hasattr(self._given, "packages") else {}
        for word in self._words:
            if word.endswith(_SPECS) and Path(word).is_file():
                may_leave = getattr(self._given, "allow_outside", False)
                listing, _ = parameters_of(word, packages=packages, allow_outside=may_leave)
                if listing:
                    yield listing

    def _of_poses(self) -> Described:
        """Return the states of the groups of the compiled robot, and `JOINT=` of the joints that `view` can move."""
        from linkforge_compile.cli.options import compile_spec
        from linkforge_compile.cli.poses import movable_joints, states_by_name

        robot = compile_spec(self._words[0], self._assignments, self._given).robot if self._words else None
        if robot is None:
            return {}
        joints = movable_joints(robot) if self._command == "view" else ()
        return dict.fromkeys((*states_by_name(robot), *(f"{joint}=" for joint in joints)), "")

    def _paths_in_robot(self, prefix: str) -> Described:
        """Return the parts and values of the compiled robot at the path before the last slash."""
        from linkforge_compile.cli.options import compile_spec
        from linkforge_compile.export_spec import UnknownPathError, parts_at

        robot = compile_spec(self._words[0], self._assignments, self._given).robot
        slashes = [place for place, letter in enumerate(prefix) if letter == "/"]
        # A name may have slashes, so the path before the last one may lead nowhere.
        for end in (*reversed(slashes), -1):
            try:
                parts = parts_at(robot, prefix[: max(end, 0)]) if robot else {}
            except UnknownPathError:
                continue
            return {f"{prefix[: end + 1]}{name}{'/' if has_parts else ''}": "" for name, has_parts in parts.items()}
        return {}

    def _names_in_output(self) -> Described:
        from linkforge_compile.cli.commands.where import names_in

        return dict.fromkeys(names_in(Path(self._words[0])), "") if self._words else {}


def _values(parameter: ListedParameter | None) -> Iterable[str]:
    """Return the values that a parameter has a choice of, numbers with their unit."""
    if parameter is None:
        return ()
    if parameter.type == "boolean":
        return ("true", "false")
    choices = [one for one in parameter.choices or () if isinstance(one, str | int | float)]
    return (f"{one}{parameter.unit or ''}" for one in choices)


def _about(parameter: ListedParameter) -> str:
    described = " ".join(parameter.description.split())
    return described or ", ".join(filter(None, (parameter.type, parameter.limits)))


def _after(prefix: str, separator: str, names: Mapping[str, str]) -> Described:
    """Return names for the last item of a list such as `LF5,LF6003`."""
    before = prefix.rpartition(separator)
    return {f"{before[0]}{before[1]}{name}": about for name, about in names.items()}


def _paths(prefix: str, endings: tuple[str, ...]) -> list[str]:
    """Return the folders and the files of some endings whose paths begin with `prefix`; hidden ones from a dot on."""
    folder, name = os.path.split(prefix)
    start = prefix.removesuffix(name) if name else prefix
    found = []
    with os.scandir(Path(folder or ".").expanduser()) as entries:
        for entry in entries:
            if entry.name.startswith(name) and (name or not entry.name.startswith(".")):
                if entry.is_dir():
                    found.append(f"{start}{entry.name}/")
                elif entry.name.endswith(endings):
                    found.append(f"{start}{entry.name}")
    return sorted(found)


PATIENCE = 3.0
"""Time after which nothing is completed [s], because a shell waits for the answer."""


def complete(commands: Mapping[str, str], parser_of: Callable[[str], Parser]) -> None:
    """Print the completions of the line that a shell passes in environment variables, and end the process.

    `commands` has the summary of each command. A faulty spec completes nothing, and so does one that needs more time
    than PATIENCE.
    """
    # Reading a spec may block inside a library, so an exception would be late.
    timer = threading.Timer(PATIENCE, os._exit, [1])
    timer.daemon = True
    timer.start()
    words = split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))[3]  # those before the cursor's
    start = _start_of_command(words, commands)
    name, *given = words[start + 1 :] or [""]
    if not name:
        os.environ["_ARGCOMPLETE"] = str(start + 1)
        _Finder()(_parser_of_commands(commands), always_complete_options=False)
    elif name in commands:
        # argcomplete omits the words before the one that it takes for the program, here the command.
        os.environ["_ARGCOMPLETE"] = str(start + 2)
        candidates = Candidates(name, _parse(parser_of(name), given))
        _Finder()(parser_of(name), always_complete_options=False, default_completer=candidates)
    os._exit(1)


def _start_of_command(words: Sequence[str], commands: Mapping[str, str]) -> int:
    """Return the place of `linkforge` in a line, which may have other commands: `cd robots && linkforge check`."""
    # zsh passes all of the line.
    found = [place for place, word in enumerate(words) if PurePath(word).name == "linkforge"]
    used = [place for place in found if words[place + 1 : place + 2] and words[place + 1] in commands]
    return (used or found or [0])[-1]


def _parser_of_commands(commands: Mapping[str, str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("linkforge")
    parser.add_argument("-V", "--version", action="version", help="print the version")
    names = parser.add_subparsers()
    for name, summary in commands.items():
        names.add_parser(name, help=summary)
    return parser


def _parse(parser: Parser, words: Sequence[str]) -> argparse.Namespace:
    """Parse the words before the cursor, as far as they make sense."""
    # The last word may be an option whose value is at the cursor.
    for given in (words, words[:-1], ()):
        try:
            return parser.parse_words(given)
        except SystemExit:
            continue
    return argparse.Namespace()


class _Finder(CompletionFinder):
    """Completes positional words after options too, as our parser accepts them."""

    def collect_completions(
        self, active_parsers: list[argparse.ArgumentParser], parsed_args: argparse.Namespace, cword_prefix: str
    ) -> list[str]:
        parser = active_parsers[-1]
        # After `compile SPEC -o FOLDER`, argcomplete sees no argument that takes a further word.
        if not parser.active_actions:  # type: ignore[attr-defined]
            parser.active_actions = parser._get_positional_actions()  # type: ignore[attr-defined]
        return super().collect_completions(active_parsers, parsed_args, cword_prefix)
