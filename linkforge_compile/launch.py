"""For launch files of ROS 2: a robot compiled when it is launched, its spec's parameters being launch arguments.

from linkforge_compile.launch import RobotDescription

robot = RobotDescription("robots/arm.robot.yaml")
LaunchDescription([
    *robot.arguments,
    Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[robot.description]),
])
"""

from __future__ import annotations

import atexit
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from time import time_ns
from typing import TYPE_CHECKING, NamedTuple, TypeAlias
from weakref import ref

import launch.logging
from launch.actions import DeclareLaunchArgument
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.parameter_descriptions import ParameterValue

from linkforge_compile.expand.arguments import names_in_variant
from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.formats import NO_OPTIONS, SRDF, URDF, Format, Options, Rendering, format_named, require_options
from linkforge_compile.load import is_xacro
from linkforge_compile.pipeline import CliArgument, CompileError, Packages, compile_file, parameters_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launch import LaunchContext

    from linkforge_compile.core import Robot
    from linkforge_compile.formats.urdf import Gazebo
    from linkforge_compile.listing import ListedParameter

    Values: TypeAlias = tuple[str | None, Mapping[str, CliArgument], tuple[str, ...]]
    Words: TypeAlias = str | Substitution | Sequence[str | Substitution]
    Given: TypeAlias = Mapping[str, bool | int | float | Words | Sequence[float | str | Substitution]]

__all__ = ["RobotDescription"]


class _Text(Substitution):  # type: ignore[misc]  # the launch package has no types
    """A text that is made of the robot when it is launched: a document of a format."""

    def __init__(self, robot: RobotDescription, format_: Format, document: str) -> None:
        super().__init__()
        self._robot, self._format, self._document = robot, format_, document

    def describe(self) -> str:
        return f"{' '.join(filter(None, (self._format.name.upper(), self._document)))} of {self._robot.spec}"

    def perform(self, context: LaunchContext) -> str:
        return self._robot.compiled(context).text(self._format, self._document)


class _File(_Text):
    """The path of a file with such a text, which is written when it is launched."""

    def perform(self, context: LaunchContext) -> str:
        name = f"{self._robot.spec.name.partition('.')[0]}{self._format.suffix}"
        path = self._robot.folder / name / self._document
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(super().perform(context), "utf-8")
        return str(path)


class _TextParameter(ParameterValue):  # type: ignore[misc]  # the launch_ros package has no types
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
        # Another launch reports the warnings as well, and may have another environment.
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
        be a substitution, too; one that gives no text is no variant.

        `argument_prefix` stands before the names of the launch arguments, for two robots in one launch file.

        Raises:
            CompileError: The parameters of the spec cannot be listed.
            TypeError: A value is nothing that a launch file can give, or the parameters are no map.
            ValueError: The spec has no such variant or parameter, or no format has such an option.

        """
        if not isinstance(parameters, Mapping | None):
            raise TypeError(f"the parameters are values by name, {{'NAME': VALUE}}; found {parameters!r}")
        variant = None if variant == "" else variant
        self.spec, self._options = Path(spec), {"gazebo": gazebo, **options}
        require_options(self._options)
        self._formats: dict[str, Format] = {}
        self._given = {name: _substitutions(name, value) for name, value in (parameters or {}).items()}
        self._variant: list[Substitution] | None = None if variant is None else _substitutions("variant", variant)
        self._packages, self._prefix = packages, argument_prefix
        self._allow_outside = allow_outside
        listing, diagnostics = parameters_of(self.spec, packages=packages, allow_outside=allow_outside)
        if listing is None:
            raise CompileError(diagnostics)
        self._listing = listing
        self._refuse_unknown()
        # Of a variant that is known at a launch only, the defaults that show are those of the spec.
        sets = self._sets_of(variant) if isinstance(variant, str) else {}
        self._defaults = {one.name: sets.get(one.name, one.default) for one in listing.parameters}
        self.arguments = [self._argument(one) for one in listing.parameters if one.name not in self._given]
        self._compiled: _Compiled | None = None
        self.urdf, self.srdf = _Text(self, URDF, ""), _Text(self, SRDF, "")
        self.description = {"robot_description": _TextParameter(self.urdf, value_type=str)}
        self.semantic = {"robot_description_semantic": _TextParameter(self.srdf, value_type=str)}

    def text(self, format_: str, document: str = "", /) -> Substitution:
        """Return the text in a format, by its name, as a substitution.

        `document` is the path of one of several files, such as `config/kinematics.yaml`.

        Raises:
            ValueError: There is no such format, or it has no such file.

        """
        return _Text(self, self._requested(format_, document), document)

    def file(self, format_: str, document: str = "", /) -> Substitution:
        """Return the path of a file with the text in a format as a substitution; it is removed after the launch.

        In the `parameters` of a node it is a file of parameters, such as that of ros2_control.

        Raises:
            ValueError: There is no such format, or it has no such file.

        """
        return _File(self, self._requested(format_, document), document)

    def _requested(self, name: str, document: str) -> Format:
        chosen = format_named(name)
        if document not in (chosen.files or ("",)):
            files = f"has the files {', '.join(chosen.files)}" if chosen.files else "is a single file"
            raise ValueError(f"the format {name} {files}, found '{document}'")
        self._formats[name] = chosen
        return chosen

    @cached_property
    def folder(self) -> Path:
        """The folder of the files of a launch, which is removed when Python ends."""
        folder = Path(mkdtemp(prefix="linkforge_launch_"))
        atexit.register(rmtree, folder, ignore_errors=True)
        return folder

    def _argument(self, parameter: ListedParameter) -> DeclareLaunchArgument:
        default = self._defaults[parameter.name]
        choices = None
        # launch compares texts: of a quantity or a flag there are many, and the compiler judges those.
        if parameter.choices and parameter.type in {"string", "integer"}:
            texts = list(map(str, parameter.choices))
            choices = texts if default is None or default in texts else None
        about = ", ".join(filter(None, (parameter.type, "" if choices else parameter.limits)))
        description = f"{' '.join(parameter.description.split())} {f'({about})' if about else ''}".strip()
        return DeclareLaunchArgument(
            self._prefix + parameter.name, default_value=default, description=description, choices=choices
        )

    def _refuse_unknown(self) -> None:
        # What a xacro file includes may depend on its arguments, and declare more.
        if is_xacro(self.spec):
            return
        declared = [one.name for one in self._listing.parameters]
        for name in self._given:
            if name not in declared:
                from linkforge_compile.diagnostics.suggest import did_you_mean

                there_are = f"; its parameters are {', '.join(declared)}" if declared else "; it declares no parameters"
                raise ValueError(
                    f"{self.spec} has no parameter named '{name}'{did_you_mean(name, declared) or there_are}"
                )

    def compiled(self, context: LaunchContext) -> _Compiled:
        """Compile the spec with the values of a launch, and report in the launch's log.

        All texts share one compile, until a file of the robot changes.

        Raises:
            SubstitutionFailure: The spec has errors, a parameter no value, or it has no such variant.

        """
        variant, values = self._variant_of(context), self._assignments(context)
        self._require_values(variant, values)
        key = (variant, values, tuple(self._formats))
        if self._compiled is None or not self._compiled.is_current(context, key):
            began, files = time_ns(), FileWatcher(())
            robot, read = self._compile(variant, values)
            files.track(read, began)
            self._compiled = _Compiled(ref(context), key, files, robot, self._options)
        return self._compiled

    def _compile(self, variant: str | None, values: Mapping[str, CliArgument]) -> tuple[Robot, Sequence[Path]]:
        """Return the robot, and the files on which it depends, those that are missing as well."""
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
        from linkforge_compile.diagnostics.render_text import render_text

        if compilation.robot is None:
            raise SubstitutionFailure(f"{self.spec} has errors:\n{render_text(compilation.diagnostics)}")
        logger = launch.logging.get_logger("linkforge")
        for severity, log in ((Severity.WARNING, logger.warning), (Severity.NOTE, logger.info)):
            if selected := tuple(one for one in compilation.diagnostics if one.severity is severity):
                log(render_text(selected))
        return compilation.robot, (*compilation.files, *compilation.unread)

    def _require_values(self, variant: str | None, values: Mapping[str, CliArgument]) -> None:
        """Refuse values in words that suit launch files; the compiler's name options of the command."""
        try:
            sets = self._sets_of(variant)
        except ValueError as error:
            raise SubstitutionFailure(str(error)) from None
        set_ = values.keys() | sets.keys()
        missed = [one.name for one in self._listing.parameters if one.is_required and one.name not in set_]
        if missed:
            names = ", ".join(f"'{self._prefix}{name}'" for name in missed)
            raise SubstitutionFailure(
                f"{self.spec} needs launch arguments that have no value: {names}; "
                "the 'arguments' of RobotDescription, put into the launch description, declare them"
            )

    def _sets_of(self, variant: str | None) -> Mapping[str, str]:
        """Return what a variant sets, or several (`a+b`); ValueError for one that the spec does not have."""
        variants = self._listing.variants
        sets: dict[str, str] = {}
        for name in names_in_variant(variant, variants):
            if name not in variants:
                from linkforge_compile.diagnostics.suggest import did_you_mean

                there_are = f"; its variants are {', '.join(variants)}" if variants else "; it declares no variants"
                hint = did_you_mean(name, variants) or there_are
                raise ValueError(f"{self.spec} has no variant named '{name}'{hint}")
            sets |= variants[name]
        return sets

    def _variant_of(self, context: LaunchContext) -> str | None:
        return None if self._variant is None else str(perform_substitutions(context, self._variant)) or None

    def _assignments(self, context: LaunchContext) -> dict[str, CliArgument]:
        """Return what sets parameters; one that has its default is left to the spec, which may compute it."""
        values = {
            name: CliArgument("<launch file>", name, perform_substitutions(context, value))
            for name, value in self._given.items()
        }
        for name, default in self._defaults.items():
            spelt = self._prefix + name
            value = context.launch_configurations.get(spelt)
            if name not in values and value is not None and value != default:
                values[name] = CliArgument("<launch argument>", spelt, value)
        return values


def _substitutions(name: str, value: object) -> list[Substitution]:
    """Return what gives the text of a value; TypeError, which names the parameter, for one that no launch file has."""
    if isinstance(value, bool):
        value = "true" if value else "false"
    elif isinstance(value, int | float):
        value = _number(value)
    elif isinstance(value, list | tuple) and any(isinstance(item, int | float) for item in value):
        value = _vector(value)
    try:
        if isinstance(value, Mapping):
            raise TypeError  # launch would take its keys
        normal: list[Substitution] = normalize_to_list_of_substitutions(value)
    except TypeError:
        raise TypeError(
            f"'{name}' takes text, a number, true or false, a list of numbers, or substitutions; found {value!r}"
        ) from None
    return normal


def _number(value: float) -> str:
    # numpy's are floats that show as another thing.
    return repr(int(value)) if isinstance(value, int) else repr(float(value))


def _vector(items: Sequence[object]) -> list[object]:
    """Return the parts of the text `[1, 2, 3]`, in which an item may be a substitution."""
    parts: list[object] = []
    for item in items:
        parts += [", " if parts else "[", _number(item) if isinstance(item, int | float) else item]
    return [*parts, "]"]
