"""Small robots for the checks, and the messages about them."""

from linkforge_compile.checks import check
from linkforge_compile.core import (
    Chain,
    Inertial,
    InertiaTensor,
    Joint,
    JointLimits,
    JointMimic,
    JointType,
    Link,
    PlanningGroup,
    Robot,
    SemanticRobotDescription,
    Vector3,
)
from linkforge_compile.diagnostics import UnresolvedNames

X = Vector3(1.0, 0.0, 0.0)


def fixed(name: str, parent: str, child: str) -> Joint:
    return Joint(name, JointType.FIXED, parent, child)


def turning(
    name: str, parent: str, child: str, *, mimic: str | None = None, limits: JointLimits | None = None
) -> Joint:
    limits = limits or JointLimits(-1.0, 1.0)
    follows = JointMimic(mimic) if mimic else None
    return Joint(name, JointType.REVOLUTE, parent, child, axis=X, limits=limits, mimic=follows)


def body(name: str, mass: float = 1.0, *, inertia: InertiaTensor | None = None) -> Link:
    return Link(name, Inertial(mass, inertia=inertia or InertiaTensor(1.0, 1.0, 1.0)))


def robot(links: str, *joints: Joint, **parts: object) -> Robot:
    """Return a robot with these links, a word each, all of them bodies with mass."""
    return Robot("r", links=[body(name) for name in links.split()], joints=joints, **parts)  # type: ignore[arg-type]


def messages_of(subject: Robot, unresolved: UnresolvedNames | None = None) -> list[str]:
    """Return the diagnostics of the checks, each as "LFnnnn message"."""
    return [f"{one.code.id} {one.message}" for one in check(subject, unresolved or UnresolvedNames())]


def two_arms(**semantic: object) -> Robot:
    """Return a torso with a left and a right arm; each has a shoulder that turns in [-1, 1] and a fixed hand."""
    joints = [
        joint
        for side in ("left", "right")
        for joint in (
            turning(f"{side}_shoulder", "torso", f"{side}_arm"),
            fixed(f"{side}_wrist", f"{side}_arm", f"{side}_hand"),
        )
    ]
    description = SemanticRobotDescription(**semantic)  # type: ignore[arg-type]
    return robot("torso left_arm left_hand right_arm right_hand", *joints, semantic=description)


def chain(name: str, base: str, tip: str) -> PlanningGroup:
    """Return a group of one chain."""
    return PlanningGroup(name, chains=(Chain(base, tip),))


LEFT = chain("left", "torso", "left_hand")
