class LaunchContext:
    """What holds in one launch: arguments by name, all of them text."""

    def __init__(self):
        self.launch_configurations = {}


class LaunchDescription:
    def __init__(self, initial_entities):
        self.entities = list(initial_entities)
