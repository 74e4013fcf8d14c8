"""Fields of a robot that give something else than what was assigned to them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Generic, Literal, TypeVar, overload

from linkforge_compile.core.constants import IR_VERSION
from linkforge_compile.core.models.named_table import KeySpec, NamedTable, PartList

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot_parts import RobotParts
    from linkforge_compile.core.models.srdf import SemanticRobotDescription

T = TypeVar("T")


class PartsField(Generic[T]):
    """A field that takes any iterable of parts and gives them as a NamedTable, the same one until they change.

    The attribute `_NAME` of the robot has the PartList, `_NAME_table` the table that was read last.
    With `distinct`, assigning two parts of one key raises DUPLICATE_NAME and leaves the field as it was.
    """

    def __init__(self, spec: KeySpec, *, distinct: bool = False) -> None:
        self._spec = spec
        self._distinct = distinct

    def __set_name__(self, owner: type, name: str) -> None:
        self._attribute = f"_{name}"
        self._table = f"_{name}_table"

    @overload
    def __get__(self, robot: None, owner: type) -> tuple[()]: ...
    @overload
    def __get__(self, robot: RobotParts, owner: type) -> NamedTable[T]: ...
    def __get__(self, robot: RobotParts | None, owner: type) -> NamedTable[T] | tuple[()]:
        if robot is None:
            return ()  # the field's default, to dataclasses
        parts: PartList[T] = getattr(robot, self._attribute)
        table: NamedTable[T] | None = vars(robot).get(self._table)
        if table is None or not table.is_all_of(parts):
            table = vars(robot)[self._table] = NamedTable(parts)
        return table

    def __set__(self, robot: RobotParts, parts: Iterable[T]) -> None:
        assigned: PartList[T] = PartList(self._spec)
        assigned.extend(assigned.select_new(parts) if self._distinct else tuple(parts))
        setattr(robot, self._attribute, assigned)


class SemanticField:
    """The field `semantic`: the description under the robot's name, an empty one where None was assigned."""

    @overload
    def __get__(self, robot: None, owner: type) -> None: ...
    @overload
    def __get__(self, robot: RobotParts, owner: type) -> SemanticRobotDescription: ...
    def __get__(self, robot: RobotParts | None, owner: type) -> SemanticRobotDescription | None:
        if robot is None:
            return None
        if robot._semantic:
            return robot._semantic.describe(robot.name)
        from linkforge_compile.core.models.srdf import SemanticRobotDescription

        return SemanticRobotDescription(robot.name)

    def __set__(self, robot: RobotParts, description: SemanticRobotDescription | None) -> None:
        if description is None:
            robot._semantic = None
            return
        from linkforge_compile.core.models.srdf import SemanticParts

        robot._semantic = SemanticParts(description)


class VersionStatedField:
    """The field `version_stated`: True if it was set, or if the version is not the default."""

    @overload
    def __get__(self, robot: None, owner: type) -> Literal[False]: ...
    @overload
    def __get__(self, robot: RobotParts, owner: type) -> bool: ...
    def __get__(self, robot: RobotParts | None, owner: type) -> bool:
        return robot is not None and (robot._version_stated or robot.version != IR_VERSION)

    def __set__(self, robot: RobotParts, stated: bool) -> None:
        robot._version_stated = stated
