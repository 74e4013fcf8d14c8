"""Fields of a robot that are more than what was assigned to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, overload

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.models.semantic_parts import SemanticParts

if TYPE_CHECKING:
    from linkforge_compile.core.models.inventory import Inventory
    from linkforge_compile.core.models.srdf import SemanticRobotDescription


class SemanticField:
    """The field `semantic`: a description to whoever reads it, its lists filed for whoever adds to them."""

    @overload
    def __get__(self, robot: None, owner: type) -> None: ...
    @overload
    def __get__(self, robot: Inventory, owner: type) -> SemanticRobotDescription: ...
    def __get__(self, robot: Inventory | None, owner: type) -> SemanticRobotDescription | None:
        # None is what a dataclass takes for the default: that nothing semantic is said.
        return robot._semantic.description(robot.name) if robot else None

    def __set__(self, robot: Inventory, said: SemanticRobotDescription | None) -> None:
        robot._semantic = SemanticParts(said)


class VersionStatedField:
    """The field `version_stated`: True once somebody says so, or sets another version than the default."""

    @overload
    def __get__(self, robot: None, owner: type) -> Literal[False]: ...
    @overload
    def __get__(self, robot: Inventory, owner: type) -> bool: ...
    def __get__(self, robot: Inventory | None, owner: type) -> bool:
        return robot is not None and (robot._version_stated or robot.version != IR_VERSION)

    def __set__(self, robot: Inventory, stated: bool) -> None:
        robot._version_stated = stated
