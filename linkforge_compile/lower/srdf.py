"""The semantic part: what planners know beyond the tree. Group states are resolved in srdf_states."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from functools import partial
from typing import NamedTuple

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
from linkforge_compile.lower.extra import common_kwargs, is_absent
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import LENGTH, NumberType
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.lower.srdf_states import WrittenState, written_states
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlNode
from linkforge_compile.units import Dimension

_RADIUS = NumberType((Dimension.LENGTH,), NOT_NEGATIVE)


class Semantic(NamedTuple):
    """A file's semantic part without its states, and its states as written.

    `lost` are the names of its groups and virtual joints that are faulty.
    """

    description: SemanticRobotDescription
    states: tuple[WrittenState, ...]
    lost: frozenset[str]


class _VirtualJointType(StrEnum):
    FIXED = "fixed"
    PLANAR = "planar"
    FLOATING = "floating"


def lower_semantic(file: Fields) -> Semantic | None:
    """Lower a file's semantic part; whether the links, joints and groups that it names exist is not judged."""
    semantic = file.map("semantic")
    if semantic is None:
        return None
    groups = dict(semantic.each("groups", "group", _group))
    effectors = dict(semantic.each("end_effectors", "end effector", _end_effector))
    virtual_joints = dict(semantic.each("virtual_joints", "virtual joint", _virtual_joint))
    description = SemanticRobotDescription(
        virtual_joints=[joint for joint in virtual_joints.values() if joint],
        groups=[group for group in groups.values() if group],
        end_effectors=[effector for effector in effectors.values() if effector],
        passive_joints=tuple(_passive_joints(semantic)),
        disabled_collisions=tuple(_collision_pairs(semantic, "disabled_collisions")),
        enabled_collisions=tuple(_collision_pairs(semantic, "enabled_collisions")),
        no_default_collision_links=semantic.names("no_default_collision_links"),
        link_sphere_approximations=tuple(_sphere_approximations(semantic)),
        joint_properties=tuple(_joint_properties(semantic)),
        **common_kwargs(semantic),
    )
    named = (*groups.items(), *virtual_joints.items())
    lost = frozenset(name for name, part in named if part is None)
    return Semantic(description, tuple(written_states(semantic)), lost)


def _virtual_joint(fields: Fields, name: str) -> VirtualJoint | None:
    joint_type = fields.choice("type", _VirtualJointType, required="fixed")
    parent_frame = fields.text("parent_frame", required="world")
    child_link = fields.text("child_link", required="base")
    if joint_type is None or parent_frame is None or child_link is None:
        return None
    return fields.build(lambda: VirtualJoint(name, joint_type.value, parent_frame, child_link, **common_kwargs(fields)))


def _group(fields: Fields, name: str) -> PlanningGroup | None:
    chains = [_chain(fields, node) for key in ("chain", "chains") for node in fields.items(key)]
    links, joints, subgroups = fields.names("links"), fields.names("joints"), fields.names("subgroups")
    if not any(fields.items(key) for key in ("chain", "chains", "links", "joints", "subgroups")):
        fields.report_incomplete(EMPTY_GROUP, group=name)
        return None
    whole = [chain for chain in chains if chain]
    if not (whole or links or joints or subgroups):
        return None  # all its members are faulty and told
    return fields.build(lambda: PlanningGroup(name, links, joints, whole, subgroups, **common_kwargs(fields)))


def _chain(group: Fields, node: YamlNode) -> Chain | None:
    chain = group.map_at(node, "chain")
    if chain is None:
        return None
    base, tip = chain.text("base_link", required="base"), chain.text("tip_link", required="tool0")
    if base is None or tip is None:
        return None
    return chain.build(lambda: Chain(base, tip, **common_kwargs(chain)))


def _end_effector(fields: Fields, name: str) -> EndEffector | None:
    group, parent_link = fields.text("group", required="gripper"), fields.text("parent_link", required="tool0")
    parent_group = fields.text("parent_group")
    if group is None or parent_link is None:
        return None
    return fields.build(lambda: EndEffector(name, group, parent_link, parent_group, **common_kwargs(fields)))


def _passive_joints(semantic: Fields) -> Iterator[PassiveJoint]:
    first: dict[str, SourceRef] = {}
    if isinstance(semantic.node.get("passive_joints"), YamlMap):
        named = dict(semantic.each("passive_joints", "passive joint", _passive_joint))
        yield from (joint for joint in named.values() if joint)
        return
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


def _passive_joint(fields: Fields, name: str) -> PassiveJoint | None:
    return fields.build(lambda: PassiveJoint(name, **common_kwargs(fields)))


def _collision_pairs(semantic: Fields, key: str) -> Iterator[CollisionPair]:
    for first, entry in semantic.nested(key):
        if first.text == entry.name:
            semantic.report(PAIR_WITH_ITSELF, entry.key, link=entry.name)
            continue
        item = _long(semantic, "collision pair", entry, "reason", link1=first, link2=entry.key)
        make = partial(CollisionPair, first.text, entry.name, item.text("reason"), **common_kwargs(item))
        if pair := item.build(make):
            yield pair


def _sphere_approximations(semantic: Fields) -> Iterator[LinkSphereApproximation]:
    section = semantic.map("link_sphere_approximations")
    for entry in section.node if section else ():
        item = _long(semantic, f"sphere approximation of link '{entry.name}'", entry, "spheres", link=entry.key)
        spheres = [_sphere(item, node) for node in item.items("spheres")]
        whole = [sphere for sphere in spheres if sphere]
        make = partial(LinkSphereApproximation, entry.name, whole, **common_kwargs(item))
        if approximation := item.build(make):
            yield approximation


def _long(semantic: Fields, owner: str, entry: YamlEntry, short: str, **ends: YamlNode) -> Fields:
    """Return an entry in its long form, with the names that it stands under as fields."""
    said = entry.value
    if isinstance(said, YamlMap):
        return semantic.arranged(owner, entry.key, *said, **ends)
    return semantic.arranged(owner, entry.key, **ends, **{short: said})


def _sphere(approximation: Fields, node: YamlNode) -> SrdfSphere | None:
    sphere = approximation.map_at(node, "sphere")
    if sphere is None:
        return None
    center = sphere.vector3("center", LENGTH, required="[0, 0, 0.1]")
    radius = sphere.number("radius", _RADIUS, required="0.1")
    if center is None or radius is None:
        return None
    return sphere.build(lambda: SrdfSphere(center.x, center.y, center.z, radius, **common_kwargs(sphere)))


def _joint_properties(semantic: Fields) -> Iterator[JointProperty]:
    for joint, entry in semantic.nested("joint_properties"):
        owner = f"property '{entry.name}' of joint '{joint.text}'"
        item = _long(semantic, owner, entry, "value", joint_name=joint, property_name=entry.key)
        said = item.node.entries.get("value")
        # A free part: a null that was written is text, and only what nobody wrote is none.
        if said is None or is_absent(said.value):
            if isinstance(entry.value, YamlMap):
                item.get("value", "true")
            continue
        value = item.text_at(said.value, entry.name)
        if value is None:
            continue
        make = partial(JointProperty, joint.text, entry.name, value, **common_kwargs(item))
        if remark := item.build(make):
            yield remark
