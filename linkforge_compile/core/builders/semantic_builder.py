"""Building the SRDF part of a robot call by call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.core.constants import SRDF_REASON_ADJACENT, SRDF_VJOIN_FIXED
from linkforge_compile.core.models.planning import chain_between
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

if TYPE_CHECKING:
    from linkforge_compile.core.builders.link_builder import IComposer


class SemanticBuilder:
    """The SRDF part of a robot under construction; links and joints that it names may be added later.

    A second entry of one name raises DUPLICATE_NAME, except collision pairs and links without default collisions.
    """

    def __init__(self, builder: IComposer) -> None:
        self._builder = builder

    def done(self) -> IComposer:
        """Return to the robot's builder."""
        return self._builder

    def group(  # noqa: PLR0917 the contract's signature
        self,
        name: str,
        links: list[str] | None = None,
        joints: list[str] | None = None,
        chains: list[Chain] | None = None,
        subgroups: list[str] | None = None,
        base_link: str | None = None,
        tip_link: str | None = None,
    ) -> SemanticBuilder:
        """Define a planning group; `base_link` and `tip_link`, always both, make one chain more."""
        all_chains = (*(chains or ()), *chain_between(name, base_link, tip_link))
        group = PlanningGroup(name, links or (), joints or (), all_chains, subgroups or ())
        return self._add(SemanticRobotDescription(groups=(group,)))

    def group_state(self, name: str, group: str, values: dict[str, float | tuple[float, ...]]) -> SemanticBuilder:
        """Name positions of a group's joints [rad] or [m]; a tuple for joints of several degrees of freedom."""
        return self._add(SemanticRobotDescription(group_states=(GroupState(name, group, values),)))

    def end_effector(self, name: str, group: str, parent_link: str, parent_group: str | None = None) -> SemanticBuilder:
        """Declare a group an end effector, on a link of another group."""
        return self._add(SemanticRobotDescription(end_effectors=(EndEffector(name, group, parent_link, parent_group),)))

    def passive_joint(self, name: str) -> SemanticBuilder:
        """Declare a joint that nothing drives."""
        return self._add(SemanticRobotDescription(passive_joints=(PassiveJoint(name),)))

    def virtual_joint(
        self, name: str, child_link: str, parent_frame: str = "world", joint_type: str = SRDF_VJOIN_FIXED
    ) -> SemanticBuilder:
        """Connect the robot's root link to a frame outside of the robot."""
        joint = VirtualJoint(name, joint_type, parent_frame, child_link)
        return self._add(SemanticRobotDescription(virtual_joints=(joint,)))

    def disable_collisions(self, link1: str, link2: str, reason: str = SRDF_REASON_ADJACENT) -> SemanticBuilder:
        """Let planning ignore collisions between two links."""
        return self._add(SemanticRobotDescription(disabled_collisions=(CollisionPair(link1, link2, reason),)))

    def enable_collisions(self, link1: str, link2: str, reason: str | None = None) -> SemanticBuilder:
        """Let planning look for collisions between two links although it is disabled by default."""
        return self._add(SemanticRobotDescription(enabled_collisions=(CollisionPair(link1, link2, reason),)))

    def disable_default_collisions(self, link: str) -> SemanticBuilder:
        """Let planning ignore all collisions of a link that are not enabled one by one."""
        return self._add(SemanticRobotDescription(no_default_collision_links=(link,)))

    def joint_property(self, joint_name: str, property_name: str, value: str) -> SemanticBuilder:
        """Set a property of a joint that planners know by name."""
        return self._add(SemanticRobotDescription(joint_properties=(JointProperty(joint_name, property_name, value),)))

    def approximate_link_collision(self, link: str, spheres: list[SrdfSphere]) -> SemanticBuilder:
        """Approximate a link's shape in collisions by spheres."""
        return self._add(SemanticRobotDescription(link_sphere_approximations=(LinkSphereApproximation(link, spheres),)))

    def _add(self, description: SemanticRobotDescription) -> SemanticBuilder:
        self._builder.robot.add_semantic(description)
        return self
