"""Classes of controllers that misspell one of ros2_controllers."""

from __future__ import annotations

from linkforge_compile.core.models.controller_kinds import KINDS, OTHER_CLASSES
from linkforge_compile.diagnostics.suggest import nearest

_TYPING_ERRORS = 2
"""By how many letters a misspelled class is shorter or longer; other packages have longer names."""


def misspelled_class(type_: str | None) -> str | None:
    """Return the class of ros2_controllers that a type misspells; None for a class of another package."""
    if not type_ or type_ in KINDS or type_ in OTHER_CLASSES:
        return None
    near = nearest(type_, (*KINDS, *OTHER_CLASSES))
    if near is None:
        return None
    is_of_package = type_.split("/")[0] == near.split("/")[0]
    return near if is_of_package or abs(len(type_) - len(near)) <= _TYPING_ERRORS else None
