"""The `linkforge` command: its exit codes and errors. Only this package prints and exits."""

OK, FAULTY_SPEC, WRONG_USAGE, INTERNAL_FAULT, INTERRUPTED = 0, 1, 2, 70, 130
"""70 is EX_SOFTWARE of sysexits.h, 130 what a shell returns after Ctrl-C."""


class UsageError(Exception):
    """The command line is wrong; the message is printed after the command's name, with exit code 2."""
