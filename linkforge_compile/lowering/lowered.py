"""What lowering makes of a use of a file and of all its modules."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Gaps

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.lowering.module_joint import ModuleJoint


class Unmerged(NamedTuple):
    """The robot of a module that could not be joined, free of gaps: these say only what it lacks on purpose."""

    robot: Robot
    gaps: Gaps

    @property
    def name(self) -> str:
        return self.robot.name


@dataclass(frozen=True)
class Lowered:
    """What lowering makes of an instance and of all its modules.

    `robot` is None where its file could not be read. `unmerged` are the robots of modules
    that could not be joined to it because they are no tree or repeat a name: checking them alone tells why.
    `gaps` names what the robot lacks because of faults, the parts of `unmerged` among them.
    `mount` is the joint by which it hangs where it is used, with `world` for the link that it hangs on.
    `under_a_prefix` is what there is to tell once the names of the robot take one.
    """

    robot: Robot | None
    unmerged: tuple[Unmerged, ...]
    gaps: Gaps
    under_a_prefix: tuple[Diagnostic, ...] = ()
    mount: ModuleJoint | None = None

    @property
    def robots(self) -> Iterator[tuple[Robot, Gaps]]:
        """Every robot that there is, those that could not be joined first, with what it lacks."""
        yield from self.unmerged
        if self.robot is not None:
            yield self.robot, self.gaps

    @property
    def gaps_alone(self) -> Gaps:
        """The gaps of a robot that hangs nowhere, and so lacks its mount."""
        return self.gaps | Gaps(mounts=frozenset([self.mount.name])) if self.mount else self.gaps
