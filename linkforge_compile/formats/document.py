"""Formats whose documents are made by templates of XML."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

from linkforge_compile.formats.format import DEFAULT_RENDERING, Document, Format, Options, Rendering
from linkforge_compile.gc_paused import gc_paused

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

    @gc_paused()
    def render_with_map(self, robot: Robot, rendering: Rendering) -> Mapped:
        """Return the document, the same as without a map, and where each of its lines was written."""
        from linkforge_compile.formats.own_templates import render_own
        from linkforge_compile.formats.source_map import Mapped, SourceMap, recording
        from linkforge_compile.formats.xml_document import document_of, write_with_map

        with recording() as origins:
            body = document_of(render_own(self._template, self._views(robot, rendering)))
        text, map_ = write_with_map(body, origins)
        head = _head(rendering)
        return Mapped(f"{head}{text}\n", SourceMap(((),) * head.count("\n") + map_.lines + ((),)))

    @gc_paused()
    def text(self, robot: Robot, rendering: Rendering = DEFAULT_RENDERING) -> str:
        """Return the document; its last character is a line end.

        Raises:
            RobotGeneratorError: for text that XML cannot hold, and for extras that are not well-formed XML.
            TemplateError: for what is wrong with one of the user's templates.
            TemplateFaultError: for a packaged template that was changed and cannot be rendered.

        """
        views, templates = self._views(robot, rendering), rendering.templates
        if templates is None:
            # Jinja2 takes 70 ms to import, and some commands render nothing.
            from linkforge_compile.formats.own_templates import render_own
            from linkforge_compile.formats.xml_document import document_of, write

            body = write(document_of(render_own(self._template, views)), pretty=rendering.pretty)
        else:
            from linkforge_compile.formats.user_templates import TemplateFolder

            folder = templates if isinstance(templates, TemplateFolder) else TemplateFolder(templates)
            folder.require_templates()
            body = folder.xml(self._template, views, pretty=rendering.pretty)
        return f"{_head(rendering)}{body}\n"

    @property
    def _template(self) -> str:
        return f"{self.name}/robot.xml.j2"

    def _views(self, robot: Robot, rendering: Rendering) -> dict[str, object]:
        return {"robot": robot, self.name: self.root_view(robot, rendering.options)}

    @abstractmethod
    def root_view(self, robot: Robot, options: Options) -> object:
        """Return what the templates of the format see of the robot, every string ready for its place."""

    def view(self, robot: Robot, options: Options) -> object:
        return self.root_view(robot, options)


def _head(rendering: Rendering) -> str:
    """Return what stands above the root element: the declaration, and the banner as a comment."""
    lines = ['<?xml version="1.0"?>', *([_comment(rendering)] if rendering.banner else [])]
    return "".join(f"{line}\n" if rendering.pretty else line for line in lines)


def _comment(rendering: Rendering) -> str:
    """Return the banner as a comment; what would end it, or what XML cannot hold, is replaced."""
    from linkforge_compile.formats.xml_text import harmless_in_comment

    lines = [line.strip() for line in harmless_in_comment(rendering.banner or "").splitlines()]
    if not rendering.pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
