"""LF31xx: `$(...)` and the quantities in it."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

UNREADABLE_EXPRESSION = Code("LF3101", Severity.ERROR, "cannot read this expression: {problem}")
UNCLOSED_EXPRESSION = Code("LF3102", Severity.ERROR, "'$(' has no closing ')'; text that means it is written '$$('")
UNCLOSED_TEXT = Code("LF3103", Severity.ERROR, "no closing quote for the text that begins here")
EMPTY_EXPRESSION = Code("LF3104", Severity.ERROR, "expected an expression between '$(' and ')', found nothing")
EXPRESSION_TOO_LARGE = Code("LF3105", Severity.ERROR, "the expression {fault}; move parts of it into 'variables'")
NOT_IN_EXPRESSIONS = Code("LF3106", Severity.ERROR, "{what} cannot stand in an expression; {instead}")
UNKNOWN_NAME = Code(
    "LF3107", Severity.ERROR, "no parameter, variable or 'for' name '{name}' here{hint}", is_of_a_name=True
)
UNKNOWN_FUNCTION = Code("LF3108", Severity.ERROR, "no function named '{name}'")
FUNCTION_NOT_CALLED = Code("LF3110", Severity.ERROR, "'{function}' is a function; write {signature}")
WRONG_ARGUMENT_COUNT = Code("LF3111", Severity.ERROR, "expected {signature}, found {count} arguments")

WRONG_KIND = Code("LF3121", Severity.ERROR, "{operation} takes {expected}, found {found}", Location.DATA)
DIMENSIONS_DIFFER = Code(
    "LF3122", Severity.ERROR, "{operation} takes values of one dimension, found {left} and {right}"
)
WRONG_DIMENSION = Code("LF3123", Severity.ERROR, "{operation} takes {expected}, found {found}")
KINDS_DIFFER = Code("LF3124", Severity.ERROR, "{operation} compares values of one kind, found {left} and {right}")
DIVISION_BY_ZERO = Code("LF3125", Severity.ERROR, "{operation} divides by zero")
OUTSIDE_DOMAIN = Code("LF3126", Severity.ERROR, "{operation} takes {expected}, found {found}")
RESULT_TOO_LARGE = Code("LF3127", Severity.ERROR, "the result of {operation} is not a finite number")
TEXT_TOO_LONG = Code("LF3128", Severity.ERROR, "the text grows beyond {limit} characters")
UNKNOWN_KEY = Code("LF3129", Severity.ERROR, "no key '{name}' in this map")
NO_SUCH_ITEM = Code("LF3130", Severity.ERROR, "no item {index} in a list of {length}; the first is 0")
NOT_TEXT = Code("LF3131", Severity.ERROR, "{found} cannot stand inside text")

CIRCULAR_NAMES = Code("LF3141", Severity.ERROR, "'{first}' is computed from itself: {path}")
CHAIN_TOO_LONG = Code("LF3142", Severity.ERROR, "'{first}' is computed through {count} other names")
TRUTH_AS_TEXT = Code(
    "LF3143", Severity.ERROR, "'{name}' is text in YAML 1.2, not true or false; write {meant}", Location.VALUE
)
WIDE_LITERAL = Code(
    "LF3144",
    Severity.WARNING,
    "{function}() of {found} radians, more than a whole turn; write '{function}(radians({found}))' for degrees",
)

SEEN_IN_THE_TEXT = (
    *(UNREADABLE_EXPRESSION, UNCLOSED_EXPRESSION, UNCLOSED_TEXT, EMPTY_EXPRESSION, EXPRESSION_TOO_LARGE),
    *(NOT_IN_EXPRESSIONS, UNKNOWN_NAME, UNKNOWN_FUNCTION, FUNCTION_NOT_CALLED, WRONG_ARGUMENT_COUNT),
    *(CIRCULAR_NAMES, CHAIN_TOO_LONG),
)
"""The faults that an expression has whatever the values of its names are."""
