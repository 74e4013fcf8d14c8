class Substitution:
    """A text that is known when it is launched."""

    def describe(self):
        return repr(self)

    def perform(self, context):
        raise NotImplementedError
