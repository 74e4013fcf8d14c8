"""The semantic description: what motion planning knows about the robot, group states among it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from graphlib import CycleError, TopologicalSorter
from operator import attrgetter
from typing import NamedTuple, TypeAlias, TypeVar

from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.srdf import (
    Chain,
    GroupState,
    JointProperty,
    PlanningGroup,
    SemanticRobotDescription,
)
from linkforge_compile.core.models.srdf_collisions import LinkSphereApproximation, SrdfSphere
from linkforge_compile.diagnostics.codes.model import (
    EMPTY_GROUP,
    PAIR_WITH_ITSELF,
    STATE_CYCLE,
    STATE_VALUE_TWICE,
    UNKNOWN_STATE,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP
from linkforge_compile.lower.elements import EXTRA_KEYS, extras_of, lower_children, lower_element, lower_fields
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.free_parts import is_absent
from linkforge_compile.lower.joint import position_type
from linkforge_compile.lower.numbers import LENGTH
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlScalar, is_null
from linkforge_compile.units import parse_quantity, unit_text

T = TypeVar("T")

_MEMBERS = ("chain", "chains", "links", "joints", "subgroups")
"""The keys of the members of a group."""


class LoweredSemantic(NamedTuple):
    """The semantic part of a file without its states, its states as written, and names of faulty groups and joints."""

    description: SemanticRobotDescription
    states: tuple[WrittenState, ...]
    faulty_names: frozenset[str]


def lower_semantic(file: Fields) -> LoweredSemantic | None:
    """Lower the semantic part of a file; checks find out whether the links, joints and groups that it names exist."""
    semantic = file.map("semantic")
    if semantic is None:
        return None
    _report_pairs_of_one_link(semantic)
    description = lower_element(
        SemanticRobotDescription,
        semantic,
        groups=[*lower_children(PlanningGroup, semantic, "groups", _lower_group)],
        group_states=(),
        link_sphere_approximations=[
            *lower_children(LinkSphereApproximation, semantic, "link_sphere_approximations", _lower_approximation)
        ],
        joint_properties=[*lower_children(JointProperty, semantic, "joint_properties", _lower_property)],
    )
    assert description is not None, "no field of it is required"
    names = {*semantic.node.section("groups"), *semantic.node.section("virtual_joints")}
    lowered = {*(group.name for group in description.groups), *(joint.name for joint in description.virtual_joints)}
    return LoweredSemantic(description, tuple(written_states(semantic)), frozenset(names - lowered))


def group_by_name(semantic: SemanticRobotDescription) -> SemanticRobotDescription:
    """Put the states of a group, the pairs of a first link, and the properties of a joint next to each other.

    A spec nests them under that name; a module may add to a name of the file that uses it. Names keep the order of
    their first mention.
    """
    return semantic.with_fields(
        group_states=_grouped(semantic.group_states, attrgetter("group")),
        disabled_collisions=_grouped(semantic.disabled_collisions, attrgetter("link1")),
        enabled_collisions=_grouped(semantic.enabled_collisions, attrgetter("link1")),
        joint_properties=_grouped(semantic.joint_properties, attrgetter("joint_name")),
    )


def _grouped(members: Iterable[T], name_of: Callable[[T], str]) -> tuple[T, ...]:
    by_name: dict[str, list[T]] = {}
    for member in members:
        by_name.setdefault(name_of(member), []).append(member)
    return tuple(member for group in by_name.values() for member in group)


def _lower_group(kind: type[PlanningGroup], fields: Fields, name: str) -> PlanningGroup | None:
    """Read a group; its `chain` may be a list, and `chains` a single one."""
    if not any(fields.items(key) for key in _MEMBERS):
        fields.report_incomplete(EMPTY_GROUP, group=name)
        return None
    chain_fields = [fields.map_at(node, "chain") for key in _MEMBERS[:2] for node in fields.items(key)]
    chains = [chain for each in chain_fields if each and (chain := lower_element(Chain, each))]
    values = lower_fields(kind, fields, name=name, chains=chains)
    if not (chains or values["links"] or values["joints"] or values["subgroups"]):
        return None  # all its members are faulty
    return lower_element(kind, fields, **values)


def _report_pairs_of_one_link(semantic: Fields) -> None:
    """Report pairs of a link with itself, which their class refuses."""
    for key in ("disabled_collisions", "enabled_collisions"):
        for first, entry in semantic.nested(key):
            if first.text == entry.name:
                semantic.report(PAIR_WITH_ITSELF, entry.key, link=entry.name)


def _lower_approximation(
    kind: type[LinkSphereApproximation], fields: Fields, link: str
) -> LinkSphereApproximation | None:
    items = [fields.map_at(node, "sphere") for node in fields.items("spheres")]
    return lower_element(kind, fields, link=link, spheres=[sphere for item in items if (sphere := _lower_sphere(item))])


def _lower_sphere(fields: Fields | None) -> SrdfSphere | None:
    """Read a sphere, whose `center` is three fields of its class."""
    if fields is None:
        return None
    center = fields.vector3("center", LENGTH, required="[0, 0, 0.1]")
    x, y, z = center or (None, None, None)
    return lower_element(SrdfSphere, fields, center_x=x, center_y=y, center_z=z)


def _lower_property(
    kind: type[JointProperty], fields: Fields, joint_name: str, property_name: str
) -> JointProperty | None:
    """Read a property of a joint; as in a free part, a written null is a text."""
    node = fields.node.entries.get("value")
    if node is None or is_absent(node.value):
        fields.get("value", required="true")
        return None
    value = fields.text_at(node.value, property_name)
    return lower_element(kind, fields, joint_name=joint_name, property_name=property_name, value=value)


StateKey: TypeAlias = tuple[str, str]
"""A group and the name of one of its states."""

Positions: TypeAlias = Mapping[str, object]
"""Positions by joint, each a tuple of one number [rad] or [m] for every degree of freedom."""


@dataclass(frozen=True)
class WrittenState:
    """A state as its file writes it: `values` are entries by joint, or by group with the name of a state.

    They are None for a faulty state.
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
    """What the states of a file may refer to: names of its own and, with their prefix, of its modules.

    `joints` are None for a faulty one. `states` are those of the modules; `unresolved` are names of what is faulty.
    """

    groups: Collection[str]
    joints: Mapping[str, Joint | None]
    states: Mapping[StateKey, Positions]
    unresolved: Container[str]


def written_states(semantic: Fields) -> Iterator[WrittenState]:
    """Yield the group states that a file writes."""
    for group, entry in semantic.nested("group_states"):
        owner = f"state '{entry.name}' of group '{group.text}'"
        node = YamlMap({}, entry.key.span) if is_null(entry.value) else entry.value
        if not isinstance(node, YamlMap):
            semantic.report_wrong_kind(node, owner, "a map of positions by joint")
            yield WrittenState(group.text, entry.name, semantic.arranged(owner, entry.key), None)
            continue
        values = tuple(value for value in node if value.name not in EXTRA_KEYS and node.get(value.name) is not None)
        extras = (value for value in node if value.name in EXTRA_KEYS)
        fields = semantic.arranged(owner, entry.key, *values, *extras, group=group)
        yield WrittenState(group.text, entry.name, fields, values)


def resolve_states(written: Sequence[WrittenState], scope: NamesInScope) -> list[GroupState]:
    """Return the states in the order written, without faulty ones; references are replaced by positions."""
    by_key = {state.key: state for state in written}
    positions: dict[StateKey, Positions | None] = {}
    for key in _in_order_of_use(by_key, scope):
        positions[key] = _positions(by_key[key], by_key, positions, scope)
    states = []
    for state in written:
        known = positions.get(state.key)
        if known is None:
            continue
        make = partial(GroupState, state.name, state.group, known, **extras_of(state.fields))
        if resolved := state.fields.build(make):
            states.append(resolved.with_source(state.fields.ref))
    return states


def _in_order_of_use(by_key: Mapping[StateKey, WrittenState], scope: NamesInScope) -> list[StateKey]:
    """Sort the states so that each comes after those that it refers to; report cycles and leave them out."""
    uses = {
        key: [other for entry in state.values or () if (other := _reference(entry, scope)) and other in by_key]
        for key, state in by_key.items()
    }
    in_cycles: set[StateKey] = set()
    while True:
        try:
            ordered = list(TopologicalSorter(uses).static_order())
        except CycleError as error:
            cycle: list[StateKey] = error.args[1][::-1]
            path = " → ".join("/".join(key) for key in cycle)
            first = by_key[cycle[0]].fields
            first.report(STATE_CYCLE, first.ref, path=path)
            in_cycles.update(cycle)
            uses.update((key, []) for key in cycle)
        else:
            return [key for key in ordered if key not in in_cycles]


def _positions(
    state: WrittenState,
    by_key: Collection[StateKey],
    resolved: Mapping[StateKey, Positions | None],
    scope: NamesInScope,
) -> Positions | None:
    """Return the positions of a state, None for a faulty one."""
    positions: dict[str, object] = {}
    is_faulty = state.values is None
    for entry in state.values or ():
        reference = _reference(entry, scope)
        if reference is None:
            added = _own_position(state.fields, entry, scope)
        elif reference in by_key:
            added = resolved.get(reference)
        else:
            added = scope.states.get(reference)
            if added is None:
                _report_unknown_state(state.fields, entry, reference, [*by_key, *scope.states], scope)
        for joint, position in (added or {}).items():
            if positions.setdefault(joint, position) != position:
                state.fields.report(STATE_VALUE_TWICE, entry.value, joint=joint, state=state.name, group=state.group)
        is_faulty |= added is None
    return None if is_faulty else positions


def _reference(entry: YamlEntry, scope: NamesInScope) -> StateKey | None:
    """Return the state that an entry refers to, None for a position: the key is a group, the value no quantity."""
    value = entry.value.value if isinstance(entry.value, YamlScalar) else None
    if isinstance(value, str) and entry.name in scope.groups and parse_quantity(value) is None:
        return entry.name, value
    return None


def _report_unknown_state(
    fields: Fields, entry: YamlEntry, reference: StateKey, known: Sequence[StateKey], scope: NamesInScope
) -> None:
    group, name = reference
    states = [f"'{state}'" for owner, state in known if owner == group]
    # A name with an expression that failed may be any that begins with the text before it.
    prefixes = tuple(state.partition("$(")[0] for owner, state in known if owner == group and "$(" in state)
    if name not in scope.unresolved and not (prefixes and name.startswith(prefixes)):
        fields.report(UNKNOWN_STATE, entry.value, group=group, name=name, states=", ".join(states) or "none")


def _own_position(fields: Fields, entry: YamlEntry, scope: NamesInScope) -> Positions | None:
    """Return the position that an entry gives to a joint, None for a faulty one."""
    node, field, accepted = entry.value, f"joint '{entry.name}'", position_type(scope.joints.get(entry.name))
    if isinstance(node, YamlList):
        numbers = [fields.number_at(item, field, accepted) for item in node]
        return None if None in numbers else {entry.name: tuple(numbers)}
    text = node.value if isinstance(node, YamlScalar) and isinstance(node.value, str) else None
    if text is not None and parse_quantity(text) is None and unit_text(text) is None:
        if entry.name in scope.unresolved:
            return None
        if entry.name not in scope.joints:
            fields.report(UNKNOWN_GROUP, entry.key, near=scope.groups, name=entry.name, hint="")
            return None
    number = fields.number_at(node, field, accepted)
    return None if number is None else {entry.name: (number,)}
