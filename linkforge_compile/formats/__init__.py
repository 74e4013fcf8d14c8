"""The output formats, and functions that render URDF and SRDF."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.formats.format import NO_OPTIONS, Document, Format, Option, Options, Rendering
from linkforge_compile.formats.mjcf import Mjcf
from linkforge_compile.formats.source_map import Mapped
from linkforge_compile.formats.srdf import Srdf
from linkforge_compile.formats.urdf import Gazebo, Urdf

if TYPE_CHECKING:
    from linkforge_compile.formats.user_templates import TemplateFolder

__all__ = [
    "FORMATS",
    "MJCF",
    "NO_OPTIONS",
    "SRDF",
    "URDF",
    "Document",
    "Format",
    "Option",
    "Options",
    "Rendering",
    "declared_options",
    "format_named",
    "render_documents",
    "render_srdf",
    "render_srdf_with_map",
    "render_templates",
    "render_urdf",
    "render_urdf_with_map",
    "report_limits",
    "require_options",
]

URDF, SRDF, MJCF = Urdf(), Srdf(), Mjcf()

FORMATS: tuple[Format, ...] = (URDF, SRDF, MJCF)
"""Every output format; the first is the one on standard output unless another is requested."""


def format_named(name: str) -> Format:
    return next(one for one in FORMATS if one.name == name)


def declared_options() -> tuple[Option, ...]:
    """Return the options of all formats; formats that share one declare the same."""
    return tuple(dict.fromkeys(option for one in FORMATS for option in one.options))


def require_options(options: Options) -> None:
    """Check the values of options.

    Raises:
        ValueError: for a value that is not one of its option's choices.

    """
    for option in declared_options():
        option.value(options)


def report_limits(robot: Robot, options: Options, requested: Iterable[str] = ()) -> Iterator[Diagnostic]:
    """Yield what the default formats and the requested ones cannot hold of a robot."""
    names = frozenset(requested)
    for one in FORMATS:
        if one.is_default or one.name in names:
            yield from one.limits(robot, options)


def render_urdf(
    robot: Robot,
    *,
    pretty: bool = True,
    banner: str | None = None,
    gazebo: Gazebo = "gz",
    templates: str | Path | None = None,
) -> str:
    """Return the robot as a URDF document: materials, links, joints, transmissions, ros2_control, Gazebo, in its order.

    `pretty` indents by two spaces; without it the document is one line. `banner` becomes a comment at the top, None
    for none. `gazebo` is the dialect of the sensors: Gazebo Sim, or Classic. What URDF cannot say is left out;
    `URDF.limits` reports it. `templates` is a folder whose `urdf/` has templates that replace linkforge's own.

    Raises:
        RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.
        TemplateError: for what is wrong with one of `templates`.
        ValueError: for another `gazebo` than `gz` or `classic`.

    """
    return URDF.render(robot, Rendering({"gazebo": gazebo}, pretty, banner, templates))[0].text


def render_srdf(
    robot: Robot, *, pretty: bool = True, banner: str | None = None, templates: str | Path | None = None
) -> str:
    """Return the robot's semantic part as an SRDF document, sections in the order of MoveIt's own writer.

    `pretty` indents by two spaces; without it the document is one line. `banner` becomes a comment at the top, None
    for none. A robot without a semantic part gives an empty `<robot>`. `templates` is a folder whose `srdf/` has
    templates that replace linkforge's own.

    Raises:
        RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.
        TemplateError: for what is wrong with one of `templates`.

    """
    return SRDF.render(robot, Rendering(pretty=pretty, banner=banner, templates=templates))[0].text


def render_urdf_with_map(robot: Robot, *, banner: str | None = None, gazebo: Gazebo = "gz") -> Mapped:
    """Return the robot as a URDF document, the same as without a map, and where each of its lines was written.

    Raises:
        RobotGeneratorError: as `render_urdf`.

    """
    return URDF.render_with_map(robot, Rendering({"gazebo": gazebo}, banner=banner))


def render_srdf_with_map(robot: Robot, *, banner: str | None = None) -> Mapped:
    """Return the robot's semantic part as an SRDF document, and where each of its lines was written.

    Raises:
        RobotGeneratorError: as `render_srdf`.

    """
    return SRDF.render_with_map(robot, Rendering(banner=banner))


def render_templates(
    robot: Robot, folder: str | Path, *, banner: str = "", gazebo: Gazebo = "gz", allow_outside: bool = False
) -> dict[str, str]:
    """Return what each template at the top of a folder makes of the robot, by its name without `.j2`.

    Templates see the robot as `robot`, its URDF and SRDF as `urdf` and `srdf`, and `banner`. They run in a sandbox.
    A link among them leads within the folder's repository, unless `allow_outside` lets it lead anywhere.

    Raises:
        TemplateError: with all that is wrong with the templates.
        RobotGeneratorError: for a robot whose text XML cannot hold.
        OSError: for a folder that cannot be read.
        ValueError: for a folder without templates, and for another `gazebo` than `gz` or `classic`.

    """
    from linkforge_compile.formats.user_templates import TemplateFolder

    templates = TemplateFolder(folder, allow_outside=allow_outside)
    templates.require_templates()
    return render_documents(robot, templates, {"gazebo": gazebo}, banner)


def render_documents(robot: Robot, templates: TemplateFolder, options: Options, banner: str) -> dict[str, str]:
    """Return what each document's template of a folder makes of the robot, by the document's name.

    Raises:
        TemplateError: with all that is wrong with the templates.
        RobotGeneratorError: for a robot whose text XML cannot hold.
        ValueError: for a value of an option that is not one of its choices.

    """
    require_options(options)
    return templates.render({"robot": robot} | {one.name: one.view(robot, options) for one in FORMATS}, banner)
