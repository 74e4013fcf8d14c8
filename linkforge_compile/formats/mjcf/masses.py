"""Masses and tensors in MJCF: what MuJoCo refuses of them, and what is written instead."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.moments import possible_inertia, principal_moments
from linkforge_compile.formats.kinematic_tree import WORLD, KinematicTree

if TYPE_CHECKING:
    from linkforge_compile.core.models.link import InertiaTensor, Link
    from linkforge_compile.core.models.robot import Robot

LEAST = 1e-13
"""MuJoCo refuses moving bodies with a hundredth of this mass [kg], and tensors with a tenth of it [kg·m²]."""


def massless_movers(robot: Robot, tree: KinematicTree, *, is_free: bool) -> Iterator[Link]:
    """Yield each link that moves although neither it nor what is fixed to it has mass and inertia."""
    for link, joint, _ in tree.nodes:
        moves = is_free and link.name != WORLD if joint is None else joint.type != JointType.FIXED
        if moves and not any(_has_inertia(robot.links[held]) for held in tree.held_by(link.name)):
            yield link


def _has_inertia(link: Link) -> bool:
    return link.mass > LEAST and principal_moments(accepted_inertia(link))[0] > LEAST / 2


def accepted_inertia(link: Link) -> InertiaTensor:
    """Return the tensor of a link with an inertial if MuJoCo accepts it, else one with larger moments."""
    return possible_inertia(link.inertia, LEAST if link.mass else 0.0)
