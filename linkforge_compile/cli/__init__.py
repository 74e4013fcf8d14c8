"""The `linkforge` command. Only this package prints and exits."""
