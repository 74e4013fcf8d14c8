"""Renders our own templates, and locates the fault in one that was changed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from traceback import walk_tb

from jinja2 import TemplateError, TemplateSyntaxError

from linkforge_compile.formats.environment import own_environment
from linkforge_compile.resources import templates_folder


class TemplateFaultError(Exception):
    """A template of linkforge was changed and cannot be rendered; the message has its file, line and fault."""

    def __init__(self, path: Path, line: int, reason: str) -> None:
        super().__init__(
            f"{path}:{line}: {reason}; this template is a part of linkforge: mend it, or install linkforge again"
        )


def render_own(template: str, views: Mapping[str, object]) -> str:
    """Render one of our own templates and return its text, not laid out.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.
        TemplateFaultError: for a template that was changed and cannot be rendered.

    """
    try:
        return own_environment().get_template(template).render(views)
    except TemplateSyntaxError as error:
        path = Path(error.filename or templates_folder() / template)
        raise TemplateFaultError(path, error.lineno, str(error.message)) from None
    except TemplateError as error:
        path, line = next(_places(error), (templates_folder() / template, 1))
        raise TemplateFaultError(path, line, str(error)) from None


def _places(error: BaseException) -> Iterator[tuple[Path, int]]:
    """Yield the lines of templates that led to an error, the innermost first."""
    steps = [(Path(frame.f_code.co_filename), line) for frame, line in walk_tb(error.__traceback__)]
    return ((path, line) for path, line in reversed(steps) if path.suffix == ".j2")
