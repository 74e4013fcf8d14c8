"""The protocol of output formats: all that the commands and the compiler know of one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from pathlib import Path

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.source_map import SourceMap
    from linkforge_compile.formats.user_templates import TemplateFolder

Options: TypeAlias = Mapping[str, str]
"""Values of the options that formats declare, by name; a missing one has its default."""

Templates: TypeAlias = "TemplateFolder | str | Path | None"
"""A user's folder of templates that replace the packaged ones of the same path; None for the packaged ones alone."""

NO_OPTIONS: Options = MappingProxyType({})


class Option(NamedTuple):
    """A choice that a format leaves to its user; the command line has it as `--NAME`."""

    name: str
    choices: tuple[str, ...]
    default: str
    help: str

    def value(self, options: Options) -> str:
        """Return the value of this option.

        Raises:
            ValueError: for a value that is not one of the choices.

        """
        value = options.get(self.name, self.default)
        if value not in self.choices:
            raise ValueError(f"{self.name} takes {' or '.join(map(repr, self.choices))}, found {value!r}")
        return value


class Document(NamedTuple):
    """A file of a rendered robot.

    `name` is its path below the target, empty for a format that writes a single file. `map` is None unless requested.
    """

    text: str
    name: str = ""
    map: SourceMap | None = None


class Rendering(NamedTuple):
    """How to render: `banner` is a comment at the top, `templates` are a user's, which replace the packaged ones."""

    options: Options = NO_OPTIONS
    pretty: bool = True
    banner: str | None = None
    templates: Templates = None
    has_map: bool = False


DEFAULT_RENDERING = Rendering()


class Format(ABC):
    """A text format that robots are compiled to. `formats.FORMATS` lists the instances."""

    name: str
    """What `--format` accepts; the folder of its templates, and what user templates call its view."""

    suffix: str
    """The ending of its file's name, or of its folder's name for a format of several files."""

    description: str
    """One line for the help."""

    is_default: bool = False
    """Whether it is written to a folder, and `check` reports its limits, without being requested."""

    has_relative_paths: bool = False
    """Whether relative paths of meshes in its documents start at the folder of the document."""

    options: tuple[Option, ...] = ()

    @abstractmethod
    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        """Return the documents of a robot.

        Raises:
            RobotGeneratorError: for a robot that the format cannot hold; `limits` reports it first.

        """

    def limits(self, robot: Robot, options: Options) -> Iterable[Diagnostic]:
        """Return what the format, or its common readers, cannot hold of a robot."""
        return ()

    def missing(self, robot: Robot) -> Diagnostic | None:
        """Return why the format has nothing to write for a robot; None where it has."""
        return None

    def file_names(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of the documents that `render` makes, without rendering."""
        return ("",)

    def view(self, robot: Robot, options: Options) -> object:
        """Return what a user's templates see of a robot under the name of the format; None for nothing."""
        return None
