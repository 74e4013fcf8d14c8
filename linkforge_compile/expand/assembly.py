"""What expanding makes: every use of every file, evaluated, in the shape in which they hang together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import DeletedNames
from linkforge_compile.expand.mesh_files import FindMesh, no_mesh
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlScalar

COMPUTING = frozenset({"parameters", "variables", "data", "variants", "packages", "modules", "defaults"})
"""The sections that describe no robot, but help to make one."""

_PAIRS = ("disabled_collisions", "enabled_collisions")


class NameReference(NamedTuple):
    """A name in `$(link('x'))` or `$(joint('x'))`, as the file calls what it names, and where it is written."""

    kind: str
    name: str
    where: SourceRef


@dataclass(frozen=True, eq=False)
class Instance:
    """One use of one spec file: the compiled file itself, or an entry of `modules`.

    `tree` is the file's tree, its included files laid in, with every expression evaluated and without what only
    serves to compute it (`parameters`, `variables`, `data`, …) and `x-` keys; None where the file could not be
    read, which has been reported. An entry whose value is a YamlFault was reported, too; where its key still holds
    `$(`, so was its name.
    `entry` is the evaluated entry of `modules` (`parent`, `origin`, `joint`), None for the compiled file.
    `prefix` is this use's own, not that of the files around it.
    `mesh_bases` says for each file that may have written in the tree what is put before a relative path in it to
    make it relative to the compiled file: "../arm/", or "package://arm_description/robots/"; "" for no other file.
    `references` are the names that expressions asked for, which must be names of this file or its modules.
    `find_mesh` finds the meshes that an inertia is to be computed from.
    `packages` are the folders that the file declares for packages.
    `defaults` are those of the file, evaluated, None for none: the tree has them where an entry took them over.
    `removed` says of names of this file why it has nothing of that name: a `when`, or an override.
    `trail` lists the `use` that brought the file in, then the use of the file that wrote that, and outwards.
    """

    name: str
    tree: YamlMap | None
    entry: SourceRef | None = None
    prefix: str = ""
    mesh_bases: Mapping[SourceFile, str] = field(default_factory=dict)
    trail: tuple[Span, ...] = ()
    modules: tuple[Instance, ...] = ()
    references: tuple[NameReference, ...] = ()
    find_mesh: FindMesh = no_mesh
    removed: DeletedNames = field(default_factory=DeletedNames)
    packages: Mapping[str, Path] = field(default_factory=dict)
    defaults: YamlMap | None = None

    @property
    def with_modules(self) -> Iterator[Instance]:
        """The use itself, and each use below it."""
        yield self
        for module in self.modules:
            yield from module.with_modules

    @property
    def packages_of_all(self) -> dict[str, Path]:
        """The folders that the file and its modules declare for packages: of two for one name, that of the outer."""
        return {name: place for use in reversed((*self.with_modules,)) for name, place in use.packages.items()}

    @property
    def shared_files(self) -> frozenset[SourceFile]:
        """The files that are used more than once, by this use and those below it."""
        uses = Counter(use.tree.span.file for use in self.with_modules if use.tree)
        return frozenset(file for file, count in uses.items() if count > 1)


def joint_name_of(module: str, fields: Located) -> str:
    """Return what an entry of `modules` calls the joint that it hangs by, whether it is a name or not."""
    said = fields.child("joint")
    said = said.child("name") if isinstance(said, YamlMap) else said
    return said.text if isinstance(said, YamlScalar) and said.value is not None else f"{module}_joint"


def robot_part(tree: YamlMap) -> YamlMap:
    """Return what describes the robot, without what only computes it and the author's own keys."""
    kept = {name: entry for name, entry in tree.entries.items() if name not in COMPUTING and not name.startswith("x-")}
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
    budget.spend(Limit.PAIRS, _collision_pairs(tree) * uses, use or tree.span)


def _collision_pairs(tree: YamlMap) -> int:
    semantic = tree.get("semantic")
    sections = [semantic.get(name) for name in _PAIRS] if isinstance(semantic, YamlMap) else []
    others = [entry.value for section in sections if isinstance(section, YamlMap) for entry in section]
    return sum(len(each) for each in others if isinstance(each, YamlMap))
