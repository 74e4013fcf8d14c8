"""What stays in xacro, because it has no equivalent in the language: a call of a macro, or the xacro as a whole."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from linkforge_compile.importers.origin import relative_path
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.parameters import names_of
from linkforge_compile.migration.scopes import Block, Macro, Property, Table
from linkforge_compile.migration.symbols import Parts, Symbol
from linkforge_compile.migration.template import Element, Kept
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax.writer import write

_MODULE = "robot"

_ARGUMENT = re.compile(r"\$\(arg\s+(\w+)\s*\)")
_NAME = re.compile(r"\s*\$\{\s*(\w+)\s*\}\s*")


def kept_call(arguments: Mapping[str, Parts], macro: Macro, scope: Table[Property]) -> Kept | None:
    """Return a call as that of a macro of its xacro; None for one that no entry of `modules` can say."""
    parents = {found[1] for one in _parents_in(macro.body) if (found := _NAME.fullmatch(one.get("link") or ""))}
    blocks = [name for name in macro.parameters if name.startswith("*")]
    if len(parents) > 1 or blocks not in ([], ["*origin"]):
        return None
    block = scope.entries.get("*origin")
    origin = block.content[0] if isinstance(block, Block) and block.content else None
    parent = next((name for name in parents if name in arguments), None)
    has_prefix = any("prefix" in name for name in arguments)
    return Kept(
        macro.name,
        macro.file,
        {name: parts for name, parts in arguments.items() if name != parent},
        arguments[parent] if parent else None,
        origin if isinstance(origin, Element) else None,
        None if has_prefix else "",
    )


def _parents_in(body: XmlElement) -> Iterator[XmlElement]:
    """Yield the elements of joints that name their parents."""
    for one in body.walk():
        if one.tag == "joint":
            yield from (part for part in one.children if part.tag == "parent")


def parameter_names(arguments: Iterable[str]) -> dict[str, str]:
    """Return the names of the parameters that arguments become."""
    symbols = {name: Symbol(name, "parameter") for name in arguments}
    names = names_of(symbols.values())
    return {name: names[symbol] for name, symbol in symbols.items()}


def kept_spec(xacro: Path, folder: Path, arguments: Mapping[str, str], head: str, robot: str) -> str:
    """Return a spec in a folder that uses a xacro as its only module, with the arguments as parameters.

    `robot` is the name of the robot as the xacro has it.
    """
    where = SourceFile("<migrated>", "").whole
    names = parameter_names(arguments)
    name = _ARGUMENT.sub(lambda found: f"$({names[found[1]]})" if found[1] in names else found[0], robot)
    is_known = name and "${" not in name and "$(arg" not in name
    given = {name: scalar(f"$({names[name]})", where) for name in arguments}
    entry = {
        "use": scalar(relative_path(folder, xacro), where),
        "prefix": scalar("", where),
        "with": map_of(given, where) if given else None,
    }
    declared = {names[name]: scalar(default, where) for name, default in arguments.items()}
    tree = {
        "linkforge": scalar("1", where, is_text=False),
        "name": scalar(name if is_known else xacro.name.partition(".")[0], where),
        "parameters": map_of(declared, where) if declared else None,
        "modules": map_of({_MODULE: map_of(entry, where)}, where),
    }
    return f"{head}{write(map_of(tree, where))}"
