"""Group states: positions by joint, some of them taken over from the states of other groups."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from graphlib import CycleError, TopologicalSorter
from typing import TypeAlias

from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics.codes.model import STATE_CIRCLE, STATE_VALUE_TWICE, UNKNOWN_STATE
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP
from linkforge_compile.lower.extra import EXTRA_KEYS, common_kwargs
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import NumberType
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlScalar, is_null
from linkforge_compile.units import parse_quantity, unit_text

StateKey: TypeAlias = tuple[str, str]
"""A group and the name of one of its states."""

Positions: TypeAlias = Mapping[str, object]
"""Positions by joint, each a tuple of one number [rad] or [m] for every degree of freedom."""


@dataclass(frozen=True)
class WrittenState:
    """A state as its file writes it: `values` are entries by joint, or by group with the name of a state.

    None for a state whose fault has been told.
    """

    group: str
    name: str
    fields: Fields
    values: tuple[YamlEntry, ...] | None

    @property
    def key(self) -> StateKey:
        return self.group, self.name


@dataclass(frozen=True)
class NamesInScope:
    """What a file's states may refer to: names of its own and, with their prefix, of its modules.

    `kind` says what a position of the joint of a name is measured in. `states` are those of the modules;
    `lost` is what is missing because it was faulty.
    """

    groups: Collection[str]
    joints: Container[str]
    position_type: Callable[[str], NumberType]
    states: Mapping[StateKey, Positions]
    unresolved: Container[str]


def written_states(semantic: Fields) -> Iterator[WrittenState]:
    """Yield the group states that a file writes."""
    for group, entry in semantic.nested("group_states"):
        owner = f"state '{entry.name}' of group '{group.text}'"
        values = entry.value
        if is_null(values):
            values = YamlMap({}, entry.key.span)
        if not isinstance(values, YamlMap):
            semantic.report_wrong_kind(values, owner, "a map of positions by joint")
            yield WrittenState(group.text, entry.name, semantic.arranged(owner, entry.key), None)
            continue
        said = tuple(value for value in values if value.name not in EXTRA_KEYS and values.get(value.name) is not None)
        raw = (value for value in values if value.name in EXTRA_KEYS)
        yield WrittenState(group.text, entry.name, semantic.arranged(owner, entry.key, *said, *raw, group=group), said)


def resolve_states(written: Sequence[WrittenState], scope: NamesInScope) -> list[GroupState]:
    """Return the states in the order written, with positions for joints only, without those that have a fault."""
    by_key = {state.key: state for state in written}
    positions: dict[StateKey, Positions | None] = {}
    for key in _in_order_of_use(by_key, scope):
        positions[key] = _positions(by_key[key], by_key, positions, scope)
    states = []
    for state in written:
        known = positions.get(state.key)
        if known is None:
            continue
        make = partial(GroupState, state.name, state.group, known, **common_kwargs(state.fields))
        if built := state.fields.build(make):
            states.append(built)
    return states


def _in_order_of_use(by_key: Mapping[StateKey, WrittenState], scope: NamesInScope) -> list[StateKey]:
    """Return the states so that each comes after those that it refers to; a circle is told and left out."""
    uses = {
        key: [used for entry in state.values or () if (used := _reference(entry, scope)) and used in by_key]
        for key, state in by_key.items()
    }
    circling: set[StateKey] = set()
    while True:
        try:
            ordered = list(TopologicalSorter(uses).static_order())
        except CycleError as error:
            circle: list[StateKey] = error.args[1][::-1]
            path = " → ".join("/".join(key) for key in circle)
            first = by_key[circle[0]].fields
            first.report(STATE_CIRCLE, first.ref, path=path)
            circling.update(circle)
            uses.update((key, []) for key in circle)
        else:
            return [key for key in ordered if key not in circling]


def _positions(
    state: WrittenState,
    by_key: Collection[StateKey],
    resolved: Mapping[StateKey, Positions | None],
    scope: NamesInScope,
) -> Positions | None:
    positions: dict[str, object] = {}
    faulty = state.values is None
    for entry in state.values or ():
        used = _reference(entry, scope)
        if used is None:
            said = _own_position(state.fields, entry, scope)
        elif used in by_key:
            said = resolved.get(used)
        else:
            said = scope.states.get(used)
            if said is None:
                _report_unknown_state(state.fields, entry, used, [*by_key, *scope.states], scope)
        for joint, position in (said or {}).items():
            if positions.setdefault(joint, position) != position:
                state.fields.report(STATE_VALUE_TWICE, entry.value, joint=joint, state=state.name, group=state.group)
        faulty |= said is None
    return None if faulty else positions


def _reference(entry: YamlEntry, scope: NamesInScope) -> StateKey | None:
    """Return the state that an entry names: its key a group, its value text that is no quantity."""
    value = entry.value.value if isinstance(entry.value, YamlScalar) else None
    if isinstance(value, str) and entry.name in scope.groups and parse_quantity(value) is None:
        return entry.name, value
    return None


def _report_unknown_state(
    fields: Fields, entry: YamlEntry, used: StateKey, known: Sequence[StateKey], scope: NamesInScope
) -> None:
    group, name = used
    states = [f"'{state}'" for owner, state in known if owner == group]
    # One with a fault in its `for` may be any that begins as its name does.
    begun = tuple(state.partition("$(")[0] for owner, state in known if owner == group and "$(" in state)
    if name not in scope.unresolved and not (begun and name.startswith(begun)):
        fields.report(UNKNOWN_STATE, entry.value, group=group, name=name, states=", ".join(states) or "none")


def _own_position(fields: Fields, entry: YamlEntry, scope: NamesInScope) -> Positions | None:
    node, field, kind = entry.value, f"joint '{entry.name}'", scope.position_type(entry.name)
    if isinstance(node, YamlList):
        numbers = [fields.number_at(item, field, kind) for item in node]
        return None if None in numbers else {entry.name: tuple(numbers)}
    text = node.value if isinstance(node, YamlScalar) and isinstance(node.value, str) else None
    if text is not None and parse_quantity(text) is None and unit_text(text) is None:
        if entry.name in scope.unresolved:
            return None
        if entry.name not in scope.joints:
            fields.report(UNKNOWN_GROUP, entry.key, near=scope.groups, name=entry.name, hint="")
            return None
    number = fields.number_at(node, field, kind)
    return None if number is None else {entry.name: (number,)}
