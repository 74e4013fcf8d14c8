"""`RobotDescription`: a spec that is compiled when it is launched."""

from __future__ import annotations

import atexit
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from time import time_ns
from typing import TYPE_CHECKING, NamedTuple, TypeAlias
from weakref import ref

import launch.logging
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch_ros.parameter_descriptions import ParameterValue

from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.formats import NO_OPTIONS, SRDF, URDF, Format, Options, Rendering, format_named, require_options
from linkforge_compile.launch.arguments import LaunchArguments
from linkforge_compile.pipeline import CliArgument, CompileError, Packages, compile_file, parameters_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from launch import LaunchContext

    from linkforge_compile.core import Robot
    from linkforge_compile.formats.urdf import Gazebo
    from linkforge_compile.launch.arguments import Given, Words

    Values: TypeAlias = tuple[str | None, Mapping[str, CliArgument], tuple[str, ...]]


class LaunchedText(Substitution):  # type: ignore[misc]  # the launch package has no types
    """A text that is made at launch; `title` describes it."""

    def __init__(self, title: str, make: Callable[[LaunchContext], str]) -> None:
        super().__init__()
        self._title, self._make = title, make

    def describe(self) -> str:
        return self._title

    def perform(self, context: LaunchContext) -> str:
        return self._make(context)


class LaunchedFile(Substitution):  # type: ignore[misc]  # the launch package has no types
    """The path of a file with a text, which is written at launch by `make_path`."""

    def __init__(self, text: LaunchedText, make_path: Callable[[], Path]) -> None:
        super().__init__()
        self._text, self._make_path = text, make_path

    def describe(self) -> str:
        return self._text.describe()

    def perform(self, context: LaunchContext) -> str:
        path = self._make_path()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(self._text.perform(context), "utf-8")
        return str(path)


class TextParameter(ParameterValue):  # type: ignore[misc]  # the launch_ros package has no types
    """A text as a ROS parameter, evaluated anew each time; ParameterValue keeps its first value, in any launch."""

    def evaluate(self, context: LaunchContext) -> str:
        # Without a type, ROS would read the text as YAML.
        return str(ParameterValue(self.value, value_type=str).evaluate(context))


class _Compiled(NamedTuple):
    """The robot of one compile, with its launch, its variant, values and formats, and its files."""

    launch: ref[LaunchContext]
    values: Values
    files: FileWatcher
    robot: Robot
    options: Options

    def is_current(self, context: LaunchContext, values: Values) -> bool:
        # Another launch reports the warnings again, and may have a different environment.
        return self.launch() is context and self.values == values and not self.files.poll()

    def text(self, format_: Format, document: str) -> str:
        """Return a document of a format; SubstitutionFailure if there is nothing to write for the robot."""
        if not format_.is_default and (missing := format_.missing(self.robot)):
            raise SubstitutionFailure(str(missing))
        documents = format_.render(self.robot, Rendering(self.options))
        return next(one.text for one in documents if one.name == document)


class RobotDescription:
    """A spec that is compiled when it is launched, with the values that its launch arguments then have.

    `urdf` and `srdf` are substitutions: texts for any argument that accepts one, and `text(FORMAT)` is that of another
    format, `file(FORMAT)` the path of a file with it. `description` and `semantic` are the URDF and SRDF as the ROS
    parameters `robot_description` and `robot_description_semantic`. `arguments` declares a launch argument for each
    parameter of the spec that is not given here.
    """

    def __init__(
        self,
        spec: str | Path,
        parameters: Given | None = None,
        *,
        variant: Words | None = None,
        packages: Packages | None = None,
        gazebo: Gazebo = "gz",
        options: Options = NO_OPTIONS,
        allow_outside: bool = False,
        argument_prefix: str = "",
    ) -> None:
        """`parameters` are values or substitutions; the other words are those of `compile_file`.

        A list with a number in it is a vector; any other is one text in parts, as everywhere in launch. `variant` may
        be a substitution, too; an empty text selects no variant.

        `argument_prefix` precedes the names of the launch arguments, for two robots in one launch file.

        Raises:
            CompileError: The parameters of the spec cannot be listed.
            TypeError: A launch file cannot give a value of this type, or the parameters are not a map.
            ValueError: The spec has no such variant or parameter, or no format has such an option.

        """
        self.spec, self._options = Path(spec), {"gazebo": gazebo, **options}
        require_options(self._options)
        self._packages, self._allow_outside = packages, allow_outside
        listing, diagnostics = parameters_of(self.spec, packages=packages, allow_outside=allow_outside)
        if listing is None:
            raise CompileError(diagnostics)
        self._arguments = LaunchArguments(self.spec, listing, parameters, variant=variant, prefix=argument_prefix)
        self.arguments = self._arguments.declarations()
        self._formats: dict[str, Format] = {}
        self._compiled: _Compiled | None = None
        self.urdf, self.srdf = self._text(URDF, ""), self._text(SRDF, "")
        self.description = {"robot_description": TextParameter(self.urdf, value_type=str)}
        self.semantic = {"robot_description_semantic": TextParameter(self.srdf, value_type=str)}

    def text(self, format_: str, document: str = "", /) -> Substitution:
        """Return the text in a format, by its name, as a substitution.

        `document` is the path of one of several files, such as `config/kinematics.yaml`.

        Raises:
            ValueError: There is no such format, or it has no such file.

        """
        return self._text(self._requested(format_, document), document)

    def file(self, format_: str, document: str = "", /) -> Substitution:
        """Return the path of a file with the text in a format as a substitution; it is removed after the launch.

        In the `parameters` of a node it is a file of parameters, such as that of ros2_control.

        Raises:
            ValueError: There is no such format, or it has no such file.

        """
        chosen = self._requested(format_, document)
        path = Path(f"{self.spec.name.partition('.')[0]}{chosen.suffix}", document)
        return LaunchedFile(self._text(chosen, document), lambda: self._folder / path)

    def _text(self, format_: Format, document: str) -> LaunchedText:
        title = f"{' '.join(filter(None, (format_.name.upper(), document)))} of {self.spec}"
        return LaunchedText(title, lambda context: self._compiled_for(context).text(format_, document))

    def _requested(self, name: str, document: str) -> Format:
        chosen = format_named(name)
        if document not in (chosen.files or ("",)):
            files = f"has the files {', '.join(chosen.files)}" if chosen.files else "is a single file"
            raise ValueError(f"the format {name} {files}, found '{document}'")
        self._formats[name] = chosen
        return chosen

    @cached_property
    def _folder(self) -> Path:
        """The folder of the files of a launch, which is removed when Python ends."""
        folder = Path(mkdtemp(prefix="linkforge_launch_"))
        atexit.register(rmtree, folder, ignore_errors=True)
        return folder

    def _compiled_for(self, context: LaunchContext) -> _Compiled:
        """Compile the spec with the values of a launch, and report in the launch's log.

        All texts share one compile, until a file of the robot changes.

        Raises:
            SubstitutionFailure: The spec has errors, a parameter no value, or it has no such variant.

        """
        variant, values = self._arguments.values(context)
        key = (variant, values, tuple(self._formats))
        if self._compiled is None or not self._compiled.is_current(context, key):
            began, files = time_ns(), FileWatcher(())
            robot, read = self._compile(variant, values)
            files.track(read, began)
            self._compiled = _Compiled(ref(context), key, files, robot, self._options)
        return self._compiled

    def _compile(self, variant: str | None, values: Mapping[str, CliArgument]) -> tuple[Robot, Sequence[Path]]:
        """Return the robot and the files on which it depends, including missing ones."""
        compilation = compile_file(
            self.spec,
            parameters=values,
            packages=self._packages,
            variant=variant,
            formats=self._formats,
            options=self._options,
            allow_outside=self._allow_outside,
        )
        from linkforge_compile.diagnostics import Severity
        from linkforge_compile.diagnostics.render_text import render_first, render_text

        if compilation.robot is None:
            from linkforge_compile.diagnostics.reports import count_losses

            shown = count_losses(compilation.diagnostics, [compilation.diagnostics])
            raise SubstitutionFailure(f"{self.spec} has errors:\n{render_first(shown)}")
        logger = launch.logging.get_logger("linkforge")
        for severity, log in ((Severity.WARNING, logger.warning), (Severity.NOTE, logger.info)):
            if selected := tuple(one for one in compilation.diagnostics if one.severity is severity):
                log(render_text(selected))
        return compilation.robot, (*compilation.files, *compilation.unread)
