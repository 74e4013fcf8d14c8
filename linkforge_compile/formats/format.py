"""What an output format is: its name, options and limits, and how it renders a robot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.gc_paused import gc_paused

if TYPE_CHECKING:
    from pathlib import Path

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.source_map import Mapped, SourceMap
    from linkforge_compile.formats.user_templates import TemplateFolder


Options: TypeAlias = Mapping[str, str]
"""Values of the options that formats declare, by name; a missing one has its default."""

Templates: TypeAlias = "TemplateFolder | str | Path | None"
"""A user's folder of templates that replace the packaged ones of the same path; None for the packaged ones alone."""

NO_OPTIONS: Options = MappingProxyType({})

NO_YES = ("no", "yes")
"""The choices of an option that the command line has as a flag."""


class Option(NamedTuple):
    """A choice that a format leaves to its user; the command line has it as `--NAME`, a flag for `NO_YES`."""

    name: str
    choices: tuple[str, ...]
    default: str
    help: str

    @property
    def is_flag(self) -> bool:
        return self.choices == NO_YES

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

    files: tuple[str, ...] = ()
    """The paths of its documents below its folder; empty for a format of a single file. It makes all for any robot."""

    share_folder: str = "config"
    """The folder of a ROS package into which its files are installed; empty for the package's own."""

    description: str
    """One line for the help."""

    keeps: str
    """What it keeps of a robot, in one sentence."""

    loses: str
    """What it cannot hold of a robot, in one sentence; `limits` reports each such part."""

    is_default: bool = False
    """Whether it is written to a folder, and `check` reports its limits, if no format is requested."""

    has_urdf: bool = False
    """Whether a URDF is among its documents, so that what Gazebo makes of a URDF is checked."""

    has_relative_paths: bool = False
    """Whether relative paths of meshes in its documents start at the folder of the first document."""

    options: tuple[Option, ...] = ()

    @property
    def template_folders(self) -> tuple[str, ...]:
        """The folders of the templates that it renders."""
        return (self.name,)

    @abstractmethod
    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        """Return the documents of a robot.

        Raises:
            RobotGeneratorError: for a robot that the format cannot hold; `limits` reports it first.

        """

    def limits(self, robot: Robot, options: Options) -> Iterable[Diagnostic]:
        """Return what the format, or its common readers, cannot hold of a robot."""
        return ()

    def keeps_relative_paths(self, robot: Robot, options: Options) -> bool:
        """Whether the relative paths of a robot's meshes are in its documents."""
        return self.has_relative_paths

    def folder_of_documents(self, target: Path) -> Path:
        """Return the folder where relative paths start; `target` is its file, or the folder of its files."""
        return (target / self.files[0] if self.files else target).parent

    def missing(self, robot: Robot) -> Diagnostic | None:
        """Return why the format has nothing to write for a robot; None if it has something."""
        return None

    def sought_files(self, robot: Robot, options: Options) -> tuple[Path, ...]:
        """Return the files that documents of this format depend on: whether they exist, and where.

        Meshes are none of URDF, which refers to them as the spec does.
        """
        return ()

    def view(self, robot: Robot, options: Options) -> object:
        """Return what a user's templates see of a robot under the name of the format; None for nothing."""
        return None


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
        from linkforge_compile.formats.environment import render_own
        from linkforge_compile.formats.source_map import Mapped, SourceMap, recording
        from linkforge_compile.formats.xml_document import parse_rendered, write_with_map

        with recording() as origins:
            body = parse_rendered(render_own(self._template, self._views(robot, rendering)))
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
            from linkforge_compile.formats.environment import render_own
            from linkforge_compile.formats.xml_document import parse_rendered, write

            body = write(parse_rendered(render_own(self._template, views)), pretty=rendering.pretty)
        else:
            from linkforge_compile.formats.user_templates import TemplateFolder

            body = TemplateFolder.of(templates).xml(self._template, views, pretty=rendering.pretty)
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
    """Return what precedes the root element: the declaration, and the banner as a comment."""
    lines = ['<?xml version="1.0"?>', *([_comment(rendering)] if rendering.banner else [])]
    return "".join(f"{line}\n" if rendering.pretty else line for line in lines)


def _comment(rendering: Rendering) -> str:
    """Return the banner as a comment; what would end it, or what XML cannot hold, is replaced."""
    from linkforge_compile.formats.xml_text import harmless_in_comment

    lines = [line.strip() for line in harmless_in_comment(rendering.banner or "").splitlines()]
    if not rendering.pretty or len(lines) == 1:
        return f"<!-- {' '.join(lines)} -->"
    return "\n".join(["<!--", *(f"  {line}".rstrip() for line in lines), "-->"])
