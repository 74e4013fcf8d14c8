"""Renders a robot: the functions for scripts, to any format, to URDF and SRDF, and by templates of one's own."""

from __future__ import annotations

from pathlib import Path

# Not for types alone: `typing.get_type_hints` of these functions needs it.
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats import SRDF, URDF, format_named, render_documents, require_options
from linkforge_compile.formats.format import NO_OPTIONS, Options, Rendering
from linkforge_compile.formats.source_map import Mapped
from linkforge_compile.formats.urdf import Gazebo


def render(
    robot: Robot,
    format_: str,
    /,
    *,
    options: Options = NO_OPTIONS,
    pretty: bool = True,
    banner: str | None = None,
    templates: str | Path | None = None,
) -> str:
    """Return the robot in a format of a single file, by the name that `linkforge formats` lists.

    `options` are those of the format, such as `{"base": "free"}`, and the other words those of `render_urdf`. What the
    format cannot hold is omitted; `compile_file(..., formats=["mjcf"])` reports it.

    Raises:
        RobotGeneratorError: for a robot that the format cannot hold.
        TemplateError: for what is wrong with one of `templates`.
        ValueError: for an unknown format, one of several files, and an unknown option or value.

    """
    texts = render_files(robot, format_, options=options, pretty=pretty, banner=banner, templates=templates)
    if len(texts) > 1:
        raise ValueError(f"{format_} is {len(texts)} files; render_files returns them")
    return next(iter(texts.values()))


def render_files(
    robot: Robot,
    format_: str,
    /,
    *,
    options: Options = NO_OPTIONS,
    pretty: bool = True,
    banner: str | None = None,
    templates: str | Path | None = None,
) -> dict[str, str]:
    """Return the files of the robot in a format of one file or several, by their paths in a folder, as `render` does.

    The names are those of `linkforge compile --format FORMAT -o FOLDER/` with the robot's name: `arm.mjcf`.

    Raises:
        RobotGeneratorError: for a robot that the format cannot hold.
        TemplateError: for what is wrong with one of `templates`.
        ValueError: for an unknown format, and for an unknown option or value.

    """
    chosen = format_named(format_)
    require_options(options)
    documents = chosen.render(robot, Rendering(options, pretty, banner, templates))
    return {f"{robot.name}{chosen.suffix}{one.name and f'/{one.name}'}": one.text for one in documents}


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
    for none. `gazebo` is the dialect of the sensors: Gazebo Sim, or Classic. What URDF cannot say is omitted;
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

    Templates see the robot as `robot`, what each format's templates see under the name of the format, such as `urdf`,
    `srdf` and `mjcf`, and `banner`. They run in a sandbox.
    A link among them leads within the folder's repository, unless `allow_outside` lets it lead anywhere.

    Raises:
        TemplateError: with all that is wrong with the templates, and for a robot whose text XML cannot hold.
        OSError: for a folder that cannot be read.
        ValueError: for a folder without templates, and for another `gazebo` than `gz` or `classic`.

    """
    from linkforge_compile.formats.user_templates import TemplateFolder

    templates = TemplateFolder(folder, allow_outside=allow_outside)
    templates.require_templates()
    return render_documents(robot, templates, {"gazebo": gazebo}, banner)
