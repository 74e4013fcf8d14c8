from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class DeclareLaunchArgument:
    def __init__(self, name, *, default_value=None, description=None, choices=None):
        if choices is not None and not choices:
            raise RuntimeError("choices are empty")
        if choices is not None and isinstance(default_value, str) and default_value not in choices:
            raise RuntimeError(f"default {default_value!r} is none of {choices}")
        if description is not None and choices is not None:
            description = f"{description}{'' if description.endswith('.') else '.'} Valid choices are: {choices}"
        self.name, self.description, self.choices = name, description, choices
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def execute(self, context):
        values = context.launch_configurations
        if self.name not in values:
            if self.default_value is None:
                raise RuntimeError(f'Required launch argument "{self.name}" was not provided.')
            values[self.name] = perform_substitutions(context, self.default_value)
        if self.choices is not None and values[self.name] not in self.choices:
            raise RuntimeError(f"Argument {self.name!r}: {values[self.name]!r} is none of {self.choices}")
