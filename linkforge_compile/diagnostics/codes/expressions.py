"""LF31xx: `$(...)` and the quantities in it."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.source.provenance import Location

_E, _W = Severity.ERROR, Severity.WARNING
_DATA, _VALUE = Location.DATA, Location.VALUE

UNREADABLE_EXPRESSION = Code("LF3101", _E, "cannot read this expression: {problem}")
UNCLOSED_EXPRESSION = Code(
    "LF3102", _E, "'$(' has no closing ')'; for a literal '$(' write '$$('", fix=Replacement("$(", "$$(")
)
UNCLOSED_TEXT = Code("LF3103", _E, "no closing quote for the text that begins here")
EMPTY_EXPRESSION = Code("LF3104", _E, "expected an expression between '$(' and ')', found nothing")
EXPRESSION_TOO_LARGE = Code("LF3105", _E, "the expression {fault}; move parts of it into 'variables'")
NOT_IN_EXPRESSIONS = Code("LF3106", _E, "an expression cannot {use}; {instead}")
UNKNOWN_NAME = Code("LF3107", _E, "no parameter, variable or 'for' name '{name}' here{hint}", is_unknown_name=True)
UNKNOWN_FUNCTION = Code("LF3108", _E, "no function named '{name}'{hint}")
FUNCTION_NOT_CALLED = Code("LF3110", _E, "'{function}' is a function; write {signature}")
WRONG_ARGUMENT_COUNT = Code("LF3111", _E, "expected {signature}, found {found}")

WRONG_KIND = Code("LF3121", _E, "{operation} takes {expected}, found {found}", _DATA)
DIMENSIONS_DIFFER = Code("LF3122", _E, "{operation} takes values of one dimension, found {left} and {right}")
WRONG_DIMENSION = Code("LF3123", _E, "{operation} takes {expected}, found {found}")
KINDS_DIFFER = Code("LF3124", _E, "{operation} compares values of one kind, found {left} and {right}")
DIVISION_BY_ZERO = Code("LF3125", _E, "{operation} divides by zero")
OUTSIDE_DOMAIN = Code("LF3126", _E, "{operation} takes {expected}, found {found}")
RESULT_TOO_LARGE = Code("LF3127", _E, "the result of {operation} is not a finite number")
TEXT_TOO_LONG = Code("LF3128", _E, "the text grows beyond {limit} characters")
UNKNOWN_KEY = Code("LF3129", _E, "no key '{name}' in this map")
NO_SUCH_ITEM = Code("LF3130", _E, "no item {index} in a list of {length}; the first is 0")
NOT_TEXT = Code("LF3131", _E, "{found} cannot be inserted into text{way}")

CIRCULAR_NAMES = Code("LF3141", _E, "'{first}' is computed from itself: {path}")
CHAIN_TOO_LONG = Code("LF3142", _E, "'{first}' is computed through {count} other names")
TRUTH_AS_TEXT = Code(
    "LF3143",
    _E,
    "'{name}' is text in YAML 1.2, not true or false; write {expected}",
    _VALUE,
    fix=Replacement("{name}", "{expected}", is_safe=True, is_whole=True),
)
WIDE_LITERAL = Code(
    "LF3144",
    _W,
    "{function}() of {found} radians, more than a whole turn; write '{function}(radians({found}))' for degrees",
    fix=Replacement("{found}", "radians({found})"),
)

WITHOUT_VALUES = (
    *(UNREADABLE_EXPRESSION, UNCLOSED_EXPRESSION, UNCLOSED_TEXT, EMPTY_EXPRESSION, EXPRESSION_TOO_LARGE),
    *(NOT_IN_EXPRESSIONS, UNKNOWN_NAME, UNKNOWN_FUNCTION, FUNCTION_NOT_CALLED, WRONG_ARGUMENT_COUNT),
    *(CIRCULAR_NAMES, CHAIN_TOO_LONG, WIDE_LITERAL),
)
"""The faults that an expression has whatever the values of its names are."""
