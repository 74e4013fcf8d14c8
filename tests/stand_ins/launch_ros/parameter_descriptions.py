import yaml
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class ParameterValue:
    """A value of a ROS parameter; without a type, its text is read as YAML. The first value that it has is kept."""

    def __init__(self, value, *, value_type=None):
        self._value = (
            value if value_type is str and isinstance(value, str) else normalize_to_list_of_substitutions(value)
        )
        self.value_type = value_type

    @property
    def value(self):
        return self._value

    def evaluate(self, context):
        if isinstance(self._value, list):
            text = perform_substitutions(context, self._value)
            self._value = text if self.value_type is str else yaml.safe_load(text)
        return self._value
