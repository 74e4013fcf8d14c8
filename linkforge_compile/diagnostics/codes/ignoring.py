"""LF12xx: comments that ask not to be told something."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

IGNORE_WITHOUT_CODE = Code(
    "LF1201", Severity.WARNING, "this names no code to ignore; write '# linkforge: ignore' and codes such as LF6003"
)
IGNORE_OF_UNKNOWN_CODE = Code("LF1202", Severity.WARNING, "no diagnostic has the code '{name}'{hint}")
IGNORE_OF_ERROR = Code("LF1203", Severity.WARNING, "{code} is an error, which cannot be ignored")
NOTHING_TO_IGNORE = Code("LF1204", Severity.NOTE, "{code} is not reported on line {line}; remove it from this comment")
IGNORE_MISWRITTEN = Code("LF1275", Severity.WARNING, "this ignores nothing; write '# linkforge: ignore {codes}'")
