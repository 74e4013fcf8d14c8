from pathlib import Path

from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from launch_ros.parameter_descriptions import ParameterValue


def normalize_parameters(parameters):
    """Return maps of values by tuples of substitutions, whose values are ParameterValue, and paths of files."""
    return tuple(
        {tuple(normalize_to_list_of_substitutions(name)): _require_value(value) for name, value in given.items()}
        if isinstance(given, dict)
        else tuple(normalize_to_list_of_substitutions(given))
        for given in parameters
    )


def _require_value(value):
    assert isinstance(value, ParameterValue)
    return value


def evaluate_parameters(context, parameters):
    return tuple(
        {perform_substitutions(context, name): value.evaluate(context) for name, value in given.items()}
        if isinstance(given, dict)
        else Path(perform_substitutions(context, given))
        for given in parameters
    )
