from pathlib import Path

from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from launch_ros.parameter_descriptions import ParameterValue


def normalize_parameters(parameters):
    """Return maps of values by tuples of substitutions, nested ones by names with dots, and paths of files."""
    return tuple(
        {tuple(normalize_to_list_of_substitutions(name)): _require_value(value) for name, value in _flat(given)}
        if isinstance(given, dict)
        else tuple(normalize_to_list_of_substitutions(given))
        for given in parameters
    )


def _flat(values, prefix=""):
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield (f"{prefix}{name}" if prefix else name), value


def _require_value(value):
    # A text would be read as YAML unless it is a ParameterValue; MoveIt's are never such texts.
    assert isinstance(value, ParameterValue | bool | int | float | str | list)
    assert value != []
    return value


def evaluate_parameters(context, parameters):
    return tuple(
        {perform_substitutions(context, name): _evaluate(context, value) for name, value in given.items()}
        if isinstance(given, dict)
        else Path(perform_substitutions(context, given))
        for given in parameters
    )


def _evaluate(context, value):
    return value.evaluate(context) if isinstance(value, ParameterValue) else value
