"""How a command ends."""

OK, FAULTY_SPEC, WRONG_USAGE, INTERNAL_FAULT, INTERRUPTED = 0, 1, 2, 70, 130
"""The exit codes: 70 is EX_SOFTWARE of sysexits.h, 130 what a shell gives after Ctrl-C."""


class UsageError(Exception):
    """The command line asks for what cannot be done; the message says what and why."""
