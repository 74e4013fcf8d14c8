"""Turn a SpecFile, its parameters and the files it uses into a tree of Instances with every expression computed.

`expand_uses` does this for each use of a file. It binds the arguments of the use to the file's parameters in a
FileScope, whose Evaluator computes the expressions, `for` and `when` of the tree; it merges `defaults`; it reads the
entries of `modules`, whose arguments the next use computes in this scope; and it applies the overrides that the uses
around it have for this one, which may remove or change entries. Then it expands the file of each entry. A node that
is computed or patched keeps in its span how it came about. Faults become YamlFaults in the tree and are reported to
the sink.

What each module knows; it imports only those above it:

    values            a node <-> its value in expressions; where a value was written
    instance          the Instance that a use of a file becomes
    evaluate          a node with expressions -> its value in one scope
    expand_tree       a tree with expressions, `for` and `when` -> one without
    arguments         what the user sets -> Arguments; the variants of a file
    parameters        a declaration -> type and constraints, which convert a value or refuse it
    parameter_values  declaration, arguments, variants -> the value in force
    long_forms        an object in a short form -> in its long form; a frame -> a link and a joint
    defaults          `defaults` -> merged into links, joints and sensors
    override          a patch and a tree -> the patched tree
    deletions         a tree and an override -> what else goes with deleted links; why each name is gone
    modules           an entry of `modules` -> ModuleEntry; a module and overrides -> what is left of it
    macro_module      an entry of `modules` with `macro` -> what the macro makes, with a `mount`
    data_tags         a number of a data file with a tag of xacro -> in SI units
    varied            a file -> what may differ in its modules from compile to compile
    module_cache      a module in which nothing differs -> what an earlier compile made of it
    file_scope        one use of a file -> the names, values and functions that its expressions know
    expand_uses       all of this for a file, then for each file that it uses
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import (
    Arguments,
    CliArgument,
    Unset,
    arguments_from_text,
    arguments_from_values,
)
from linkforge_compile.expand.instance import COMPUTING, Instance, charge_entries, own_name, robot_part
from linkforge_compile.load import Loader, SpecFile
from linkforge_compile.load.locations import mesh_base, mesh_finder
from linkforge_compile.load.spec_tree import is_computed

if TYPE_CHECKING:
    from linkforge_compile.expand.module_cache import CacheOfCompile


def expand(
    spec: SpecFile,
    arguments: Arguments,
    loader: Loader,
    sink: Diagnostics,
    *,
    unset: Unset = Unset.ERROR,
    variant: str | None = None,
    cache: CacheOfCompile | None = None,
) -> Instance:
    """Compute every expression of a file and of the modules that it uses.

    Faulty parts are reported and become YamlFaults; a module that cannot be read is an Instance without a tree.
    `unset` says how to report required parameters without a value. `variant` selects one of the file's `variants`.
    `cache` has modules of earlier compiles.
    """
    if variant is None and not arguments.entries and is_plain(spec):
        return plain_instance(spec, loader)
    # Importing the rest of this package and the expressions takes 45 ms, which plain robots need not wait for.
    from linkforge_compile.expand.expand_uses import expand_uses

    return expand_uses(spec, arguments, loader, sink, unset=unset, variant=variant, cache=cache)


def is_plain(spec: SpecFile) -> bool:
    """Whether a file has nothing to compute: no expressions, repetition, includes or modules."""
    # `include` stays in the tree if an included file could not be read.
    has_no_section = COMPUTING.isdisjoint(spec.tree.entries) and "include" not in spec.tree.entries
    return has_no_section and not spec.included and not is_computed(spec.file, spec.tree)


def plain_instance(spec: SpecFile, loader: Loader) -> Instance:
    """Return the Instance of a plain file, the same as `expand_uses` makes of it."""
    tree = robot_part(spec.tree)
    charge_entries(tree, 1, loader.budget)
    return Instance(
        own_name(tree),
        tree,
        mesh_bases={} if spec.folder is None else {spec.file: mesh_base(spec, spec)},
        find_mesh=mesh_finder({spec.file: (spec, spec.packages)}, loader),
        packages=spec.packages,
        spec=spec,
    )
