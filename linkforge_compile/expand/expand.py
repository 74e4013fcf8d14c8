"""The verb of this room: from the compiled file to the assembly of every use of every file, all computed."""

from __future__ import annotations

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import Arguments, Unset
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.plain import as_written, computes_nothing


def expand(
    spec: SpecFile,
    arguments: Arguments,
    loader: Loader,
    sink: Diagnostics,
    *,
    unset: Unset = Unset.ERROR,
    variant: str | None = None,
) -> Instance:
    """Compute every expression of a file and of the modules it uses.

    What is at fault is reported and stands as a YamlFault; a module that cannot be had is an Instance without a
    tree. `unset` says what it is when nothing sets a required parameter of the compiled file. `variant` is the one
    of its `variants` that sets what the arguments do not.
    """
    if variant is None and not arguments.entries and computes_nothing(spec):
        return as_written(spec, loader)
    # Half of this room, and all of that of expressions: a sixth of the imports of a robot that needs neither.
    from linkforge_compile.expand.expansion import expanded

    return expanded(spec, arguments, loader, sink, unset=unset, variant=variant)
