"""What expanding makes: every use of every file, evaluated, in the shape in which they hang together."""

from __future__ import annotations

from dataclasses import dataclass

from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax.nodes import YamlMap


@dataclass(frozen=True, slots=True, eq=False)
class Instance:
    """One use of one spec file: the compiled file itself, or an entry of `modules`.

    `tree` is the file's tree with every expression evaluated and without `parameters`, `variables` and `x-`
    keys; None where the file could not be read, which has been reported. An entry whose value is a YamlFault
    was reported, too; where its key still holds `$(`, so was its name.
    `entry` is the evaluated entry of `modules` (`parent`, `origin`, `joint`), None for the compiled file.
    `prefix` is this use's own, not that of the files around it.
    `mesh_base` is put before a relative mesh path of this file to make it relative to the compiled file:
    "" for the compiled file, "../arm/", or "package://arm_description/robots/".
    `trail` lists the `use` that brought the file in, then the use of the file that wrote that, and outwards.
    """

    name: str
    tree: YamlMap | None
    entry: SourceRef | None = None
    prefix: str = ""
    mesh_base: str = ""
    trail: tuple[Span, ...] = ()
    modules: tuple[Instance, ...] = ()
