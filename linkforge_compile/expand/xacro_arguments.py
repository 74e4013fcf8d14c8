"""The arguments of a xacro file, found without running it: those that it and the files that it includes declare."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import ARGUMENTS_NOT_LISTED
from linkforge_compile.expand.listing import ListedParameter, Listing
from linkforge_compile.expand.loader import ImportSite, Loader
from linkforge_compile.expand.packages import find_package
from linkforge_compile.expand.xacro_faults import in_order
from linkforge_compile.roots import identity

if TYPE_CHECKING:
    from linkforge_compile.source import SourceFile, Span
    from linkforge_compile.source.xml_tree import XmlElement

_WANTED = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_SUBSTITUTION = re.compile(r"\$\((find|arg|dirname)\s*([^\s()]*)\s*\)")
_DEEPEST = 50
"""How many files may lie around an included one."""


def list_arguments(path: Path, loader: Loader, sink: Diagnostics) -> Listing | None:
    """List the arguments that a xacro file takes, each with the default that xacro meets first.

    Those of files whose names only an expression says, and of files that cannot be read, are not listed, as a note
    tells; nor are conditions looked at. What is used and declared nowhere is required.
    """
    file = loader.open_xml(path, sink)
    if file is None:
        return None
    search = _Search(loader, sink)
    root = search.read(file, sink)
    if root is None:
        return None
    search.look_into(root, path)
    # xacro computes the attributes of <robot> before anything in it, so a default further down comes too late.
    early = set(_WANTED.findall(" ".join(root.values.values())))
    declared = [one._replace(default=None) if one.name in early else one for one in search.declared.values()]
    undeclared = [ListedParameter(name, "string") for name in search.wanted if name not in search.declared]
    name = root.get("name")
    return Listing(name if name and "$" not in name else path.name, parameters=(*declared, *undeclared))


class _Search:
    """Goes through a file and all that it includes, each once."""

    def __init__(self, loader: Loader, sink: Diagnostics) -> None:
        self.declared: dict[str, ListedParameter] = {}
        self.wanted: dict[str, None] = {}
        self._loader, self._sink = loader, sink
        self._seen: set[str] = set()

    def read(self, file: SourceFile, sink: Diagnostics) -> XmlElement | None:
        from linkforge_compile.importers.xml import read_xml

        document = read_xml(file, sink)
        return document.root if document else None

    def look_into(self, root: XmlElement, path: Path, depth: int = 0) -> None:
        self._seen.add(identity(path))
        for element in in_order(root):
            name, included = element.get("name"), element.get("filename")
            if element.tag == "xacro:arg" and name:
                self.declared.setdefault(name, ListedParameter(name, "string", default=element.get("default")))
            elif element.tag == "xacro:include" and included is not None:
                self._include(included, element, path, depth)
        self.wanted |= dict.fromkeys(_WANTED.findall(root.raw))

    def _include(self, name: str, element: XmlElement, user: Path, depth: int) -> None:
        place = element.span
        try:
            path = user.parent / self._resolved(name, user)
            if identity(path) in self._seen:
                return
            root = self._included(path, name, place, depth)
        except _NotListedError as error:
            if element.get("optional") not in ("true", "True", "1"):
                self._sink.report(ARGUMENTS_NOT_LISTED.at(place, path=name, reason=str(error)))
            return
        self.look_into(root, path, depth + 1)

    def _included(self, path: Path, name: str, place: Span, depth: int) -> XmlElement:
        if depth == _DEEPEST:
            raise _NotListedError(f"more than {_DEEPEST} files include each other")
        unheard = Diagnostics()
        file = self._loader.open_xml(path, unheard, ImportSite(name, place))
        root = self.read(file, unheard) if file else None
        if root is None:
            raise _NotListedError(next(iter(unheard)).message)
        return root

    def _resolved(self, name: str, user: Path) -> str:
        """Return the path that a name with substitutions is."""
        text = _SUBSTITUTION.sub(lambda found: self._value(found[1], found[2], user), name)
        if "$" in text or re.search(r"[*?\[]", text):
            raise _NotListedError("its name is known only as xacro runs")
        return text

    def _value(self, kind: str, name: str, user: Path) -> str:
        if kind == "dirname":
            return str(user.parent.absolute())
        if kind == "find":
            folder = find_package(name, self._loader.packages, user.parent, self._loader.roots)
            if folder is None:
                raise _NotListedError(f"no package named '{name}'; say where it is with --package {name}=FOLDER")
            return str(folder)
        argument = self.declared.get(name)
        if argument is None or argument.default is None or "$" in argument.default:
            raise _NotListedError("its name is known only as xacro runs")
        return argument.default


class _NotListedError(Exception):
    """A file cannot be looked into; the message says why."""
