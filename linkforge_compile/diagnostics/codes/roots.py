"""LF34xx: what a spec may make the compiler read."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.source.provenance import Location

OUTSIDE_ROOTS = Code(
    "LF3401",
    Severity.ERROR,
    "'{path}' is outside of the folders that may be read; add its folder with --package "
    "{name}=FOLDER, or allow all with --allow-outside",
    Location.VALUE,
)
UNSEEN_MESHES = Code(
    "LF3402",
    Severity.NOTE,
    "the meshes of {links} are outside of the folders that may be read and were not checked",
)
UNSOUGHT_MESHES = Code(
    "LF3403",
    Severity.NOTE,
    "the meshes of {links} are in {packages} that were not searched for: too many others were not found",
)
