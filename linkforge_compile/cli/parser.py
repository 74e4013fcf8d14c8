"""What a command takes, declared as argparse has it, and read without argparse where a command line is plain.

To import argparse, to build its parser and to have that measure the terminal takes as long as to compile a small robot.
So it is asked for help, for the words of what is wrong, and for all that takes more than a look.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.named_tuple import NamedTuple

if TYPE_CHECKING:
    import argparse

Arguments: TypeAlias = SimpleNamespace
"""What was said, or the default, of each thing that a command takes."""


class Declared(NamedTuple):
    """One thing that a command takes: the names and facts that `add_argument` wants, and the title of its group."""

    names: tuple[str, ...]
    facts: Mapping[str, object]
    title: str | None

    @property
    def is_option(self) -> bool:
        return self.names[0].startswith("-")

    @property
    def dest(self) -> str:
        """The name of its value; that of an option is its first long one, as in argparse."""
        if dest := self.facts.get("dest"):
            return str(dest)
        long = [name for name in self.names if name.startswith("--")]
        return (long or self.names)[0].lstrip("-").replace("-", "_")

    @property
    def default(self) -> object:
        return self.facts.get("default", False if self.is_flag else None)

    @property
    def is_flag(self) -> bool:
        return self.facts.get("action") == "store_true"

    @property
    def collects(self) -> bool:
        return self.facts.get("action") == "append"

    def takes(self, value: str) -> bool:
        """Tell whether an option takes a value as it is; False where argparse has to look."""
        if not (self.collects or self.facts.get("action") is None) or not self.facts.keys().isdisjoint(_MEANT):
            return False
        choices = self.facts.get("choices")
        return not isinstance(choices, Sequence) or value in choices


_MEANT = frozenset({"type", "nargs", "const"})
"""Facts by which the value of an option is other than the word behind it."""


class Group:
    """Where a command says what it takes; in its help, what is said of one group stands together."""

    def __init__(self, declared: list[Declared], title: str | None) -> None:
        self._declared, self._title = declared, title

    def add_argument(self, *names: str, **facts: object) -> None:
        """Take what argparse's `add_argument` takes."""
        self._declared.append(Declared(names, facts, self._title))


class Parser(Group):
    """All that a command takes; `summary` begins its help."""

    def __init__(self, program: str, summary: str) -> None:
        super().__init__([], None)
        self.program, self.summary = program, summary
        self.usage: str | None = None
        self.epilog: str | None = None

    @property
    def declared(self) -> Sequence[Declared]:
        return tuple(self._declared)

    def add_argument_group(self, title: str) -> Group:
        return Group(self._declared, title)

    def parse(self, words: Sequence[str]) -> Arguments:
        """Return what the words of a command line say; for what is wrong with them, or asks for help, SystemExit."""
        said = self._said_plainly(words)
        if said is not None:
            return Arguments(**said)
        # Intermixed, so that `linkforge compile arm.robot.yaml -o build/ reach:=0.7` works as it does with ROS's tools.
        return self.argument_parser().parse_intermixed_args(words, Arguments())

    def argument_parser(self) -> argparse.ArgumentParser:
        from linkforge_compile.cli.argument_parser import argument_parser

        return argument_parser(self)

    def _said_plainly(self, words: Iterable[str]) -> dict[str, object] | None:
        """Return the value of all that the command takes; None for words that argparse is to read, or to refuse.

        Plain are words for the one thing that has no name, and options that are written out, with a word for a value.
        """
        options = {name: one for one in self._declared if one.is_option for name in one.names}
        said: dict[str, object] = {}
        unnamed: list[str] = []
        following = iter(words)
        for word in following:
            if not _is_name(word):
                unnamed.append(word)
                continue
            option = options.get(word)
            value = True if option is None or option.is_flag else next(following, None)
            if option is None or not _put(said, option, value):
                return None
        return self._with_unnamed(said, unnamed)

    def _with_unnamed(self, said: Mapping[str, object], words: list[str]) -> dict[str, object] | None:
        unnamed = [one for one in self._declared if not one.is_option]
        if not words or len(unnamed) != 1 or unnamed[0].facts.get("nargs") not in {"+", "*"}:
            return None
        return {**{one.dest: one.default for one in self._declared}, **said, unnamed[0].dest: words}


def _is_name(word: str) -> bool:
    return word.startswith("-") and word != "-"


def _put(said: dict[str, object], option: Declared, value: str | bool | None) -> bool:
    """Put the value of an option to what was said before; tell whether that is plain."""
    dest = option.dest
    if option.is_flag:
        said[dest] = value
        return True
    if not isinstance(value, str) or _is_name(value) or not option.takes(value):
        return False
    if option.collects:
        before = said.setdefault(dest, [])
        assert isinstance(before, list)
        before.append(value)
        return True
    # An option that collects nothing may be given once.
    return said.setdefault(dest, value) is value
