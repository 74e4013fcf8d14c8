class LaunchContext:
    """What holds in one launch: arguments by name, all of them text."""

    def __init__(self, **configurations):
        self.launch_configurations = dict(configurations)


class LaunchDescription:
    def __init__(self, entities):
        self.entities = list(entities)
