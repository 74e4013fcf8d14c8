"""A link under construction: what its stages have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.core.builders.composer import IComposer


class LinkDraft:
    """A link that is described call by call and becomes part of the robot all at once, when it is committed."""

    def __init__(self, builder: IComposer, name: str, parent: str | None = None, joint_name: str | None = None) -> None:
        self._builder = builder
        self._link_name = name
        self._parent = parent
        self._joint_name = joint_name
        self._committed = False

    def _check_not_committed(self) -> None:
        if self._committed:
            raise RuntimeError(f"LinkBuilder '{self._link_name}' already committed")
