"""A file that computes nothing and uses no other is its own assembly."""

from __future__ import annotations

from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.modules.assembly import Instance
from linkforge_compile.modules.loader import Loader, SpecFile
from linkforge_compile.modules.mesh_files import mesh_finder
from linkforge_compile.modules.trees import is_computed
from linkforge_compile.modules.uses import UseSite, mesh_base
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlScalar

_COMPUTING = frozenset({"parameters", "variables", "data", "variants", "packages", "modules", "defaults"})
"""The sections that describe no robot, but help to make one."""


def is_plain(spec: SpecFile) -> bool:
    """Whether a file says its robot as it is: nothing in it is computed, repeated or used."""
    # A file that includes others may have lost one of them.
    apart = _COMPUTING.isdisjoint(spec.tree.entries) and not spec.included and "include" not in spec.tree.entries
    return apart and not is_computed(spec.file, spec.tree)


def as_written(spec: SpecFile, loader: Loader) -> Instance:
    """Return what expanding makes of a plain file: what it says, and how the paths in it are read."""
    tree = robot_part(spec.tree)
    count_entries(tree, 1, loader.budget)

    def site(text: str, where: Span) -> UseSite:
        return UseSite(text, where, spec, spec.packages)

    return Instance(
        own_name(tree),
        tree,
        mesh_bases={} if spec.folder is None else {spec.file: mesh_base(spec, spec)},
        find_mesh=mesh_finder({spec.file: site}, loader),
        packages=spec.packages,
    )


def robot_part(tree: YamlMap) -> YamlMap:
    """Return what describes the robot, without what only computes it and the author's own keys."""
    kept = {name: entry for name, entry in tree.entries.items() if name not in _COMPUTING and not name.startswith("x-")}
    return YamlMap(kept, tree.span)


def own_name(tree: YamlMap) -> str:
    """Return the name that a file gives to its robot, "" for none."""
    name = tree.get("name")
    return name.text if isinstance(name, YamlScalar) else ""


def count_entries(tree: YamlMap, uses: int, budget: Budget, use: Span | None = None) -> None:
    """Count the entries of one use of a file: each is moved once for every use around it, which is most of the work.

    `uses` are these and the use itself, which stands at `use`, None for the compiled file. It counts for two, with
    the joint that it hangs on.
    """
    entries = sum(len(entry.value) for entry in tree if isinstance(entry.value, YamlMap | YamlList))
    budget.spend(Limit.ENTRIES, (entries + 2) * uses, use or tree.span)
