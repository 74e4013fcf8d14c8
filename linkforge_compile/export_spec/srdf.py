"""The semantic part as a spec writes it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TypeAlias

from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.named_table import NamedTable
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
from linkforge_compile.core.part import Element
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.joint import position_dimension
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension


def written_semantic(
    builder: SpecBuilder, semantic: SemanticRobotDescription, joints: NamedTable[Joint]
) -> YamlMap | None:
    """Return the semantic part of a robot with these joints, None where it says nothing.

    States of one group stand together, as pairs do of one first link and properties of one joint: where others
    came between them, that order is lost.
    """
    states = {(state.group, state.name): state for state in semantic.group_states}
    node = builder.element(
        semantic,
        virtual_joints=builder.named(
            "virtual joint", ((one.name, _virtual(builder, one)) for one in semantic.virtual_joints)
        ),
        groups=builder.named("planning group", ((group.name, _group(builder, group)) for group in semantic.groups)),
        group_states=builder.nested(
            "state",
            ((state.group, state.name, _state(builder, state, joints, states)) for state in semantic.group_states),
        ),
        end_effectors=builder.named(
            "end effector", ((one.name, _effector(builder, one)) for one in semantic.end_effectors)
        ),
        passive_joints=_passive(builder, semantic.passive_joints),
        disabled_collisions=_pairs(builder, semantic.disabled_collisions),
        enabled_collisions=_pairs(builder, semantic.enabled_collisions),
        no_default_collision_links=builder.texts(semantic.no_default_collision_links),
        joint_properties=builder.nested(
            "property", map(partial(_remark, builder), semantic.joint_properties), told_once=True
        ),
        link_sphere_approximations=builder.named(
            "sphere approximation", ((one.link, _spheres(builder, one)) for one in semantic.link_sphere_approximations)
        ),
    )
    return node if len(node) else None


def _passive(builder: SpecBuilder, joints: Sequence[PassiveJoint]) -> YamlNode | None:
    """Return a list of names, or a map where one of them has more to say."""
    if all(map(_says_no_more, joints)):
        return builder.texts([joint.name for joint in joints])
    return builder.named("passive joint", ((joint.name, builder.element(joint)) for joint in joints))


def _virtual(builder: SpecBuilder, joint: VirtualJoint) -> YamlMap:
    return builder.element(
        joint,
        type=builder.text(joint.type),
        parent_frame=builder.text(joint.parent_frame),
        child_link=builder.text(joint.child_link),
    )


def _group(builder: SpecBuilder, group: PlanningGroup) -> YamlMap:
    chains = [_chain(builder, chain) for chain in group.chains]
    return builder.element(
        group,
        chain=chains[0] if len(chains) == 1 else None,
        chains=builder.list_of(chains) if len(chains) > 1 else None,
        links=builder.texts(group.links),
        joints=builder.texts(group.joints),
        subgroups=builder.texts(group.subgroups),
    )


def _chain(builder: SpecBuilder, chain: Chain) -> YamlMap:
    return builder.element(chain, base_link=builder.text(chain.base_link), tip_link=builder.text(chain.tip_link))


_States: TypeAlias = Mapping[tuple[str, str], GroupState]
"""The states of a robot, by group and name."""


def _state(builder: SpecBuilder, state: GroupState, joints: NamedTable[Joint], states: _States) -> YamlMap:
    """Return the positions by joint: a number, or a list of them for several degrees of freedom."""
    positions = {}
    written = dict(_written_positions(state, states))
    for name, values in state.joint_values.items():
        joint = joints.get(name)
        unit = position_dimension(joint) if joint else None
        node: YamlNode = builder.quantity(values[0], unit) if len(values) == 1 else builder.numbers(values, unit)
        source, field = written.get(name, (state.source, name.removeprefix(_prefix_of(state))))
        positions[name] = builder.located(node, source, field)
    return builder.element(state, **positions)


_MOST_TAKEN_OVER = 100
"""How many states are looked into for where the positions of one were written: a chain of them has no end."""


def _written_positions(state: GroupState, states: _States) -> Iterator[tuple[str, tuple[SourceRef, str]]]:
    """Yield where each position was written and under which name: in the state, or in those that it takes over."""
    left, seen = [state], {(state.group, state.name)}
    while left:
        writer = left.pop()
        prefix = _prefix_of(writer)
        for entry in writer.source.node if writer.source and isinstance(writer.source.node, YamlMap) else ():
            text = entry.value.text if isinstance(entry.value, YamlScalar) else ""
            taken = (prefix + entry.name, prefix + text)
            if writer.source and prefix + entry.name in writer.joint_values:
                yield prefix + entry.name, (writer.source, entry.name)
            elif taken in states and taken not in seen and len(seen) < _MOST_TAKEN_OVER:
                seen.add(taken)
                left.append(states[taken])


def _prefix_of(state: GroupState) -> str:
    """Return the prefixes that the names of a state got since its file wrote them, which the group's has as well."""
    group = state.source.node.child("group") if state.source else None
    return state.group.removesuffix(group.text) if isinstance(group, YamlScalar) else ""


def _effector(builder: SpecBuilder, effector: EndEffector) -> YamlMap:
    return builder.element(
        effector,
        group=builder.text(effector.group),
        parent_link=builder.text(effector.parent_link),
        parent_group=builder.text(effector.parent_group),
    )


def _pairs(builder: SpecBuilder, pairs: Sequence[CollisionPair]) -> YamlMap | None:
    """Return the reasons by the first link and the second."""
    return builder.nested(
        "collision pair", ((one.link1, one.link2, _reason(builder, one)) for one in pairs), told_once=True
    )


def _reason(builder: SpecBuilder, pair: CollisionPair) -> YamlNode:
    if _says_no_more(pair):
        return builder.located(builder.word(pair.reason), pair.source, "reason")
    return builder.element(pair, reason=builder.text(pair.reason))


def _says_no_more(part: Element) -> bool:
    """Whether a part has nothing to say beside its fields, so that its short form will do."""
    return not (part.extra_elements or part.extra_attributes or part.extra_inside)


def _remark(builder: SpecBuilder, remark: JointProperty) -> tuple[str, str, YamlNode]:
    value = builder.located(builder.free(remark.value), remark.source, "value")
    return (
        remark.joint_name,
        remark.property_name,
        value if _says_no_more(remark) else builder.element(remark, value=value),
    )


def _spheres(builder: SpecBuilder, approximation: LinkSphereApproximation) -> YamlNode:
    spheres = builder.list_of(_sphere(builder, sphere) for sphere in approximation.spheres)
    if _says_no_more(approximation):
        return builder.located(spheres, approximation.source, "spheres")
    return builder.element(approximation, spheres=spheres)


def _sphere(builder: SpecBuilder, sphere: SrdfSphere) -> YamlMap:
    center = (sphere.center_x, sphere.center_y, sphere.center_z)
    return builder.element(
        sphere, center=builder.numbers(center, Dimension.LENGTH), radius=builder.number(sphere.radius, Dimension.LENGTH)
    )
