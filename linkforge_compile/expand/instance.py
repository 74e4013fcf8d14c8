"""The Instance that each use of a file becomes, and the sections that it has."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import DeletedNames
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load.locations import FindMesh, no_mesh
from linkforge_compile.source import Located, ModuleUse, SourceFile, SourceRef, Span
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.expand.values import Evaluation
    from linkforge_compile.load.loader import SpecFile

COMPUTING = frozenset({"parameters", "variables", "data", "variants", "packages", "modules", "defaults"})
"""The sections that do not describe the robot but help to compute it."""

_PAIRS = ("disabled_collisions", "enabled_collisions")


class NameReference(NamedTuple):
    """A name in `$(link('x'))` or `$(joint('x'))`, without prefixes, and its place."""

    kind: str
    name: str
    where: SourceRef


@dataclass(frozen=True, eq=False)
class Instance:
    """One use of one spec file: the compiled file itself, or an entry of `modules`.

    - `tree`: the file's tree with includes merged and all expressions computed, without the sections that compute
      it and without `x-` keys; None after a reported error. A YamlFault in it was reported, as was a key with `$(`.
    - `entry`: the computed entry of `modules` (`parent`, `origin`, `joint`), None for the compiled file.
    - `prefix`: that of this use, without those of the uses around it.
    - `mesh_bases`: for each file that may have written in the tree, what makes its relative paths relative to the
      compiled file: "../arm/" or "package://arm_description/robots/"; "" for no other file.
    - `include_stack`: the `use` of this file, then that of the file in which that is written, and so on.
    - `references`: the names that expressions require in this file or its modules.
    - `find_mesh`: finds the meshes from which an inertia is computed.
    - `removed`: the names that a `when` or an override removed.
    - `packages`: the package folders that the file declares.
    - `defaults`: the computed defaults, None for none; the tree has them merged in.
    - `overrides`: the computed overrides for this use, which the tree has merged in, with the names in its file.
    - `shared_link`: the root link of its tree that is no link of its own but the `parent` of the entry, None for none.
    - `names`: evaluates the names that the file declares; None for a file that declares none.
    - `spec`: the file, with its tree as written; None if it cannot be read.
    """

    name: str
    tree: YamlMap | None
    entry: SourceRef | None = None
    prefix: str = ""
    mesh_bases: Mapping[SourceFile, str] = field(default_factory=dict)
    include_stack: tuple[ModuleUse, ...] = ()
    modules: tuple[Instance, ...] = ()
    references: tuple[NameReference, ...] = ()
    find_mesh: FindMesh = no_mesh
    removed: DeletedNames = field(default_factory=DeletedNames)
    packages: Mapping[str, Path] = field(default_factory=dict)
    defaults: YamlMap | None = None
    overrides: tuple[YamlMap, ...] = ()
    shared_link: str | None = None
    names: Evaluation | None = None
    spec: SpecFile | None = None

    @property
    def with_modules(self) -> Iterator[Instance]:
        """The use itself and all uses below it."""
        yield self
        for module in self.modules:
            yield from module.with_modules

    @property
    def packages_of_all(self) -> dict[str, Path]:
        """The package folders that this file and its modules declare; an outer declaration overrides inner ones."""
        return {name: place for use in reversed((*self.with_modules,)) for name, place in use.packages.items()}

    @property
    def shared_files(self) -> frozenset[SourceFile]:
        """The files that are used more than once, in this use and those below it."""
        uses = Counter(use.tree.span.file for use in self.with_modules if use.tree)
        return frozenset(file for file, count in uses.items() if count > 1)


def joint_name_of(module: str, fields: Located) -> str:
    """Return the name that an entry of `modules` gives to its joint, valid or not."""
    joint = fields.child("joint")
    joint = joint.child("name") if isinstance(joint, YamlMap) else joint
    return joint.text if isinstance(joint, YamlScalar) and joint.value is not None else f"{module}_joint"


def robot_part(tree: YamlMap) -> YamlMap:
    """Return the sections that describe the robot, without those that only compute it and `x-` keys."""
    return tree.only(lambda section: section.name not in COMPUTING and not section.name.startswith("x-"))


def own_name(tree: YamlMap) -> str:
    """Return the name that a file gives to its robot, "" for none."""
    return tree.text("name") or ""


def charge_entries(tree: YamlMap, uses: int, budget: Budget, use: Span | None = None) -> None:
    """Charge the budget for the entries of one use of a file, which each use around it copies again.

    `uses` counts this use, at `use` (None for the compiled file), and those around it. The use itself counts as two
    entries, for its joint.
    """
    entries = sum(len(entry.value) for entry in tree if isinstance(entry.value, YamlMap | YamlList))
    budget.spend(Limit.ENTRIES, (entries + 2) * uses, use or tree.span)
    budget.spend(Limit.PAIRS, _collision_pairs(tree) * uses, use or tree.span)


def _collision_pairs(tree: YamlMap) -> int:
    semantic = tree.get("semantic")
    links = (semantic.section(name).values() for name in _PAIRS) if isinstance(semantic, YamlMap) else ()
    return sum(len(link.value) for section in links for link in section if isinstance(link.value, YamlMap))
