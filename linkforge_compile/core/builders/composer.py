"""What a link builder needs of whoever it builds for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    from linkforge_compile.core.builders.link_builder import LinkBuilder
    from linkforge_compile.core.models.robot import Robot


@runtime_checkable
class IComposer(Protocol):
    """Something that holds a robot under construction and the links that are not finished yet."""

    robot: Robot

    def link(self, name: str, parent: str | None = None, joint_name: str | None = None) -> LinkBuilder:
        """Begin a link."""
        ...

    def material(self, name: str, color: tuple[float, float, float, float] | None = None) -> IComposer:
        """Define a material that links may name."""
        ...

    def build(self, validate: bool = True) -> Robot:
        """Finish all links and return the robot."""
        ...

    def register_link_builder(self, builder: LinkBuilder) -> None:
        """Remember a link that is to be finished before the robot is."""
        ...

    def push_parent(self, name: str) -> None:
        """Make a link the parent of links that name none."""
        ...

    def pop_parent(self, name: str | None = None) -> None:
        """Take that link off again; None for the one that was made parent last."""
        ...
