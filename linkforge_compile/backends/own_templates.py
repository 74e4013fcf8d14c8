"""Renders our own templates, and says where one is at fault that somebody has changed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from traceback import walk_tb

from jinja2 import TemplateError, TemplateSyntaxError

from linkforge_compile.backends.environment import own_environment
from linkforge_compile.resources import templates_folder


class TemplateFaultError(Exception):
    """A template of linkforge is not as it was made: somebody has changed it; the message says where, and why."""

    def __init__(self, path: Path, line: int, reason: str) -> None:
        super().__init__(
            f"{path}:{line}: {reason}; this template is a part of linkforge: mend it, or install linkforge again"
        )


def rendered(template: str, views: Mapping[str, object]) -> str:
    """Return what one of our own templates makes of views of the robot, not laid out.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.
        TemplateFaultError: for a template that somebody has changed to what it cannot be.

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
