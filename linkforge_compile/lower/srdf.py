"""The semantic description: what motion planning knows about the robot. Group states are lowered by group_states."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import NamedTuple, TypeVar

from linkforge_compile.core.fields import NOT_NEGATIVE
from linkforge_compile.core.models.srdf import (
    Chain,
    CollisionPair,
    EndEffector,
    JointProperty,
    LinkSphereApproximation,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    SrdfSphere,
    VirtualJoint,
)
from linkforge_compile.diagnostics.codes.model import EMPTY_GROUP, PAIR_WITH_ITSELF
from linkforge_compile.lower.elements import lower_each, lower_element
from linkforge_compile.lower.extra import common_kwargs, is_absent
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.group_states import WrittenState, written_states
from linkforge_compile.lower.numbers import LENGTH, NumberType
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlNode
from linkforge_compile.units import Dimension

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
        **common_kwargs(semantic),
    )
    faulty = [name for name, part in (*groups.items(), *virtual_joints.items()) if part is None]
    return LoweredSemantic(description, tuple(written_states(semantic)), frozenset(faulty))


def group_by_name(semantic: SemanticRobotDescription) -> SemanticRobotDescription:
    """Put the states of a group, the pairs of a first link, and the properties of a joint next to each other.

    A spec nests them under that name; a module may add to a name of the file that uses it. Names keep the order of
    their first mention.
    """
    return replace(
        semantic,
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
    return fields.build(lambda: PlanningGroup(name, links, joints, chains, subgroups, **common_kwargs(fields)))


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
        elif joint := item.build(partial(PassiveJoint, name, source=item.ref)):
            first[name] = item.ref
            yield joint


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
    return sphere.build(lambda: SrdfSphere(center.x, center.y, center.z, radius, **common_kwargs(sphere)))


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
