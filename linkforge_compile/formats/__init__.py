"""The output formats."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

from linkforge_compile.formats.format import NO_OPTIONS, Document, Format, Option, Options, Rendering
from linkforge_compile.formats.joint_limits import JointLimitsYaml
from linkforge_compile.formats.mjcf import Mjcf
from linkforge_compile.formats.moveit import MoveIt
from linkforge_compile.formats.ros2_controllers import Ros2Controllers
from linkforge_compile.formats.sdf import Sdf
from linkforge_compile.formats.srdf import Srdf
from linkforge_compile.formats.urdf import Urdf

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.user_templates import TemplateFolder


URDF, SRDF, SDF, MJCF = Urdf(), Srdf(), Sdf(), Mjcf()
JOINT_LIMITS, ROS2_CONTROLLERS, MOVEIT = JointLimitsYaml(), Ros2Controllers(), MoveIt()

FORMATS: tuple[Format, ...] = (URDF, SRDF, SDF, MJCF, JOINT_LIMITS, ROS2_CONTROLLERS, MOVEIT)
"""Every output format; the first is the one on standard output unless another is requested."""


def format_named(name: str) -> Format:
    """Return a format by its name; ValueError for an unknown one."""
    formats = {one.name: one for one in FORMATS}
    if name not in formats:
        from linkforge_compile.diagnostics.suggest import did_you_mean

        hint = did_you_mean(name, formats) or f"; there are {', '.join(formats)}"
        raise ValueError(f"there is no format '{name}'{hint}")
    return formats[name]


def declared_options() -> tuple[Option, ...]:
    """Return the options of all formats; formats that share one declare the same."""
    return tuple(dict.fromkeys(option for one in FORMATS for option in one.options))


def require_options(options: Options) -> None:
    """Check options.

    Raises:
        ValueError: for a name that no format declares, and for a value that is not one of its option's choices.

    """
    declared = {option.name: option for option in declared_options()}
    for name in options:
        if name not in declared:
            raise ValueError(f"no format has an option '{name}'; there are {', '.join(declared)}")
        declared[name].value(options)


def formats_or_default(names: Iterable[str]) -> tuple[Format, ...]:
    """Return the formats of these names, the default ones if there are none; ValueError for an unknown one."""
    return tuple(map(format_named, names)) or tuple(one for one in FORMATS if one.is_default)


def render_documents(robot: Robot, templates: TemplateFolder, options: Options, banner: str) -> dict[str, str]:
    """Return what each document's template of a folder makes of the robot, by the document's name.

    The views of formats are made only if a template uses them.

    Raises:
        TemplateError: with all that is wrong with the templates, and for a view that cannot be made of the robot.
        ValueError: for a value of an option that is not one of its choices.

    """
    from linkforge_compile.formats.environment import DeferredView

    require_options(options)
    views = {one.name: DeferredView(partial(one.view, robot, options)) for one in FORMATS}
    return templates.render({"robot": robot, **views}, banner)
