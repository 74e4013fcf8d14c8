"""Turn a spec, its parameters and the files it uses into a tree of Instances with every expression computed."""

from __future__ import annotations

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import (
    Arguments,
    CliArgument,
    Unset,
    arguments_from_text,
    arguments_from_values,
)
from linkforge_compile.expand.loader import ImportSite, Loader, SpecFile
from linkforge_compile.expand.spec_tree import is_computed
from linkforge_compile.expand.uses import (
    COMPUTING,
    Instance,
    PathSite,
    charge_entries,
    is_xacro,
    mesh_base,
    mesh_finder,
    own_name,
    robot_part,
)
from linkforge_compile.source import Span

__all__ = [
    "Arguments",
    "CliArgument",
    "ImportSite",
    "Instance",
    "Loader",
    "SpecFile",
    "Unset",
    "arguments_from_text",
    "arguments_from_values",
    "expand",
    "is_xacro",
]


def expand(
    spec: SpecFile,
    arguments: Arguments,
    loader: Loader,
    sink: Diagnostics,
    *,
    unset: Unset = Unset.ERROR,
    variant: str | None = None,
) -> Instance:
    """Compute every expression of a file and of the modules that it uses.

    Faulty parts are reported and become YamlFaults; a module that cannot be read is an Instance without a tree.
    `unset` says how to report required parameters without a value. `variant` selects one of the file's `variants`.
    """
    if variant is None and not arguments.entries and is_plain(spec):
        return plain_instance(spec, loader)
    # Importing the rest of this package and the expressions takes 45 ms, which plain robots need not wait for.
    from linkforge_compile.expand.expand_uses import expand_uses

    return expand_uses(spec, arguments, loader, sink, unset=unset, variant=variant)


def is_plain(spec: SpecFile) -> bool:
    """Whether a file has nothing to compute: no expressions, repetition, includes or modules."""
    # `include` stays in the tree if an included file could not be read.
    has_no_section = COMPUTING.isdisjoint(spec.tree.entries) and "include" not in spec.tree.entries
    return has_no_section and not spec.included and not is_computed(spec.file, spec.tree)


def plain_instance(spec: SpecFile, loader: Loader) -> Instance:
    """Return the Instance of a plain file, the same as `expand_uses` makes of it."""
    tree = robot_part(spec.tree)
    charge_entries(tree, 1, loader.budget)

    def site(text: str, where: Span) -> PathSite:
        return PathSite(text, where, spec, spec.packages)

    return Instance(
        own_name(tree),
        tree,
        mesh_bases={} if spec.folder is None else {spec.file: mesh_base(spec, spec)},
        find_mesh=mesh_finder({spec.file: site}, loader),
        packages=spec.packages,
    )
