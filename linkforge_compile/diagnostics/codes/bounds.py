"""LF33xx: the limits that all files of one compile share."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

BEYOND_LIMIT = Code(
    "LF3301",
    Severity.ERROR,
    "the robot takes more than {most} {counted}; {way_out} (LINKFORGE_LIMITS=10 in the environment allows ten times "
    "as much)",
    in_xml="a spec of this robot takes more than {most} {counted}; for one of your own, LINKFORGE_LIMITS=10 in the "
    "environment allows ten times as much",
    ends_report=True,
)
TOO_MANY_ERRORS = Code("LF3302", Severity.ERROR, "too many {what}; stopping here", ends_report=True)
MORE_WARNINGS = Code("LF3303", Severity.WARNING, "{count} more warnings and notes are not shown", ends_report=True)
VARIANTS_BEYOND_LIMIT = Code(
    "LF3304",
    Severity.ERROR,
    "the spec with all its variants takes more than {most} {counted}; check them one at a time with "
    "'--variant' (LINKFORGE_LIMITS=10 in the environment allows ten times as much)",
    ends_report=True,
)
