"""Write the semantic part of a robot, with the short forms of its sections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.core.fields import Children, field_specs
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.named_table import NamedTable
from linkforge_compile.core.models.srdf import (
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
)
from linkforge_compile.core.models.srdf_collisions import LinkSphereApproximation, SrdfSphere
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_children, export_element, export_fields
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import POSITION, Dimension

_States: TypeAlias = Mapping[tuple[str, str], GroupState]
"""The states of a robot, by group and name."""

_MAX_INHERITED = 100
"""Number of states to search for where the positions of one were written; inheritance may be endless."""


def export_semantic(
    builder: SpecBuilder, semantic: SemanticRobotDescription, joints: NamedTable[Joint]
) -> YamlMap | None:
    """Return the semantic part of a robot with these joints, None where it is empty.

    The states of a group are written together, as are the pairs of a first link and the properties of a joint.
    """
    states = {(state.group, state.name): state for state in semantic.group_states}
    positions = ((one.group, one.name, _state(builder, one, joints, states)) for one in semantic.group_states)
    by_hand = {
        "groups": export_children(builder, semantic.groups, _group),
        "group_states": builder.nested("state", positions),
        "passive_joints": _passive_joints(builder, semantic.passive_joints),
        "joint_properties": export_children(builder, semantic.joint_properties, _property),
        "link_sphere_approximations": export_children(builder, semantic.link_sphere_approximations, _spheres),
    }
    others = {
        spec.key or name: export_children(builder, getattr(semantic, name))
        for name, spec in field_specs(SemanticRobotDescription).items()
        if isinstance(spec, Children) and spec.key not in by_hand
    }
    node = export_element(builder, semantic, **by_hand, **others)
    return node if len(node) else None


def _passive_joints(builder: SpecBuilder, joints: Sequence[PassiveJoint]) -> YamlNode | None:
    """Return a list of names, or a map where one of them has more."""
    if any(len(export_element(builder, joint)) for joint in joints):
        return export_children(builder, joints)
    return builder.texts([joint.name for joint in joints])


def _group(builder: SpecBuilder, group: PlanningGroup) -> YamlMap:
    chains = [export_element(builder, chain) for chain in group.chains]
    return builder.element(
        group,
        chain=chains[0] if len(chains) == 1 else None,
        chains=builder.list_of(chains) if len(chains) > 1 else None,
        **export_fields(builder, group, without=("chains",)),
    )


def _state(builder: SpecBuilder, state: GroupState, joints: NamedTable[Joint], states: _States) -> YamlMap:
    """Return the positions by joint: a number, or a list for several degrees of freedom."""
    positions = {}
    sources = dict(_position_sources(state, states))
    for name, values in state.joint_values.items():
        joint = joints.get(name)
        unit = POSITION.dimension(joint.type.motion) if joint else None
        node: YamlNode = builder.quantity(values[0], unit) if len(values) == 1 else builder.numbers(values, unit)
        source, field = sources.get(name, (state.source, name.removeprefix(_prefix_of(state))))
        positions[name] = builder.located(node, source, field)
    return builder.element(state, **positions)


def _position_sources(state: GroupState, states: _States) -> Iterator[tuple[str, tuple[SourceRef, str]]]:
    """Yield the object and key in which each position was written: in the state, or in one that it inherits from."""
    stack, seen = [state], {(state.group, state.name)}
    while stack:
        writer = stack.pop()
        prefix = _prefix_of(writer)
        for entry in writer.source.node if writer.source and isinstance(writer.source.node, YamlMap) else ():
            text = entry.value.text if isinstance(entry.value, YamlScalar) else ""
            inherited = (prefix + entry.name, prefix + text)
            if writer.source and prefix + entry.name in writer.joint_values:
                yield prefix + entry.name, (writer.source, entry.name)
            elif inherited in states and inherited not in seen and len(seen) < _MAX_INHERITED:
                seen.add(inherited)
                stack.append(states[inherited])


def _prefix_of(state: GroupState) -> str:
    """Return the prefix that the names of a state got since its file was written, as the name of its group did."""
    group = state.source.node.child("group") if state.source else None
    return state.group.removesuffix(group.text) if isinstance(group, YamlScalar) else ""


def _property(builder: SpecBuilder, one: JointProperty) -> YamlMap:
    return export_element(builder, one, value=builder.free(one.value))


def _spheres(builder: SpecBuilder, approximation: LinkSphereApproximation) -> YamlMap:
    spheres = builder.list_of(_sphere(builder, sphere) for sphere in approximation.spheres)
    return export_element(builder, approximation, spheres=spheres)


def _sphere(builder: SpecBuilder, sphere: SrdfSphere) -> YamlMap:
    """Return a sphere, whose `center` is three fields of its class."""
    center = builder.numbers((sphere.center_x, sphere.center_y, sphere.center_z), Dimension.LENGTH)
    return export_element(builder, sphere, center=center)
