"""Limits that all formats of XML share: texts and extras that cannot be written, or that are written twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.part import Inside
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import UNWRITABLE
from linkforge_compile.formats.element import (
    InsideError,
    RestatedAttributeError,
    inside_of,
    place_of_attribute,
)
from linkforge_compile.formats.namespaces import undeclared_prefixes
from linkforge_compile.formats.parts import Doubtful, Held, Part
from linkforge_compile.formats.unwritable import unwritable_raw, unwritable_texts
from linkforge_compile.source import Key

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot


def check_texts(robot: Robot, doubtful: Doubtful) -> Iterator[Diagnostic]:
    """XML holds no control characters, extras must be well-formed, and only some names can be those of tags."""
    yield from unwritable_raw(robot, robot.source)
    yield from unwritable_texts(doubtful.parts)
    yield from undeclared_prefixes(robot, doubtful.with_extras)


def check_attributes(parts: Sequence[Held], robot: Robot, render: Callable[[], str]) -> Iterator[Diagnostic]:
    """An element has each attribute once: what a field of the language says, `extra_attributes` cannot say again.

    Which attributes an element has, only its rendering knows; so where there are extra ones at all, it is tried.
    The same goes for what `extra_inside` speaks of.
    """
    extended = [part for part, *_ in parts if _is_extended(part)]
    if not (robot.extra_attributes or extended):
        return
    try:
        render()
    except RestatedAttributeError as error:
        yield UNWRITABLE.at(*place_of_attribute(error.name, error.source), Key(error.name), reason=error)
    except InsideError as error:
        from linkforge_compile.formats.inside import marks_of

        for fault in (error, *error.others):
            part = next(part for part in extended if fault.mark in list(marks_of(inside_of(part))))
            yield UNWRITABLE.at(part.source, "extra_inside", Key(fault.key), reason=fault)
    except RobotGeneratorError:
        return  # told by what looks at the texts


def _is_extended(part: Part) -> bool:
    """Whether it has attributes beside its fields', or says what is inside it: that is of the part, none by itself."""
    return not isinstance(part, Inside) and bool(part.extra_attributes or inside_of(part))


def check_written_twice(parts: Sequence[Held]) -> Iterator[Diagnostic]:
    """An element of which there can be one is written by its field or as raw XML, and not twice."""
    if any(part.extra_elements for part, *_ in parts):
        from linkforge_compile.formats.written_twice import written_twice

        yield from written_twice(parts)
