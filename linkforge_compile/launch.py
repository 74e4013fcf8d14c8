"""For launch files of ROS 2: a robot compiled when it is launched, its spec's parameters being launch arguments.

from linkforge_compile.launch import RobotDescription

robot = RobotDescription("robots/arm.robot.yaml")
LaunchDescription([
    *robot.arguments,
    Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[robot.description]),
])
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import launch.logging
from launch.actions import DeclareLaunchArgument
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.parameter_descriptions import ParameterValue

from linkforge_compile.pipeline import CompileError, ListedParameter, Packages, compile_file, parameters_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launch import LaunchContext

    from linkforge_compile.backends.urdf.sensor import Gazebo
    from linkforge_compile.core import Robot

    Given: TypeAlias = Mapping[str, bool | int | float | str | Substitution | Sequence[str | Substitution]]

__all__ = ["RobotDescription"]


class _Text(Substitution):  # type: ignore[misc]  # the launch package has no types
    """A text that is made of the robot when it is launched."""

    def __init__(self, robot: RobotDescription, *, semantic: bool) -> None:
        super().__init__()
        self._robot, self._semantic = robot, semantic

    def describe(self) -> str:
        return f"{'SRDF' if self._semantic else 'URDF'} of {self._robot.spec}"

    def perform(self, context: LaunchContext) -> str:
        from linkforge_compile.backends import render_srdf, render_urdf

        robot = self._robot.compiled(context, is_telling=not self._semantic)
        return render_srdf(robot) if self._semantic else render_urdf(robot, gazebo=self._robot.gazebo)


class RobotDescription:
    """A spec that is compiled when it is launched, with the values that its launch arguments then have.

    `urdf` and `srdf` are substitutions: texts for whatever takes one. `description` and `semantic` are those texts as
    the ROS parameters `robot_description` and `robot_description_semantic`. `arguments` declares a launch argument for
    each parameter of the spec that is not given here.
    """

    def __init__(
        self,
        spec: str | Path,
        parameters: Given | None = None,
        *,
        variant: str | None = None,
        packages: Packages | None = None,
        gazebo: Gazebo = "gz",
        allow_outside: bool = False,
        argument_prefix: str = "",
    ) -> None:
        """`parameters` are values or substitutions; the other words are those of `compile_file`.

        `argument_prefix` stands before the names of the launch arguments, for two robots in one launch file.

        Raises:
            CompileError: The parameters of the spec cannot be listed.

        """
        self.spec, self.gazebo = Path(spec), gazebo
        self._given = {name: _substitutions(value) for name, value in (parameters or {}).items()}
        self._variant, self._packages, self._prefix = variant, packages, argument_prefix
        self._allow_outside = allow_outside
        listing, diagnostics = parameters_of(self.spec, allow_outside=allow_outside)
        if listing is None:
            raise CompileError(diagnostics)
        sets = listing.variants.get(variant, {}) if variant is not None else {}
        self._defaults = {one.name: sets.get(one.name, one.default) for one in listing.parameters}
        self.arguments = [self._argument(one) for one in listing.parameters if one.name not in self._given]
        self.urdf, self.srdf = _Text(self, semantic=False), _Text(self, semantic=True)
        # Without a type, ROS would read the text as YAML.
        self.description = {"robot_description": ParameterValue(self.urdf, value_type=str)}
        self.semantic = {"robot_description_semantic": ParameterValue(self.srdf, value_type=str)}

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

    def compiled(self, context: LaunchContext, *, is_telling: bool) -> Robot:
        """Compile the spec with the values that hold in a launch; `is_telling` logs warnings.

        Raises:
            SubstitutionFailure: The spec has errors.

        """
        compilation = compile_file(
            self.spec,
            parameters=self._assignments(context),
            packages=self._packages,
            variant=self._variant,
            gazebo=self.gazebo,
            allow_outside=self._allow_outside,
        )
        from linkforge_compile.diagnostics.render import render_text

        told = render_text(compilation.diagnostics)
        if compilation.robot is None:
            raise SubstitutionFailure(f"{self.spec} has errors:\n{told}")
        if told and is_telling:
            launch.logging.get_logger("linkforge").warning(told)
        return compilation.robot

    def _assignments(self, context: LaunchContext) -> list[str]:
        """Return what sets parameters; one that has its default is left to the spec, which may compute it."""
        values = {name: perform_substitutions(context, value) for name, value in self._given.items()}
        for name, default in self._defaults.items():
            value = context.launch_configurations.get(self._prefix + name)
            if name not in values and value is not None and value != default:
                values[name] = value
        return [f"{name}:={value}" for name, value in values.items()]


def _substitutions(value: object) -> list[Substitution]:
    if isinstance(value, bool):
        return _substitutions("true" if value else "false")
    if isinstance(value, int | float):
        return _substitutions(repr(value))
    normal: list[Substitution] = normalize_to_list_of_substitutions(value)
    return normal
