"""What URDF and SRDF, or most of their readers, cannot take: told before anything is written."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.part import Inside
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.backends import (
    NEW_GEOMETRY,
    OLD_VERSION,
    OTHER_QUATERNION,
    TWO_MATERIALS,
    UNKNOWN_VERSION,
    UNWRITABLE,
)
from linkforge_compile.formats.element import InsideError, RestatedAttributeError, inside_of, place_of_attribute
from linkforge_compile.formats.markup import spelled
from linkforge_compile.formats.namespaces import undeclared_prefixes
from linkforge_compile.formats.parts import Doubtful, Held, Part, doubtful_parts_in, doubtful_parts_of_urdf
from linkforge_compile.formats.srdf import render_srdf
from linkforge_compile.formats.unwritable import unwritable_raw, unwritable_texts
from linkforge_compile.formats.urdf import capsules, render_urdf, require_dialect, stated_version
from linkforge_compile.source import Key

if TYPE_CHECKING:
    from linkforge_compile.core.models.material import Material
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.urdf.sensor import Gazebo

_READ_VERSIONS = ("1.0", "1.1", "1.2")


def urdf_limits(robot: Robot, *, gazebo: Gazebo = "gz") -> Iterator[Diagnostic]:
    """Yield what `render_urdf` leaves out or refuses, and what common readers refuse in what it writes.

    Raises:
        ValueError: for another `gazebo` than `gz` or `classic`.

    """
    require_dialect(gazebo)
    doubtful = doubtful_parts_of_urdf(robot)
    yield from check_texts(robot, doubtful)
    yield from check_written_twice(doubtful.with_extras)
    yield from check_attributes(doubtful.with_extras, robot, partial(render_urdf, robot, gazebo=gazebo))
    yield from check_capsules(robot)
    yield from check_version(robot)
    yield from check_turns(robot, doubtful.with_extras)
    yield from check_materials_of_one_name(robot)
    if robot.sensors:
        from linkforge_compile.formats.urdf.sensor_limits import sensor_limits

        yield from sensor_limits(robot, gazebo)


def srdf_limits(robot: Robot) -> Iterator[Diagnostic]:
    """Yield what `render_srdf` refuses."""
    if not robot.says_semantic:
        # To ask for its semantic part would make one.
        return
    doubtful = doubtful_parts_in(robot.semantic)
    yield from unwritable_texts(doubtful.parts)
    yield from undeclared_prefixes(robot.semantic, doubtful.with_extras)
    yield from check_attributes(doubtful.with_extras, robot, partial(render_srdf, robot))


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


def check_capsules(robot: Robot) -> Iterator[Diagnostic]:
    """URDF has capsules since version 1.1, which the file states by itself where its author states none.

    Readers built before that refuse the whole file, whatever it states. A cylinder or a mesh suits them all.
    """
    capsule = next(capsules(robot), None)
    if capsule is None:
        return
    yield NEW_GEOMETRY.at(capsule.source)
    if robot.version_stated and robot.version == "1.0":
        yield OLD_VERSION.at(robot.source, "version", version=robot.version)


def check_version(robot: Robot) -> Iterator[Diagnostic]:
    """The `version` of a robot is that of the URDF language, not that of the robot's design."""
    if robot.version_stated and robot.version not in _READ_VERSIONS:
        yield UNKNOWN_VERSION.at(robot.source, "version", version=robot.version)


def check_turns(robot: Robot, parts: Sequence[Held]) -> Iterator[Diagnostic]:
    """An origin turns one way: readers of URDF 1.1 take its `quat_xyzw`, the compiler and older ones its `rpy`."""
    poses = [part for part, *_ in parts if isinstance(part, Transform) and part.extra_attributes]
    if not poses:
        return
    from linkforge_compile.formats.urdf.quaternion import QUATERNION, is_other_turn, reads_quaternions

    if not reads_quaternions(stated_version(robot)):
        return

    for pose in poses:
        if is_other_turn(pose):
            rpy = spelled(pose.rpy)
            yield OTHER_QUATERNION.at(pose.source, "extra_attributes", Key(QUATERNION), rpy=rpy)


def check_materials_of_one_name(robot: Robot) -> Iterator[Diagnostic]:
    """A reader keeps one material a name, urdfdom the first, and shows every visual that names it in that one."""
    first: dict[str, Material] = dict(robot.materials)
    for link in robot.links:
        for material in (visual.material for visual in link.visuals):
            if material is None or not material.name:
                continue
            known = first.setdefault(material.name, material)
            if known is not material and known != material:
                notes = [Note("the first is here", known.source.span)] if known.source else []
                yield TWO_MATERIALS.at(material.source, name=material.name, notes=notes)
