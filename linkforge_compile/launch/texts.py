"""Texts that are made when a robot is launched: as substitutions, as paths of files, and as ROS parameters."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from launch.substitution import Substitution
from launch_ros.parameter_descriptions import ParameterValue

if TYPE_CHECKING:
    from launch import LaunchContext


class LaunchedText(Substitution):  # type: ignore[misc]  # the launch package has no types
    """A text that is made when it is launched; `title` is shown for it."""

    def __init__(self, title: str, make: Callable[[LaunchContext], str]) -> None:
        super().__init__()
        self._title, self._make = title, make

    def describe(self) -> str:
        return self._title

    def perform(self, context: LaunchContext) -> str:
        return self._make(context)


class LaunchedFile(Substitution):  # type: ignore[misc]  # the launch package has no types
    """The path of a file with a text, which is written when it is launched; `make_path` is called then."""

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
