"""Formats whose documents are made by templates of XML."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkforge_compile.formats.format import DEFAULT_RENDERING, Document, Format, Options, Rendering, Templates

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.formats.source_map import Mapped


class TemplateFormat(Format):
    """A format of one XML document, made by the template `NAME/robot.xml.j2` of a view of the robot."""

    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        if not rendering.has_map:
            return (Document(self.text(robot, rendering)),)
        text, map_ = self.render_with_map(robot, rendering)
        return (Document(text, map=map_),)

    def render_with_map(self, robot: Robot, rendering: Rendering) -> Mapped:
        """Return the document, the same as without a map, and where each of its lines was written."""
        from linkforge_compile.formats.marks import recording
        from linkforge_compile.formats.source_map import unmarked

        with recording() as marks:
            return unmarked(self.text(robot, rendering), marks)

    def text(self, robot: Robot, rendering: Rendering = DEFAULT_RENDERING) -> str:
        """Return the document.

        Raises:
            RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.
            TemplateError: for what is wrong with one of the user's templates.

        """
        options, pretty, banner, templates, _ = rendering
        views = {"robot": robot, self.name: self.root_view(robot, options)}
        return render(f"{self.name}/robot.xml.j2", views, pretty=pretty, banner=banner, templates=templates)

    @abstractmethod
    def root_view(self, robot: Robot, options: Options) -> object:
        """Return what the templates of the format see of the robot, every string ready for its place."""

    def view(self, robot: Robot, options: Options) -> object:
        return self.root_view(robot, options)


def render(
    template: str,
    views: Mapping[str, object],
    *,
    pretty: bool,
    banner: str | None,
    templates: Templates = None,
) -> str:
    """Return the XML document that a template makes of views of the robot, by the names that it has for them.

    `banner` becomes a comment above it, None or empty for none. The last character is a line end; without `pretty`
    it is the only one, but for those in comments and texts of raw XML. `templates` are a user's that go before ours.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.
        TemplateError: for what is wrong with a template of the user's.
        TemplateFaultError: for a template of ours that was changed and cannot be rendered.

    """
    from linkforge_compile.formats.markup import document_text

    if templates is None:
        # Jinja2 takes 70 ms to import, and some commands render nothing.
        from linkforge_compile.formats.own_templates import render_own

        body = document_text(render_own(template, views), pretty=pretty)
    else:
        from linkforge_compile.formats.user_templates import TemplateFolder

        folder = templates if isinstance(templates, TemplateFolder) else TemplateFolder(templates)
        folder.require_templates()
        body = folder.xml(template, views, pretty=pretty)
    head = ['<?xml version="1.0"?>', *([_comment(banner, pretty=pretty)] if banner else []), body]
    return ("\n" if pretty else "").join(head) + "\n"


def _comment(text: str, *, pretty: bool) -> str:
    """Return a comment; what would end it, or what XML cannot hold, is put out of action."""
    from linkforge_compile.formats.markup import harmless_in_comment

    lines = [line.strip() for line in harmless_in_comment(text).splitlines()]
    if not pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
