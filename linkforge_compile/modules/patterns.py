"""Regular expressions that a stranger may write: matched without backtracking, in time that grows with the text only.

Python's own matcher tries one way after the other, and `(a+)+$` makes it try for ever. Here all ways are followed at
once, as in Thompson's construction, so what no such machine can follow (look-around, references to groups) is refused.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from typing import Any, TypeAlias

MAX_PATTERN = 500
MAX_TEXT = 1_000
MAX_STATES = 2_000
_PLACES_A_STEP = 4
"""How many places of a pattern can be looked at while an expression takes one of its steps."""

_sre = import_module("re._parser")
"""Python's parser of regular expressions, which gives a tree without compiling it."""

Accepts: TypeAlias = Callable[[str], bool]
Holds: TypeAlias = Callable[[str, int], bool]
Tree: TypeAlias = Any  # of Python's parser: pairs of an operator and whatever belongs to it, typed nowhere


class PatternError(Exception):
    """A pattern that is none, or that is not of the kind that can be matched in bounded time; says why."""


@dataclass(slots=True)
class _State:
    """A place in the pattern: what leads on from it, past a character or, where a condition holds, without one."""

    accepts: Accepts | None = None
    holds: Holds | None = None
    following: list[int] = field(default_factory=list)


class Pattern:
    """A regular expression of the language of specs."""

    def __init__(self, text: str) -> None:
        """Read it; raise PatternError for one that is refused."""
        self.text = text
        if len(text) > MAX_PATTERN:
            raise PatternError(f"it is longer than {MAX_PATTERN} characters")
        try:
            with warnings.catch_warnings():
                # `[[a]` may mean something else one day, says Python on standard error.
                warnings.simplefilter("ignore")
                tree = _sre.parse(text)
        except re.error as error:
            raise PatternError(error.msg) from error
        except (RecursionError, OverflowError) as error:
            raise PatternError("it nests too deep or counts too far") from error
        if tree.state.flags & ~re.UNICODE:
            raise PatternError("flags such as (?i) are not part of it")
        self._states: list[_State] = []
        self._end = self._state(_State())
        self._start = self._sequence(tree, self._end)

    def steps(self, text: str) -> int:
        """Return how many steps it may take to look through a text, at most."""
        return len(self._states) * (1 + min(len(text), MAX_TEXT) // _PLACES_A_STEP)

    def is_in(self, text: str) -> bool:
        """Whether the pattern matches anywhere in the text; a text beyond MAX_TEXT characters is not looked through."""
        if len(text) > MAX_TEXT:
            return False
        current: set[int] = set()
        for index in range(len(text) + 1):
            # It may begin at every place of the text.
            current = self._reached({*current, self._start}, text, index)
            if self._end in current:
                return True
            accepting = (self._states[state] for state in current) if index < len(text) else iter(())
            current = {
                after for one in accepting if one.accepts and one.accepts(text[index]) for after in one.following
            }
        return False

    def _reached(self, states: set[int], text: str, index: int) -> set[int]:
        """Return the states and all that they lead to without a character."""
        reached: set[int] = set()
        waiting = list(states)
        while waiting:
            number = waiting.pop()
            if number not in reached:
                reached.add(number)
                state = self._states[number]
                if state.accepts is None and (state.holds is None or state.holds(text, index)):
                    waiting.extend(state.following)
        return reached

    def _state(self, state: _State) -> int:
        if len(self._states) >= MAX_STATES:
            raise PatternError(f"it counts further than {MAX_STATES:,} steps")
        self._states.append(state)
        return len(self._states) - 1

    def _sequence(self, tree: Tree, after: int) -> int:
        """Add the states of a sequence that leads to `after`, and return the first of them."""
        for operator, value in reversed(list(tree)):
            after = self._item(str(operator), value, after)
        return after

    def _item(self, operator: str, value: Tree, after: int) -> int:
        match operator:
            case "LITERAL" | "NOT_LITERAL" | "ANY" | "IN":
                return self._state(_State(accepts=_accepting(operator, value), following=[after]))
            case "BRANCH":
                return self._state(_State(following=[self._sequence(branch, after) for branch in value[1]]))
            case "SUBPATTERN" if not (value[1] or value[2]):
                return self._sequence(value[3], after)
            case "MAX_REPEAT" | "MIN_REPEAT":
                least, most, repeated = value
                return self._repeat(repeated, least, most, after)
            case "AT" if str(value) in _PLACES:
                return self._state(_State(holds=_PLACES[str(value)], following=[after]))
        raise PatternError(f"{_REFUSED.get(operator, 'this syntax')} cannot be matched in bounded time")

    def _repeat(self, tree: Tree, least: int, most: int, after: int) -> int:
        if most == _sre.MAXREPEAT:
            loop = self._state(_State(following=[after]))
            self._states[loop].following.append(self._sequence(tree, loop))
            after = loop
        else:
            end = after
            for _ in range(most - least):
                after = self._state(_State(following=[end, self._sequence(tree, after)]))
        for _ in range(least):
            after = self._sequence(tree, after)
            self._state(_State())  # counted, so that repeating what is empty ends as well
        return after


def _accepting(operator: str, value: Tree) -> Accepts:
    match operator:
        case "LITERAL":
            return partial(str.__eq__, chr(value))
        case "NOT_LITERAL":
            return partial(str.__ne__, chr(value))
        case "ANY":
            return lambda character: character != "\n"
    negated = str(value[0][0]) == "NEGATE"
    members = [_member(str(kind), member) for kind, member in value[negated:]]
    return lambda character: any(accepts(character) for accepts in members) is not negated


def _member(kind: str, value: Tree) -> Accepts:
    """Return a test for one part of a class such as `[a-z_]`."""
    match kind:
        case "LITERAL":
            return partial(str.__eq__, chr(value))
        case "RANGE":
            first, last = value
            return lambda character: first <= ord(character) <= last
        case "CATEGORY" if str(value) in _CATEGORIES:
            return _CATEGORIES[str(value)]
    raise PatternError("it has a class that is not known")


def _word(character: str) -> bool:
    return character.isalnum() or character == "_"


def _boundary(text: str, index: int) -> bool:
    before, behind = text[index - 1 : index] if index else "", text[index : index + 1]
    return (before != "" and _word(before)) is not (behind != "" and _word(behind))


_CATEGORIES: dict[str, Accepts] = {
    "CATEGORY_DIGIT": str.isdecimal,
    "CATEGORY_NOT_DIGIT": lambda character: not character.isdecimal(),
    "CATEGORY_SPACE": str.isspace,
    "CATEGORY_NOT_SPACE": lambda character: not character.isspace(),
    "CATEGORY_WORD": _word,
    "CATEGORY_NOT_WORD": lambda character: not _word(character),
}

_PLACES: dict[str, Holds] = {
    "AT_BEGINNING": lambda _text, index: index == 0,
    "AT_BEGINNING_STRING": lambda _text, index: index == 0,
    "AT_END": lambda text, index: text[index:] in {"", "\n"},
    "AT_END_STRING": lambda text, index: index == len(text),
    "AT_BOUNDARY": _boundary,
}

_REFUSED = {
    "GROUPREF": "a reference to a group",
    "GROUPREF_EXISTS": "a reference to a group",
    "ASSERT": "look-around",
    "ASSERT_NOT": "look-around",
    "SUBPATTERN": "a group with flags",
    "AT": "\\B",
}
