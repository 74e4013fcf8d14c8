class Node:
    def __init__(self, *, package, executable, parameters=()):
        self.package, self.executable, self.parameters = package, executable, list(parameters)
