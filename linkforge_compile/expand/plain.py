"""A file that computes nothing and uses no other is its own assembly."""

from __future__ import annotations

from linkforge_compile.expand.assembly import COMPUTING, Instance, count_entries, own_name, robot_part
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.spec_tree import is_computed
from linkforge_compile.expand.uses import PathSite, mesh_base, mesh_finder
from linkforge_compile.source import Span


def computes_nothing(spec: SpecFile) -> bool:
    """Whether a file says its robot as it is: nothing in it is computed, repeated or used, nor included."""
    # A file that includes others may have lost one of them.
    apart = COMPUTING.isdisjoint(spec.tree.entries) and not spec.included and "include" not in spec.tree.entries
    return apart and not is_computed(spec.file, spec.tree)


def as_written(spec: SpecFile, loader: Loader) -> Instance:
    """Return what expanding makes of a plain file: what it says, and how the paths in it are read."""
    tree = robot_part(spec.tree)
    count_entries(tree, 1, loader.budget)

    def site(text: str, where: Span) -> PathSite:
        return PathSite(text, where, spec, spec.packages)

    return Instance(
        own_name(tree),
        tree,
        mesh_bases={} if spec.folder is None else {spec.file: mesh_base(spec, spec)},
        find_mesh=mesh_finder({spec.file: site}, loader),
        packages=spec.packages,
    )
