"""Documents: what the templates make of a view of the robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.formats.markup import document_text, harmless_in_comment

if TYPE_CHECKING:
    from pathlib import Path

    from linkforge_compile.formats.user_templates import TemplateFolder

Templates: TypeAlias = "TemplateFolder | str | Path | None"
"""A user's folder of templates that go before ours; None for ours alone."""


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
    lines = [line.strip() for line in harmless_in_comment(text).splitlines()]
    if not pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
