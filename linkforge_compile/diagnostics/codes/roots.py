"""LF34xx: what a spec may make the compiler read."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

OUTSIDE_ROOTS = Code(
    "LF3401",
    Severity.ERROR,
    "'{path}' leads out of the folders that may be read; add its folder to them with --package {name}=FOLDER, or allow "
    "all with --allow-outside",
    Location.VALUE,
)
UNSEEN_MESHES = Code(
    "LF3402",
    Severity.NOTE,
    "the meshes of {links} lie outside of the folders that may be read, and were not looked at",
)
UNSOUGHT_MESHES = Code(
    "LF3403",
    Severity.NOTE,
    "the meshes of {links} are in {packages} that nobody looked for, as many others are nowhere on this machine",
)
