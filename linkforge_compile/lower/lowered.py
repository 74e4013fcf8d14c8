"""What lowering makes of a use of a file and of all its modules."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.lower.module_joint import ModuleJoint


class Unmerged(NamedTuple):
    """The robot of a module that could not be joined, complete but for the names left out on purpose."""

    robot: Robot
    unresolved: UnresolvedNames

    @property
    def name(self) -> str:
        return self.robot.name


@dataclass(frozen=True)
class Lowered:
    """What lowering makes of an instance and of all its modules.

    `robot` is None where its file could not be read. `unmerged` are the robots of modules
    that could not be joined to it because they are no tree or repeat a name: checking them alone tells why.
    `unresolved` names what the robot lacks because of faults, the parts of `unmerged` among them.
    `mount` is the joint by which it hangs where it is used, with `world` for the link that it hangs on.
    `under_a_prefix` is what there is to tell once the names of the robot take one.
    """

    robot: Robot | None
    unmerged: tuple[Unmerged, ...]
    unresolved: UnresolvedNames
    under_a_prefix: tuple[Diagnostic, ...] = ()
    mount: ModuleJoint | None = None

    @property
    def robots(self) -> Iterator[tuple[Robot, UnresolvedNames]]:
        """Every robot that there is, those that could not be joined first, with what it lacks."""
        yield from self.unmerged
        if self.robot is not None:
            yield self.robot, self.unresolved

    @property
    def unresolved_alone(self) -> UnresolvedNames:
        """The names that a robot lacks which has no parent, and so no mount."""
        return self.unresolved | UnresolvedNames(mounts=frozenset([self.mount.name])) if self.mount else self.unresolved
