"""The semantic part of a robot as the templates of SRDF take it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.formats.element import attributes, elements, leaf
from linkforge_compile.formats.marks import mark
from linkforge_compile.formats.markup import Xml, placed, spelled

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linkforge_compile.core.models.collision_rules import LinkSphereApproximation
    from linkforge_compile.core.models.planning import GroupState, PlanningGroup
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.part import Element


class GroupView(NamedTuple):
    """`<group>`; members are names, chains elements."""

    attributes: Xml
    links: Sequence[str]
    joints: Sequence[str]
    chains: tuple[Xml, ...]
    subgroups: Sequence[str]
    elements: Xml


class StateView(NamedTuple):
    """`<group_state>`; `joints` are names and their positions as one text."""

    attributes: Xml
    joints: tuple[tuple[str, str], ...]
    elements: Xml


class SpheresView(NamedTuple):
    """`<link_sphere_approximation>`."""

    attributes: Xml
    spheres: tuple[Xml, ...]
    elements: Xml


class SemanticView(NamedTuple):
    """`<robot>` of an SRDF; what has fields for attributes only is an element already."""

    attributes: Xml
    groups: tuple[GroupView, ...]
    group_states: tuple[StateView, ...]
    end_effectors: tuple[Xml, ...]
    virtual_joints: tuple[Xml, ...]
    passive_joints: tuple[Xml, ...]
    joint_properties: tuple[Xml, ...]
    link_sphere_approximations: tuple[SpheresView, ...]
    no_default_collision_links: Sequence[str]
    enabled_collisions: tuple[Xml, ...]
    disabled_collisions: tuple[Xml, ...]
    elements: Xml


def semantic_view(robot: Robot) -> SemanticView:
    """Return what a robot says semantically, every string ready for its place."""
    semantic = robot.semantic
    return SemanticView(
        Xml(mark(robot.source, "name") + attributes(semantic, name=semantic.robot_name or robot.name)),
        tuple(map(_group, semantic.groups)),
        tuple(map(_group_state, semantic.group_states)),
        _leaves("end_effector", semantic.end_effectors, "name", "parent_link", "group", "parent_group"),
        _leaves("virtual_joint", semantic.virtual_joints, "name", "type", "parent_frame", "child_link"),
        _leaves("passive_joint", semantic.passive_joints, "name"),
        _leaves("joint_property", semantic.joint_properties, "joint_name", "property_name", "value"),
        tuple(map(_spheres, semantic.link_sphere_approximations)),
        _without_collisions(robot),
        _leaves("enable_collisions", semantic.enabled_collisions, "link1", "link2", "reason"),
        _leaves("disable_collisions", semantic.disabled_collisions, "link1", "link2", "reason"),
        elements(semantic),
    )


def _leaves(tag: str, parts: Iterable[Element], *fields: str) -> tuple[Xml, ...]:
    """Return elements whose attributes are these fields, in this order and under the same names."""
    return tuple(leaf(tag, part, **{field: getattr(part, field) for field in fields}) for part in parts)


def _group(group: PlanningGroup) -> GroupView:
    return GroupView(
        attributes(group, name=group.name),
        _members(group, group.links, "links"),
        _members(group, group.joints, "joints"),
        _leaves("chain", group.chains, "base_link", "tip_link"),
        _members(group, group.subgroups, "subgroups"),
        elements(group),
    )


def _members(group: PlanningGroup, names: Sequence[str], key: str) -> list[str]:
    return [placed(name, group.source, key, number) for number, name in enumerate(names)]


def _without_collisions(robot: Robot) -> list[str]:
    # Names alone, collected from all modules: what is known of each is where its link was written.
    names = robot.semantic.no_default_collision_links
    return [placed(name, robot.links[name].source if name in robot.links else None) for name in names]


def _group_state(state: GroupState) -> StateView:
    return StateView(
        attributes(state, name=state.name, group=state.group),
        tuple(
            (placed(joint, state.source, joint), " ".join(map(spelled, positions)))
            for joint, positions in state.joint_values.items()
        ),
        elements(state),
    )


def _spheres(approximation: LinkSphereApproximation) -> SpheresView:
    return SpheresView(
        attributes(approximation, link=approximation.link),
        tuple(
            leaf(
                "sphere",
                sphere,
                center=(sphere.center_x, sphere.center_y, sphere.center_z),
                radius=sphere.radius,
            )
            for sphere in approximation.spheres
        ),
        elements(approximation),
    )
