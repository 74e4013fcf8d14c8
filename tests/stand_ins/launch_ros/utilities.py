from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from launch_ros.parameter_descriptions import ParameterValue


def normalize_parameters(parameters):
    """Return maps of values by tuples of substitutions; the values here are all ParameterValue."""
    assert all(isinstance(value, ParameterValue) for given in parameters for value in given.values())
    return tuple(
        {tuple(normalize_to_list_of_substitutions(name)): value for name, value in given.items()}
        for given in parameters
    )


def evaluate_parameters(context, parameters):
    return tuple(
        {perform_substitutions(context, name): value.evaluate(context) for name, value in given.items()}
        for given in parameters
    )
