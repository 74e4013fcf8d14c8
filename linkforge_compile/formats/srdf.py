"""The semantic part of a robot as SRDF."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.document import Templates, render

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

__all__ = ["render_srdf"]


def render_srdf(robot: Robot, *, pretty: bool = True, banner: str | None = None, templates: Templates = None) -> str:
    """Return the robot's semantic part as an SRDF document, sections in the order of MoveIt's own writer.

    `pretty` indents by two spaces; without it everything stands on one line. `banner` becomes a comment at the top,
    None for none. A robot without a semantic part gives an empty `<robot>`. `templates` is a folder whose `srdf/` has
    templates that go before linkforge's own.

    Raises:
        RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.
        TemplateError: for what is wrong with one of `templates`.

    """
    # Most robots have none, and its views take their time to define.
    from linkforge_compile.formats.srdf_view import semantic_view

    views = {"robot": robot, "srdf": semantic_view(robot)}
    return render("srdf/robot.xml.j2", views, pretty=pretty, banner=banner, templates=templates)
