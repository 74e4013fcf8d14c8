"""The one place that knows Jinja: templates to text, every value escaped on its way."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from linkforge_compile.backends.markup import Xml, escaped, harmless_in_comment, lay_out
from linkforge_compile.resources import templates_folder

if TYPE_CHECKING:
    from jinja2 import Environment


def render(template: str, view: object, *, pretty: bool, banner: str | None) -> str:
    """Return the XML document that a template makes of a view of the robot, which it calls `robot`.

    `banner` becomes a comment above it, None or empty for none. The last character is a line end; without `pretty`
    it is the only one, but for those in comments and texts of raw XML.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.

    """
    body = lay_out(_environment().get_template(template).render(robot=view), pretty=pretty)
    head = ['<?xml version="1.0"?>', *([_comment(banner, pretty=pretty)] if banner else []), body]
    return ("\n" if pretty else "").join(head) + "\n"


@cache
def _environment() -> Environment:
    # jinja2 costs 75 ms to import, and most commands write nothing.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from linkforge_compile.backends.bytecode import TemplateBytecode, TemplatePython

    environment = Environment(
        loader=FileSystemLoader(templates_folder()),
        bytecode_cache=TemplateBytecode(__file__),
        autoescape=True,
        finalize=_finished,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,  # an included template ends its last line
        auto_reload=False,
    )
    environment.code_generator_class = TemplatePython
    return environment


def _finished(value: object) -> str:
    """Escape a string but for what is XML already: ours, or what a macro of Jinja's returns."""
    if value.__class__ is Xml:  # nine of ten
        return value
    if isinstance(value, str):
        if hasattr(value, "__html__"):
            return value
        text = escaped(value)
        # Jinja itself leaves it as it is then, should it ever look.
        return value if text is value else Xml(text)
    raise TypeError(f"templates place strings that are ready, found {value!r}")


def _comment(text: str, *, pretty: bool) -> str:
    """Return a comment; what would end it, or what XML cannot hold, is put out of action: nobody reads it back."""
    lines = [line.strip() for line in harmless_in_comment(text).splitlines()]
    if not pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
