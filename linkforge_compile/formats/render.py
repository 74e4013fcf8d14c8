"""Renders a robot: the functions for scripts, as URDF, SRDF, and by templates of one's own."""

from __future__ import annotations

from pathlib import Path

# Not for types alone: `typing.get_type_hints` of these functions needs it.
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats import SRDF, URDF, render_documents
from linkforge_compile.formats.format import Rendering
from linkforge_compile.formats.source_map import Mapped
from linkforge_compile.formats.urdf import Gazebo


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
