"""The `linkforge` command: the only room that prints and exits."""
