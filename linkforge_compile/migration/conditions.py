"""The conditions of a part of a robot, and the combinations of their outcomes that are possible."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.migration.logic import negated
from linkforge_compile.migration.placeholders import key_of
from linkforge_compile.migration.symbols import (
    TEXT,
    UNKNOWN,
    UNSET,
    NotConstantError,
    Parts,
    Reference,
    Symbol,
    as_expression,
    joined,
    literal_of,
    symbols_in,
)
from linkforge_compile.migration.template import Choice, Content, Element

MOST_COMBINATIONS = 256

WORDS = frozenset((("joint", "type"), ("ros2_control", "type")))
"""Attributes that decide what an element is: their alternatives are outcomes of conditions."""

Outcomes: TypeAlias = Mapping[str, bool]
"""Whether each condition is true, by its key."""


def atom_of(test: ast.expr) -> tuple[str, ast.expr, bool]:
    """Return the key of a condition, the condition, and whether the test is it, not its negation."""
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            key, atom, holds = atom_of(operand)
            return key, atom, not holds
        case ast.Compare(ops=[ast.NotEq()]):
            key, atom, holds = atom_of(negated(test))
            return key, atom, not holds
    return key_of(test), test, True


def atoms_in(content: list[Content]) -> Iterator[tuple[str, ast.expr]]:
    """Yield the conditions in a content, outer ones first."""
    for one in content:
        if isinstance(one, Choice):
            key, atom, _ = atom_of(one.test)
            yield key, atom
        if isinstance(one, Element):
            yield from atoms_of_words(one)
        if isinstance(one, Choice | Element):
            yield from atoms_in(one.content)


def atoms_of_words(element: Element) -> Iterator[tuple[str, ast.expr]]:
    """Yield the conditions on which an attribute depends that decides what an element is."""
    for name, parts in element.attributes.items():
        if (element.tag, name) in WORDS:
            for node in ast.walk(as_expression(resolved(parts))):
                if isinstance(node, ast.IfExp):
                    key, atom, _ = atom_of(node.test)
                    yield key, atom


def resolved(parts: Parts) -> Parts:
    """Return a text with the values of variables in the place of their names."""
    made: Parts = ()
    for part in parts:
        if isinstance(part, Reference) and part.symbol.role == "variable" and part.symbol.value is not None:
            made = joined(made, resolved(part.symbol.value))
        else:
            made = joined(made, (part,))
    return made


def decided(node: ast.expr, outcomes: Outcomes) -> ast.expr:
    """Return an expression with the alternative that the outcomes choose."""
    match node:
        case ast.IfExp(test=test, body=body, orelse=orelse) if is_decided(test, outcomes):
            return decided(body if holds(test, outcomes) else orelse, outcomes)
        case Reference(symbol=symbol) if symbol.role == "variable" and symbol.value is not None:
            return decided(as_expression(symbol.value), outcomes)
    return node


def holds(test: ast.expr, outcomes: Outcomes) -> bool:
    """Whether a test is true in a combination of outcomes, which has it or the conditions that it joins."""
    key, atom, positive = atom_of(test)
    if key not in outcomes and isinstance(atom, ast.BoolOp):
        is_true = all if isinstance(atom.op, ast.And) else any
        return is_true([holds(one, outcomes) for one in atom.values]) is positive
    return outcomes[key] is positive


def is_decided(test: ast.expr, outcomes: Outcomes) -> bool:
    """Whether a combination of outcomes tells whether a test is true."""
    key, atom, _ = atom_of(test)
    return key in outcomes or (isinstance(atom, ast.BoolOp) and all(is_decided(one, outcomes) for one in atom.values))


def joined_in(atoms: Mapping[str, ast.expr]) -> dict[str, ast.expr]:
    """Return the conditions that `and` and `or` join in these, if some have one in common; else these."""
    found: dict[str, ast.expr] = {}
    shared = False
    for test in atoms.values():
        own = dict(_leaves(test))
        shared = shared or not own.keys().isdisjoint(found)
        found |= own
    return found if shared else dict(atoms)


def _leaves(test: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    key, atom, _ = atom_of(test)
    if isinstance(atom, ast.BoolOp):
        for one in atom.values:
            yield from _leaves(one)
    else:
        yield key, atom


def combinations(atoms: Mapping[str, ast.expr]) -> Sequence[Outcomes]:
    """Return the outcomes of conditions that are possible together: a name equals one of several words at most.

    Raises:
        NotConstantError: for too many; then names that they depend on must have values.

    """
    found: list[dict[str, bool]] = [{}]
    for key, atom in atoms.items():
        found = [
            {**one, key: outcome} for one in found for outcome in (True, False) if not outcome or _can(one, atom, atoms)
        ]
        if len(found) > MOST_COMBINATIONS:
            raise NotConstantError(frozenset().union(*map(symbols_in, atoms.values())))
    return found


def _can(outcomes: Outcomes, atom: ast.expr, atoms: Mapping[str, ast.expr]) -> bool:
    """Whether a condition can be true with those that are."""
    side = _side(atom)
    return side is None or not any(
        outcome and (other := _side(atoms[key])) is not None and other[0] == side[0] and other[1] != side[1]
        for key, outcome in outcomes.items()
    )


def close(refused: Sequence[Outcomes], atoms: Mapping[str, ast.expr]) -> None:
    """Note the parameters that must have one of the words that they are compared with.

    That is so if each of some outcomes that are not valid is that of none of these words.
    """
    words: dict[Symbol, list[str]] = {}
    for key, atom in atoms.items():
        match atom:
            case ast.Compare(left=Reference(symbol=symbol), ops=[ast.Eq()], comparators=[_]):
                if symbol.role == "parameter" and symbol.kind in (TEXT, UNKNOWN):
                    words.setdefault(symbol, []).append(key)
    for symbol, keys in words.items():
        default = "".join(map(str, symbol.value or ()))
        are_all = refused and not any(one[key] for one in refused for key in keys)
        if are_all and (symbol.value is None or default in symbol.choices):
            symbol.is_closed = True


def _side(atom: ast.expr) -> tuple[str, object] | None:
    match atom:
        case ast.Compare(left=left, ops=[ast.Eq()], comparators=[right]) if literal_of(right) is not UNSET:
            return key_of(left), literal_of(right)
    return None
