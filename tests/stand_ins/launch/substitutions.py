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
