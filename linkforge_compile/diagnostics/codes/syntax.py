"""LF1xxx: the text is not YAML as the language reads it; LF12xx: comments that suppress diagnostics."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.diagnostics.fix import Replacement

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE

_SAFE_TEXT = Replacement("{text}", "{ours}", is_safe=True)

MALFORMED_YAML = Code("LF1001", _E, "this is not YAML: {problem}")
TAB_INDENTATION = Code("LF1002", _E, "YAML is indented with spaces, found {found}")
RESERVED_START = Code("LF1003", _E, "text cannot begin with '{character}'; put it in quotes")
SPACE_AFTER_COLON = Code("LF1004", _E, "a space is missing after the colon in '{text}'", fix=_SAFE_TEXT)
SPACE_AFTER_DASH = Code("LF1005", _E, "a space is missing after the dash in '{text}'", fix=_SAFE_TEXT)
MISSING_COLON = Code("LF1006", _E, "a colon is missing after '{text}'", fix=Replacement("{text}", "{text}:"))
SECOND_COLON = Code("LF1007", _E, "a second ': ' on this line; put text that contains one in quotes{or_map}")
UNCLOSED_QUOTE = Code("LF1008", _E, "no closing quote for the text that begins here")
UNCLOSED_BRACKET = Code("LF1009", _E, "expected ',' or '{closing}' before this")
UNQUOTED_EXPRESSION = Code(
    "LF1010", _E, 'an expression with a comma or a bracket inside a flow list or map needs quotes: "$(...)"'
)
TOO_DEEPLY_INDENTED = Code("LF1011", _E, "this line is indented under an entry that already has a value")
UNEVEN_INDENTATION = Code("LF1012", _E, "this line is not aligned with any entry above")
ITEM_AMONG_KEYS = Code("LF1013", _E, "a list item is not allowed among the keys of a map")
KEY_AMONG_ITEMS = Code("LF1014", _E, "expected a list item '- ...' as above, found a key; begin all with '-', or none")
LIST_ON_KEY_LINE = Code("LF1015", _E, "a list with dashes must begin on a new line; on one line write [a, b]")
TEXT_AFTER_VALUE = Code("LF1016", _E, "the value ended before this; put the whole text in quotes")
COMMA_AFTER_VALUE = Code(
    "LF1057", _E, "unexpected ',': no list or map is open; remove it", fix=Replacement(",", "", is_safe=True)
)
MISSING_VALUE = Code("LF1017", _E, "expected a value, found {found}")
UNKNOWN_ESCAPE = Code("LF1018", _E, "unknown escape '{text}' in double quotes; use single quotes")
FORBIDDEN_CHARACTER = Code("LF1019", _E, "a spec cannot contain the character {character}")
XACRO_EXPRESSION = Code("LF1020", _E, "'{text}' is xacro syntax; write '{ours}'", fix=_SAFE_TEXT)
XACRO_IN_FREE_TEXT = Code(
    "LF1075",
    _W,
    "'{text}' is xacro syntax and is kept as text; write '{ours}' for its value",
    fix=Replacement("{text}", "{ours}"),
)
COMMENT_TAKES_BRACKET = Code("LF1047", _E, "'{text}' begins a comment that hides the '{closing}'; put it in quotes")
CURLY_QUOTES = Code(
    "LF1056",
    _W,
    "the curly quotes of '{text}' are not YAML quotes; write '\"{ours}\"'",
    fix=Replacement("{text}", '"{ours}"'),
)
MERGE_CONFLICT = Code(
    "LF1055", _E, "unresolved git merge conflict; keep one of its two sides and delete its three marker lines"
)
OUTDENTED_LINE = Code(
    "LF1077", _W, "editors refuse this line of a list or map in brackets; begin it with at least {spaces}"
)
BRACKET_TOO_MANY = Code(
    "LF1076", _E, "unmatched '{bracket}': no list or map is open; remove it", fix=Replacement("{bracket}", "")
)

DUPLICATE_KEY = Code("LF1101", _E, "the key '{key}' is written twice{more}")
KEY_NOT_SCALAR = Code("LF1102", _E, "a key must be text, found {found}")
TAG = Code("LF1103", _E, "YAML tags are not part of the language, found '{tag}'")
UNKNOWN_ANCHOR = Code("LF1104", _E, "no anchor named '{name}' above")
RECURSIVE_ALIAS = Code("LF1105", _E, "the alias '*{name}' is inside its own anchor")
TOO_DEEP = Code("LF1107", _E, "lists and maps are nested more than {limit} deep")
SEVERAL_DOCUMENTS = Code("LF1108", _E, "expected one YAML document, found a second one")
EMPTY_DOCUMENT = Code("LF1109", _E, "the file is empty; a spec begins with 'linkforge: 1'")
TOP_LEVEL_NOT_MAP = Code("LF1110", _E, "expected keys such as 'name:' and 'links:', found {found}")
MERGE_NOT_MAP = Code("LF1111", _E, "'<<' merges a map or a list of maps, found {found}")
OTHER_TAG = Code("LF1113", _E, "the only YAML tags allowed here are {known} before a number, found '{tag}'")
EMPTY_DATA = Code("LF1114", _E, "the data file is empty; write its values")
UNSAFE_FORMAT = Code("LF1115", _E, "formatting would change more than white space here; the file is not changed")
NUMBER_TOO_LARGE = Code("LF1112", _E, "the number is beyond what a double can hold")

# LF12xx: comments that suppress diagnostics
IGNORE_WITHOUT_CODE = Code(
    "LF1201", _W, "this comment names no code to ignore; write '# linkforge: ignore' and codes such as LF6003"
)
IGNORE_OF_UNKNOWN_CODE = Code("LF1202", _W, "no diagnostic has the code '{name}'{hint}")
IGNORE_OF_ERROR = Code("LF1203", _W, "{code} is an error, which cannot be ignored")
NOTHING_TO_IGNORE = Code("LF1204", _N, "{code} is not reported on line {line}; remove it from this comment")
IGNORE_MISWRITTEN = Code("LF1275", _W, "this comment ignores nothing; write '# linkforge: ignore {codes}'")
