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
from linkforge_compile.export_spec.joint import position_dimension
from linkforge_compile.export_spec.pen import Pen
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension


def written_semantic(pen: Pen, semantic: SemanticRobotDescription, joints: NamedTable[Joint]) -> YamlMap | None:
    """Return the semantic part of a robot with these joints, None where it says nothing.

    States of one group stand together, as pairs do of one first link and properties of one joint: where others
    came between them, that order is lost.
    """
    states = {(state.group, state.name): state for state in semantic.group_states}
    node = pen.element(
        semantic,
        virtual_joints=pen.named("virtual joint", ((one.name, _virtual(pen, one)) for one in semantic.virtual_joints)),
        groups=pen.named("planning group", ((group.name, _group(pen, group)) for group in semantic.groups)),
        group_states=pen.nested(
            "state", ((state.group, state.name, _state(pen, state, joints, states)) for state in semantic.group_states)
        ),
        end_effectors=pen.named("end effector", ((one.name, _effector(pen, one)) for one in semantic.end_effectors)),
        passive_joints=_passive(pen, semantic.passive_joints),
        disabled_collisions=_pairs(pen, semantic.disabled_collisions),
        enabled_collisions=_pairs(pen, semantic.enabled_collisions),
        no_default_collision_links=pen.texts(semantic.no_default_collision_links),
        joint_properties=pen.nested("property", map(partial(_remark, pen), semantic.joint_properties), told_once=True),
        link_sphere_approximations=pen.named(
            "sphere approximation", ((one.link, _spheres(pen, one)) for one in semantic.link_sphere_approximations)
        ),
    )
    return node if len(node) else None


def _passive(pen: Pen, joints: Sequence[PassiveJoint]) -> YamlNode | None:
    """Return a list of names, or a map where one of them has more to say."""
    if all(map(_says_no_more, joints)):
        return pen.texts([joint.name for joint in joints])
    return pen.named("passive joint", ((joint.name, pen.element(joint)) for joint in joints))


def _virtual(pen: Pen, joint: VirtualJoint) -> YamlMap:
    return pen.element(
        joint,
        type=pen.text(joint.type),
        parent_frame=pen.text(joint.parent_frame),
        child_link=pen.text(joint.child_link),
    )


def _group(pen: Pen, group: PlanningGroup) -> YamlMap:
    chains = [_chain(pen, chain) for chain in group.chains]
    return pen.element(
        group,
        chain=chains[0] if len(chains) == 1 else None,
        chains=pen.list_of(chains) if len(chains) > 1 else None,
        links=pen.texts(group.links),
        joints=pen.texts(group.joints),
        subgroups=pen.texts(group.subgroups),
    )


def _chain(pen: Pen, chain: Chain) -> YamlMap:
    return pen.element(chain, base_link=pen.text(chain.base_link), tip_link=pen.text(chain.tip_link))


_States: TypeAlias = Mapping[tuple[str, str], GroupState]
"""The states of a robot, by group and name."""


def _state(pen: Pen, state: GroupState, joints: NamedTable[Joint], states: _States) -> YamlMap:
    """Return the positions by joint: a number, or a list of them for several degrees of freedom."""
    positions = {}
    written = dict(_written_positions(state, states))
    for name, values in state.joint_values.items():
        joint = joints.get(name)
        unit = position_dimension(joint) if joint else None
        node: YamlNode = pen.quantity(values[0], unit) if len(values) == 1 else pen.numbers(values, unit)
        source, field = written.get(name, (state.source, name.removeprefix(_prefix_of(state))))
        positions[name] = pen.located(node, source, field)
    return pen.element(state, **positions)


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


def _effector(pen: Pen, effector: EndEffector) -> YamlMap:
    return pen.element(
        effector,
        group=pen.text(effector.group),
        parent_link=pen.text(effector.parent_link),
        parent_group=pen.text(effector.parent_group),
    )


def _pairs(pen: Pen, pairs: Sequence[CollisionPair]) -> YamlMap | None:
    """Return the reasons by the first link and the second."""
    return pen.nested("collision pair", ((one.link1, one.link2, _reason(pen, one)) for one in pairs), told_once=True)


def _reason(pen: Pen, pair: CollisionPair) -> YamlNode:
    if _says_no_more(pair):
        return pen.located(pen.word(pair.reason), pair.source, "reason")
    return pen.element(pair, reason=pen.text(pair.reason))


def _says_no_more(part: Element) -> bool:
    """Whether a part has nothing to say beside its fields, so that its short form will do."""
    return not (part.extra_elements or part.extra_attributes or part.extra_inside)


def _remark(pen: Pen, remark: JointProperty) -> tuple[str, str, YamlNode]:
    value = pen.located(pen.free(remark.value), remark.source, "value")
    return remark.joint_name, remark.property_name, value if _says_no_more(remark) else pen.element(remark, value=value)


def _spheres(pen: Pen, approximation: LinkSphereApproximation) -> YamlNode:
    spheres = pen.list_of(_sphere(pen, sphere) for sphere in approximation.spheres)
    if _says_no_more(approximation):
        return pen.located(spheres, approximation.source, "spheres")
    return pen.element(approximation, spheres=spheres)


def _sphere(pen: Pen, sphere: SrdfSphere) -> YamlMap:
    center = (sphere.center_x, sphere.center_y, sphere.center_z)
    return pen.element(
        sphere, center=pen.numbers(center, Dimension.LENGTH), radius=pen.number(sphere.radius, Dimension.LENGTH)
    )
