"""LF72xx: what is wrong with a user's own templates."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity

_E = Severity.ERROR

TEMPLATE_SYNTAX = Code("LF7201", _E, "Jinja2 cannot read this template: {reason}")
UNDEFINED_IN_TEMPLATE = Code("LF7202", _E, "this template uses an undefined name: {reason}")
NO_SUCH_TEMPLATE = Code("LF7203", _E, "no template '{name}' in '{folder}'")
REFUSED_IN_TEMPLATE = Code("LF7204", _E, "a template may only read the robot: {reason}")
TEMPLATE_FAILS = Code("LF7205", _E, "this template fails here: {reason}")
NOT_XML_FROM_TEMPLATE = Code("LF7206", _E, "this template makes XML that is not well-formed: {problem}")
UNREADABLE_TEMPLATE = Code("LF7207", _E, "template '{path}' cannot be read: {reason}")
UNUSED_TEMPLATE = Code(
    "LF7208",
    Severity.WARNING,
    "'{name}' is unused: linkforge has no template of that name to replace, and no template includes it",
)
