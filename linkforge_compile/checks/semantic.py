"""The checks of what a robot says for planning, in their order; a robot that says nothing does without them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.checks import groups, names, srdf, states

if TYPE_CHECKING:
    from linkforge_compile.checks import Check

SEMANTIC_CHECKS: tuple[Check, ...] = (
    names.check_semantic_duplicates,
    srdf.check_semantic_links,
    srdf.check_semantic_joints,
    srdf.check_semantic_groups,
    srdf.check_virtual_joints,
    srdf.check_virtual_joint_names,
    srdf.check_collision_pairs,
    srdf.check_enabled_pairs,
    srdf.check_passive_joints,
    groups.check_group_circles,
    groups.check_chains,
    groups.check_empty_groups,
    groups.check_end_effectors,
    groups.check_arms_of_end_effectors,
    states.check_group_states,
    states.check_states_taken_over,
    states.check_states_of_mimics,
    states.check_states_are_whole,
)
