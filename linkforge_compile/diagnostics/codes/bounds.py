"""LF33xx: the limits that all files of one compile share."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

BEYOND_LIMIT = Code(
    "LF3301",
    Severity.ERROR,
    "the robot takes more than {most} {counted}; {way_out} (LINKFORGE_LIMITS=10 in the environment allows ten times "
    "as much)",
)
TOO_MANY_ERRORS = Code(
    "LF3302", Severity.ERROR, "nothing is read behind so many {what}; mend some of them first", is_last=True
)
MORE_WARNINGS = Code("LF3303", Severity.WARNING, "{count} more warnings and notes are not told")

ENDS_OF_A_REPORT = (BEYOND_LIMIT, TOO_MANY_ERRORS, MORE_WARNINGS)
"""What says that there is more than is told."""
