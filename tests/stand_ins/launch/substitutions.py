import shlex
import subprocess

import launch.logging
from launch.substitution import Substitution


class SubstitutionFailure(RuntimeError):  # noqa: N818 as ROS calls it
    pass


class TextSubstitution(Substitution):
    def __init__(self, *, text):
        if not isinstance(text, str):
            raise TypeError(f"text is no text: {text!r}")
        self.text = text

    def perform(self, context):
        return self.text


class LaunchConfiguration(Substitution):
    """The value of a launch argument."""

    def __init__(self, name):
        self.name = name

    def perform(self, context):
        if self.name not in context.launch_configurations:
            raise SubstitutionFailure(f"launch configuration '{self.name}' does not exist")
        return context.launch_configurations[self.name]


class Command(Substitution):
    """What a command prints; it fails where there is anything on standard error, unless `on_stderr` is otherwise."""

    def __init__(self, command, *, on_stderr="fail"):
        self.command, self.on_stderr = command, on_stderr

    def perform(self, context):
        from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

        text = perform_substitutions(context, normalize_to_list_of_substitutions(self.command))
        run = subprocess.run(shlex.split(text), capture_output=True, text=True, check=False)
        if run.returncode or (run.stderr and self.on_stderr == "fail"):
            raise SubstitutionFailure(f"executed command showed stderr output. Command: {text}\n{run.stderr}")
        if run.stderr and self.on_stderr == "warn":
            launch.logging.get_logger().warning(run.stderr)
        return run.stdout
