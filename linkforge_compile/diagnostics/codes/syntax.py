"""LF1xxx: the text is not YAML as the language reads it."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

MALFORMED_YAML = Code("LF1001", Severity.ERROR, "this is not YAML: {problem}")
TAB_INDENTATION = Code("LF1002", Severity.ERROR, "YAML is indented with spaces, found {found}")
RESERVED_START = Code("LF1003", Severity.ERROR, "text cannot begin with '{character}'; put it in quotes")
SPACE_AFTER_COLON = Code("LF1004", Severity.ERROR, "a space is missing after the colon in '{text}'")
SPACE_AFTER_DASH = Code("LF1005", Severity.ERROR, "a space is missing after the dash in '{text}'")
MISSING_COLON = Code("LF1006", Severity.ERROR, "a colon is missing after '{text}'")
SECOND_COLON = Code("LF1007", Severity.ERROR, "a second ': ' on this line; put text that holds one in quotes{or_map}")
UNCLOSED_QUOTE = Code("LF1008", Severity.ERROR, "no closing quote for the text that begins here")
UNCLOSED_BRACKET = Code("LF1009", Severity.ERROR, "expected ',' or '{closing}' before this")
UNQUOTED_EXPRESSION = Code(
    "LF1010",
    Severity.ERROR,
    'an expression with a comma or a bracket inside a flow list or map needs quotes: "$(...)"',
)
TOO_DEEPLY_INDENTED = Code("LF1011", Severity.ERROR, "this line is indented under an entry that already has a value")
UNEVEN_INDENTATION = Code("LF1012", Severity.ERROR, "this line is not aligned with any entry above")
ITEM_AMONG_KEYS = Code("LF1013", Severity.ERROR, "a list item is not allowed among the keys of a map")
KEY_AMONG_ITEMS = Code(
    "LF1014", Severity.ERROR, "expected a list item '- ...' as above, found a key; begin all with '-', or none"
)
LIST_ON_KEY_LINE = Code(
    "LF1015", Severity.ERROR, "a list with dashes must begin on a new line; on one line write [a, b]"
)
TEXT_AFTER_VALUE = Code("LF1016", Severity.ERROR, "the value ended before this; put the whole text in quotes")
COMMA_AFTER_VALUE = Code("LF1057", Severity.ERROR, "unexpected ',': no list or map is open; leave it out")
MISSING_VALUE = Code("LF1017", Severity.ERROR, "expected a value, found {found}")
UNKNOWN_ESCAPE = Code("LF1018", Severity.ERROR, "unknown escape '{text}' in double quotes; use single quotes")
FORBIDDEN_CHARACTER = Code("LF1019", Severity.ERROR, "a spec cannot hold the character {character}")
XACRO_EXPRESSION = Code("LF1020", Severity.ERROR, "'{text}' is xacro syntax; write '{ours}'")
XACRO_IN_FREE_TEXT = Code(
    "LF1075", Severity.WARNING, "'{text}' is xacro syntax and is kept as text; write '{ours}' for its value"
)
COMMENT_TAKES_BRACKET = Code(
    "LF1047", Severity.ERROR, "'{text}' begins a comment that hides the '{closing}'; put it in quotes"
)
CURLY_QUOTES = Code("LF1056", Severity.WARNING, "the curly quotes of '{text}' are not YAML quotes; write '\"{ours}\"'")
MERGE_CONFLICT = Code(
    "LF1055",
    Severity.ERROR,
    "unresolved git merge conflict; keep one of its two sides and delete its three marker lines",
)
BRACKET_TOO_MANY = Code("LF1076", Severity.ERROR, "unmatched '{bracket}': no list or map is open; leave it out")

DUPLICATE_KEY = Code("LF1101", Severity.ERROR, "the key '{key}' is written twice{more}")
KEY_NOT_SCALAR = Code("LF1102", Severity.ERROR, "a key must be text, found {found}")
TAG = Code("LF1103", Severity.ERROR, "YAML tags are not part of the language, found '{tag}'")
UNKNOWN_ANCHOR = Code("LF1104", Severity.ERROR, "no anchor named '{name}' above")
RECURSIVE_ALIAS = Code("LF1105", Severity.ERROR, "the alias '*{name}' is inside its own anchor")
TOO_DEEP = Code("LF1107", Severity.ERROR, "lists and maps are nested more than {limit} deep")
SEVERAL_DOCUMENTS = Code("LF1108", Severity.ERROR, "expected one YAML document, found a second one")
EMPTY_DOCUMENT = Code("LF1109", Severity.ERROR, "the file is empty; a spec begins with 'linkforge: 1'")
TOP_LEVEL_NOT_MAP = Code("LF1110", Severity.ERROR, "expected keys such as 'name:' and 'links:', found {found}")
MERGE_NOT_MAP = Code("LF1111", Severity.ERROR, "'<<' merges a map or a list of maps, found {found}")
OTHER_TAG = Code("LF1113", Severity.ERROR, "the only YAML tags allowed here are {known} before a number, found '{tag}'")
EMPTY_DATA = Code("LF1114", Severity.ERROR, "the data file is empty; write the values that it is to hold")
NUMBER_TOO_LARGE = Code("LF1112", Severity.ERROR, "the number is beyond what a double can hold")
