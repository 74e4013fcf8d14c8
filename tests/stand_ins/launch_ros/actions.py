from launch_ros.utilities import normalize_parameters


class Node:
    def __init__(self, *, package, executable, parameters=None, arguments=None, remappings=None):
        if not isinstance(parameters, list | None):
            raise TypeError(f"'parameters' takes a list, found {parameters!r}")
        self.node_package, self.node_executable = package, executable
        self.__parameters = normalize_parameters(parameters or [])
