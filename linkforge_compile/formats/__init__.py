"""The output formats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from linkforge_compile.formats.format import NO_OPTIONS, Document, Format, Option, Options, Rendering
from linkforge_compile.formats.mjcf import Mjcf
from linkforge_compile.formats.sdf import Sdf
from linkforge_compile.formats.srdf import Srdf
from linkforge_compile.formats.urdf import Urdf

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.user_templates import TemplateFolder

__all__ = [
    "FORMATS",
    "MJCF",
    "NO_OPTIONS",
    "SDF",
    "SRDF",
    "URDF",
    "Document",
    "Format",
    "Option",
    "Options",
    "Rendering",
    "declared_options",
    "format_named",
    "render_documents",
    "report_limits",
    "require_options",
]

URDF, SRDF, MJCF, SDF = Urdf(), Srdf(), Mjcf(), Sdf()

FORMATS: tuple[Format, ...] = (URDF, SRDF, MJCF, SDF)
"""Every output format; the first is the one on standard output unless another is requested."""


def format_named(name: str) -> Format:
    return next(one for one in FORMATS if one.name == name)


def declared_options() -> tuple[Option, ...]:
    """Return the options of all formats; formats that share one declare the same."""
    return tuple(dict.fromkeys(option for one in FORMATS for option in one.options))


def require_options(options: Options) -> None:
    """Check the values of options.

    Raises:
        ValueError: for a value that is not one of its option's choices.

    """
    for option in declared_options():
        option.value(options)


def report_limits(robot: Robot, options: Options, requested: Iterable[str] = ()) -> Iterator[Diagnostic]:
    """Yield what the default formats and the requested ones cannot hold of a robot."""
    names = frozenset(requested)
    for one in FORMATS:
        if one.is_default or one.name in names:
            yield from one.limits(robot, options)


def render_documents(robot: Robot, templates: TemplateFolder, options: Options, banner: str) -> dict[str, str]:
    """Return what each document's template of a folder makes of the robot, by the document's name.

    Raises:
        TemplateError: with all that is wrong with the templates.
        RobotGeneratorError: for a robot whose text XML cannot hold.
        ValueError: for a value of an option that is not one of its choices.

    """
    require_options(options)
    return templates.render({"robot": robot} | {one.name: one.view(robot, options) for one in FORMATS}, banner)
