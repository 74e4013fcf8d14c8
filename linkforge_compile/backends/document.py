"""Documents: what the templates make of a view of the robot."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import CodeType
from typing import TypeAlias

from linkforge_compile.backends import markup
from linkforge_compile.backends.markup import document_text, end, harmless_in_comment, lay, ready
from linkforge_compile.bytecode import kept
from linkforge_compile.resources import templates_folder

_Template: TypeAlias = Callable[[list[str], object], object]
"""Appends the lines that a template makes of a view."""


class TemplateFaultError(Exception):
    """A template of linkforge is not as it was made: somebody has changed it; the message says where, and why."""

    def __init__(self, path: Path, line: int, reason: str) -> None:
        super().__init__(
            f"{path}:{line}: {reason}; this template is a part of linkforge: mend it, or install linkforge again"
        )


def render(template: str, view: object, *, pretty: bool, banner: str | None) -> str:
    """Return the XML document that a template makes of a view of the robot, which it calls `robot`.

    `banner` becomes a comment above it, None or empty for none. The last character is a line end; without `pretty`
    it is the only one, but for those in comments and texts of raw XML.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.
        TemplateFaultError: for a template that somebody has changed to what it cannot be.

    """
    lines: list[str] = []
    _template(template)(lines, view)
    body = document_text(lines, pretty=pretty)
    head = ['<?xml version="1.0"?>', *([_comment(banner, pretty=pretty)] if banner else []), body]
    return ("\n" if pretty else "").join(head) + "\n"


@cache
def _template(name: str) -> _Template:
    """Return what a template became, from where an earlier process left it; one that has changed becomes it anew."""
    folder = (templates_folder() / name).parent
    paths = sorted(folder.rglob("*.j2"))
    # Jinja's own files are not asked: that a template means the same to each version is what a version promises.
    made_by = (Path(__file__).with_name("template_python.py"), Path(markup.__file__), Path(__file__))
    code = kept(__file__, f"{folder.name}_templates", [*paths, *made_by], lambda: _compiled(name, paths))
    names: dict[str, Callable[..., object]] = {"ready": ready, "lay": lay, "end": end}
    exec(code, names)
    return names["document"]


def _compiled(name: str, paths: list[Path]) -> CodeType:
    # It brings Jinja, which takes a sixth of a short command to import.
    from jinja2 import TemplateSyntaxError

    from linkforge_compile.backends.template_python import UnknownInTemplateError, python_of

    texts = {path.relative_to(templates_folder()).as_posix(): path.read_text("utf-8") for path in paths}
    try:
        python = python_of(name, texts, "robot")
    except UnknownInTemplateError as unknown:
        raise TemplateFaultError(templates_folder() / unknown.template, unknown.line, unknown.reason) from None
    except TemplateSyntaxError as error:
        raise TemplateFaultError(templates_folder() / (error.name or name), error.lineno, str(error.message)) from None
    return compile(python, f"<{name}>", "exec")


def _comment(text: str, *, pretty: bool) -> str:
    """Return a comment; what would end it, or what XML cannot hold, is put out of action: nobody reads it back."""
    lines = [line.strip() for line in harmless_in_comment(text).splitlines()]
    if not pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
