import yaml
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class ParameterValue:
    """A value of a ROS parameter; without a type, its text is read as YAML."""

    def __init__(self, value, *, value_type=None):
        self.value, self.value_type = normalize_to_list_of_substitutions(value), value_type

    def evaluate(self, context):
        text = perform_substitutions(context, self.value)
        return text if self.value_type is str else yaml.safe_load(text)
