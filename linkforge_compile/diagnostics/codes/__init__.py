"""The register of every code: one line a code, one file a family, never renumbered, never reused.

Families: LF1 syntax, LF2 schema, LF3 modules and expressions, LF4 names and references, LF5 model,
LF6 physics and interfaces, LF7 output formats, LF8 import.
"""

from linkforge_compile.diagnostics.codes import (
    collisions,
    expressions,
    formats,
    importing,
    model,
    modules,
    names,
    physics,
    schema,
    simulators,
    syntax,
)
from linkforge_compile.diagnostics.diagnostic import Code

REGISTER: dict[str, Code] = {
    code.id: code
    for family in (
        syntax,
        schema,
        modules,
        expressions,
        names,
        model,
        physics,
        formats,
        simulators,
        collisions,
        importing,
    )
    for code in vars(family).values()
    if isinstance(code, Code)
}
"""Every code by its id."""

OUTPUT_CODES = "LF7"
"""How the codes about outputs begin; which of them a compile reports depends on its formats."""
