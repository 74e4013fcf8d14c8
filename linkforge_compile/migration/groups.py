"""The parts of a robot that a template has, and the documents in which all outcomes of their conditions occur."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from linkforge_compile.migration.conditions import Outcomes, atom_of, atoms_in, combinations, holds, joined_in
from linkforge_compile.migration.symbols import NotConstantError, Parts, as_expression, symbols_in
from linkforge_compile.migration.template import Choice, Comment, Content, Element, Text
from linkforge_compile.migration.written import Writer

NAMED = {
    "link": "links",
    "joint": "joints",
    "material": "materials",
    "transmission": "transmissions",
    "ros2_control": "ros2_control",
}
"""The sections of a spec for the elements that have a name."""

REST = ("robot", "")
"""The group of what has no section."""

MARK = "linkforge_block"
"""The tag in a Gazebo block without a name that tells which it is."""

GroupKey = tuple[str, str]


@dataclass(eq=False)
class Placed:
    """An element of the robot and the conditions under which it exists."""

    guards: tuple[ast.expr, ...]
    element: Element

    def exists(self, outcomes: Outcomes) -> bool:
        """Whether all of its conditions are true."""
        return all(holds(guard, outcomes) for guard in self.guards)


@dataclass(eq=False)
class Group:
    """What belongs to one entry of a spec: a link with the Gazebo blocks about it, say."""

    key: GroupKey
    placed: list[Placed] = field(default_factory=list)
    atoms: dict[str, ast.expr] = field(default_factory=dict)
    outcomes: Sequence[Outcomes] = ()

    def add(self, placed: Placed) -> None:
        self.placed.append(placed)
        for guard in placed.guards:
            key, atom, _ = atom_of(guard)
            self.atoms.setdefault(key, atom)
        for key, atom in atoms_in([placed.element]):
            self.atoms.setdefault(key, atom)

    def settle(self) -> None:
        """Find the outcomes of its conditions, of which some may join others: `a and b` beside `a and not b`."""
        if self.key == REST:
            self.outcomes = [{}]
            return
        joined = joined_in(self.atoms)
        try:
            self.outcomes = combinations(joined)
            self.atoms = joined
        except NotConstantError:  # too many
            self.outcomes = combinations(self.atoms)

    def outcome(self, number: int) -> Outcomes:
        return self.outcomes[min(number, len(self.outcomes) - 1)]

    def is_present(self, outcomes: Outcomes) -> bool:
        """Whether the entry exists."""
        tag = self.key[0]
        return any(one.exists(outcomes) for one in self.placed if tag in (one.element.tag, "robot"))

    def is_twofold(self, outcomes: Outcomes) -> bool:
        """Whether there are two elements of the name of the entry."""
        return sum(one.exists(outcomes) for one in self.placed if one.element.tag == self.key[0]) > 1

    def in_context(self, outcomes: Outcomes) -> Outcomes:
        """Return these outcomes, or others if the entry would be missing, which others may refer to."""
        if self.is_present(outcomes) or self.key[0] not in ("link", "joint", "material"):
            return outcomes
        return next((one for one in self.outcomes if self.is_present(one)), outcomes)


class Groups:
    """The groups of one file."""

    def __init__(self, content: list[Content], writer: Writer) -> None:
        self._content, self._writer = content, writer
        self.by_key: dict[GroupKey, Group] = {}
        self._group_of: dict[Element, Group] = {}
        self.others: set[str] = set()
        """What stands for the names that blocks about no certain part have as their reference."""
        placed = list(_placed(content, ()))
        guards = {
            (one.element.tag, self.name_of(one.element, "name")): _keys(one.guards)
            for one in placed
            if one.element.tag in ("link", "joint")
        }
        for one in placed:
            key = self._key(one, guards)
            if key == REST and one.guards:
                raise NotConstantError(frozenset().union(*map(symbols_in, one.guards)))
            group = self.by_key.setdefault(key, Group(key))
            group.add(one)
            self._group_of[one.element] = group
        for group in self.by_key.values():
            group.settle()

    @property
    def count(self) -> int:
        """How many documents have all outcomes of each group."""
        return max((len(group.outcomes) for group in self.by_key.values()), default=1)

    def name_of(self, element: Element, attribute: str) -> str:
        return self._writer.name(element.attributes.get(attribute, ()))

    def _key(self, placed: Placed, guards: Mapping[GroupKey, frozenset[tuple[str, bool]]]) -> GroupKey:
        element = placed.element
        if element.tag in NAMED:
            return element.tag, self.name_of(element, "name")
        if element.tag == "gazebo":
            reference = self.name_of(element, "reference")
            own = next((key for tag in ("link", "joint") if (key := (tag, reference)) in guards), None)
            if own is not None and guards[own] <= _keys(placed.guards):
                return own
            if own is not None:
                # The part may be missing where the block is there, so the block is not a part of it.
                name = element.attributes["reference"]
                element.attributes["reference"] = (ast.JoinedStr(values=[as_expression(name)]),)
                self.others.add(self.name_of(element, "reference"))
            return "gazebo", str(len(self._group_of))
        return REST

    def document(self, number: int, attributes: dict[str, Parts]) -> str:
        """Return a document with the outcomes of a number, the first one with comments."""
        return self._writer.document(attributes, self._pieces(self._content, number))

    def _pieces(self, content: list[Content], number: int) -> Iterator[str]:
        for one in content:
            if isinstance(one, Choice):
                yield from self._pieces(one.content, number)
            elif isinstance(one, Element):
                group = self._group_of[one]
                outcomes = group.in_context(group.outcome(number))
                if next(placed for placed in group.placed if placed.element is one).exists(outcomes):
                    mark = group.key[1] if group.key[0] == "gazebo" else None
                    yield self._writer.element(one, outcomes, mark=mark and f"<{MARK}>{mark}</{MARK}>")
            elif number == 0 and isinstance(one, Comment | Text):
                yield self._writer.content([one], {}, is_plugin=False)


def _keys(guards: tuple[ast.expr, ...]) -> frozenset[tuple[str, bool]]:
    atoms = map(atom_of, guards)
    return frozenset((key, positive) for key, _, positive in atoms)


def _placed(content: list[Content], guards: tuple[ast.expr, ...]) -> Iterator[Placed]:
    for one in content:
        if isinstance(one, Choice):
            yield from _placed(one.content, (*guards, one.test))
        elif isinstance(one, Element):
            yield Placed(guards, one)
