"""The semantic description: what motion planning knows about the robot, group states among it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from graphlib import CycleError, TopologicalSorter
from operator import attrgetter
from typing import NamedTuple, TypeAlias, TypeVar

from linkforge_compile.core.fields import NOT_NEGATIVE
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.srdf import (
    Chain,
    CollisionPair,
    EndEffector,
    GroupState,
    JointProperty,
    LinkSphereApproximation,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    SrdfSphere,
    VirtualJoint,
)
from linkforge_compile.diagnostics.codes.model import (
    EMPTY_GROUP,
    PAIR_WITH_ITSELF,
    STATE_CYCLE,
    STATE_VALUE_TWICE,
    UNKNOWN_STATE,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP
from linkforge_compile.lower.elements import EXTRA_KEYS, extras_of, is_absent, lower_each, lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import position_type
from linkforge_compile.lower.numbers import LENGTH, NumberType
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.units import Dimension, parse_quantity, unit_text

T = TypeVar("T")

_RADIUS = NumberType((Dimension.LENGTH,), NOT_NEGATIVE)


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
    groups = dict(semantic.each("groups", "group", _lower_group))
    effectors = lower_each(EndEffector, semantic, "end_effectors", "end effector")
    virtual_joints = lower_each(VirtualJoint, semantic, "virtual_joints", "virtual joint")
    description = SemanticRobotDescription(
        virtual_joints=[joint for joint in virtual_joints.values() if joint],
        groups=[group for group in groups.values() if group],
        end_effectors=[effector for effector in effectors.values() if effector],
        passive_joints=tuple(_lower_passive_joints(semantic)),
        disabled_collisions=tuple(_lower_collision_pairs(semantic, "disabled_collisions")),
        enabled_collisions=tuple(_lower_collision_pairs(semantic, "enabled_collisions")),
        no_default_collision_links=semantic.names("no_default_collision_links"),
        link_sphere_approximations=tuple(_lower_sphere_approximations(semantic)),
        joint_properties=tuple(_lower_joint_properties(semantic)),
        **extras_of(semantic),
    ).with_source(semantic.ref)
    faulty = [name for name, part in (*groups.items(), *virtual_joints.items()) if part is None]
    return LoweredSemantic(description, tuple(written_states(semantic)), frozenset(faulty))


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


def _lower_group(fields: Fields, name: str) -> PlanningGroup | None:
    keys = ("chain", "chains", "links", "joints", "subgroups")
    chain_fields = [fields.map_at(node, "chain") for key in keys[:2] for node in fields.items(key)]
    chains = [chain for each in chain_fields if each and (chain := lower_element(Chain, each))]
    links, joints, subgroups = fields.names("links"), fields.names("joints"), fields.names("subgroups")
    if not any(fields.items(key) for key in keys):
        fields.report_incomplete(EMPTY_GROUP, group=name)
        return None
    if not (chains or links or joints or subgroups):
        return None  # all its members are faulty
    members = (links, joints, chains, subgroups)
    return fields.build(lambda: PlanningGroup(name, *members, **extras_of(fields)).with_source(fields.ref))


def _lower_passive_joints(semantic: Fields) -> Iterator[PassiveJoint]:
    """Lower passive joints: a map by their names, or a list of names."""
    if isinstance(semantic.node.get("passive_joints"), YamlMap):
        named = lower_each(PassiveJoint, semantic, "passive_joints", "passive joint")
        yield from (joint for joint in named.values() if joint)
        return
    first: dict[str, SourceRef] = {}
    for node in semantic.items("passive_joints"):
        name = semantic.text_at(node, "passive_joints")
        item = semantic.arranged("passive_joints", node, name=node)
        if name is None:
            continue
        if name in first:
            report_duplicate(semantic.sink, "passive joint", name, item.ref, first[name])
        elif joint := item.build(partial(PassiveJoint, name)):
            first[name] = item.ref
            yield joint.with_source(item.ref)


def _lower_collision_pairs(semantic: Fields, key: str) -> Iterator[CollisionPair]:
    for first, entry in semantic.nested(key):
        if first.text == entry.name:
            semantic.report(PAIR_WITH_ITSELF, entry.key, link=entry.name)
            continue
        item = _long_form(semantic, "collision pair", entry, "reason", link1=first, link2=entry.key)
        if pair := lower_element(CollisionPair, item, link1=first.text, link2=entry.name):
            yield pair


def _lower_sphere_approximations(semantic: Fields) -> Iterator[LinkSphereApproximation]:
    section = semantic.map("link_sphere_approximations")
    for entry in section.node if section else ():
        item = _long_form(semantic, f"sphere approximation of link '{entry.name}'", entry, "spheres", link=entry.key)
        spheres = [sphere for node in item.items("spheres") if (sphere := _lower_sphere(item, node))]
        if approximation := lower_element(LinkSphereApproximation, item, link=entry.name, spheres=spheres):
            yield approximation


def _lower_sphere(approximation: Fields, node: YamlNode) -> SrdfSphere | None:
    sphere = approximation.map_at(node, "sphere")
    if sphere is None:
        return None
    center = sphere.vector3("center", LENGTH, required="[0, 0, 0.1]")
    radius = sphere.number("radius", _RADIUS, required="0.1")
    if center is None or radius is None:
        return None
    return sphere.build(
        lambda: SrdfSphere(center.x, center.y, center.z, radius, **extras_of(sphere)).with_source(sphere.ref)
    )


def _lower_joint_properties(semantic: Fields) -> Iterator[JointProperty]:
    for joint, entry in semantic.nested("joint_properties"):
        owner = f"property '{entry.name}' of joint '{joint.text}'"
        item = _long_form(semantic, owner, entry, "value", joint_name=joint, property_name=entry.key)
        value = item.node.entries.get("value")
        # As in a free part, a written null is a text.
        if value is None or is_absent(value.value):
            if isinstance(entry.value, YamlMap):
                item.get("value", required="true")
            continue
        text = item.text_at(value.value, entry.name)
        lowered = lower_element(JointProperty, item, joint_name=joint.text, property_name=entry.name, value=text)
        if lowered:
            yield lowered


def _long_form(semantic: Fields, owner: str, entry: YamlEntry, short_key: str, **ends: YamlNode) -> Fields:
    """Return an entry as a map that has the names around it as fields, and a value that is no map at `short_key`."""
    if isinstance(entry.value, YamlMap):
        return semantic.arranged(owner, entry.key, *entry.value, **ends)
    return semantic.arranged(owner, entry.key, **ends, **{short_key: entry.value})


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
