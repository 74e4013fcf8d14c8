"""Read what a xacro file and all that it includes declare, without running xacro: arguments and macros."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.importing import ARGUMENTS_NOT_LISTED
from linkforge_compile.load.loader import ImportSite, Loader
from linkforge_compile.paths import folders_for_xacro
from linkforge_compile.roots import identity

if TYPE_CHECKING:
    from linkforge_compile.source import SourceFile, Span
    from linkforge_compile.source.xml_tree import XmlElement

_ARG_USE = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_SUBSTITUTION = re.compile(r"\$\((find|arg|dirname)\s*+([^\s()]*+)\s*+\)")
_MAX_INCLUDE_DEPTH = 50
_MAX_FILES = 500
_COMPUTED_NAME = "its name is known only as xacro runs"

_PARAMETER = re.compile(
    r"""(?P<name>[^\s:=]+)
    (?:\s*:?=\s*(?P<forward>\^\|?)?(?P<default>(?:\$\{[^}]*+(?:\}|\Z)|\$\([^)]*+(?:\)|\Z)|'[^']*+'|"[^"]*+"|[^\s'"])*+)(?=\s|$))?""",
    re.VERBOSE,
)
"""A parameter in `params` of a macro: `name`, `name:=default`, `name:=^|default`, `*block` or `**block`.

It never goes back, so that a stranger's file is read in linear time.
"""

Block = Literal["*", "**"]
"""How a macro inserts a block: the element itself, or what is in it."""


class MacroParameter(NamedTuple):
    """A parameter of a macro.

    `default` is as written, without the quotes around all of it; None for none. `is_forwarded` if the value of that
    name around the call comes before the default. `block` is None for a parameter that is text.
    """

    name: str
    default: str | None = None
    is_forwarded: bool = False
    block: Block | None = None

    @property
    def is_required(self) -> bool:
        return self.default is None and not self.is_forwarded

    @property
    def written_default(self) -> str | None:
        """The default as `params` shows it; None for a required parameter."""
        forwarded = "^" if self.is_forwarded else ""
        return None if self.is_required else "|".join(filter(None, (forwarded, self.default))) or ""


class Macro(NamedTuple):
    """A macro, and its element, which is the last one of that name."""

    name: str
    parameters: tuple[MacroParameter, ...]
    element: XmlElement

    def parameter(self, name: str) -> MacroParameter | None:
        return next((one for one in self.parameters if one.name == name), None)

    @property
    def blocks(self) -> tuple[MacroParameter, ...]:
        return tuple(one for one in self.parameters if one.block)


class XacroLibrary(NamedTuple):
    """What a xacro file declares, with all that it includes.

    - `name`: as its root has it.
    - `arguments`: the first default of each `<xacro:arg>` by name, None for none; `used` are those in `$(arg NAME)`.
    - `early`: the arguments that the root uses, which xacro needs before it has seen any default.
    - `macros`: by name; that of a namespace is `NAMESPACE.NAME`.
    - `declarations`: the first `<xacro:arg>` of each name.
    - `notes`: why an include could not be followed, so that there may be more.
    """

    name: str | None
    arguments: Mapping[str, str | None]
    used: Sequence[str]
    early: frozenset[str]
    macros: Mapping[str, Macro]
    declarations: Mapping[str, XmlElement]
    notes: Sequence[Diagnostic]


def parameters_in(params: str) -> tuple[MacroParameter, ...]:
    """Return the parameters that the attribute `params` of a macro declares."""
    return tuple(map(_parameter, _PARAMETER.finditer(params)))


def _parameter(found: re.Match[str]) -> MacroParameter:
    written, forward, default = found["name"], found["forward"], found["default"]
    name = written.lstrip("*")
    stars = written[: len(written) - len(name)]
    block: Block | None = "**" if stars == "**" else "*" if stars else None
    if default and default[0] == default[-1] and default[0] in "'\"" and len(default) > 1:
        return MacroParameter(name, default[1:-1], bool(forward), block)
    # An empty default without quotes is none to xacro.
    return MacroParameter(name, default or None, bool(forward), block)


def read_library(path: Path, loader: Loader, sink: Diagnostics, used: ImportSite | None = None) -> XacroLibrary | None:
    """Read a xacro file and all that it includes, whatever the conditions around; None after a reported error.

    `used` is where a spec names the file, None for the command line.
    """
    file = loader.open_xml(path, sink, used)
    root = _read_root(file, sink) if file else None
    if root is None:
        return None
    search = _Search(loader)
    search.search(root, path)
    early = frozenset(_ARG_USE.findall(" ".join(root.values.values())))
    return XacroLibrary(
        root.get("name"),
        {name: element.get("default") for name, element in search.declarations.items()},
        tuple(search.used),
        early,
        search.macros,
        search.declarations,
        tuple(search.notes),
    )


def _read_root(file: SourceFile, sink: Diagnostics) -> XmlElement | None:
    from linkforge_compile.importers.xml import read_xml

    document = read_xml(file, sink)
    return document.root if document else None


class _NotFollowedError(Exception):
    """An include cannot be followed; the message says why."""


class _Search:
    """Searches a xacro file and all that it includes, each once in each namespace."""

    def __init__(self, loader: Loader) -> None:
        self.declarations: dict[str, XmlElement] = {}
        self.used: dict[str, None] = {}
        self.macros: dict[str, Macro] = {}
        self._notes = Diagnostics()
        self._loader = loader
        self._seen: set[tuple[str, str]] = set()
        self._roots: dict[str, XmlElement] = {}

    @property
    def notes(self) -> Iterator[Diagnostic]:
        return iter(self._notes)

    def search(self, root: XmlElement, path: Path, around: tuple[str, ...] = (), namespace: str = "") -> None:
        """Search a file with that root; `around` are the files that include it."""
        file = identity(path)
        self._seen.add((file, namespace))
        around = (*around, file)
        for element in root.walk():
            name, included = element.get("name"), element.get("filename")
            if element.tag == "xacro:arg" and name:
                self.declarations.setdefault(name, element)
            elif element.tag == "xacro:macro" and name:
                whole = namespace + name.removeprefix("xacro:")
                self.macros[whole] = Macro(whole, parameters_in(element.get("params") or ""), element)
            elif element.tag == "xacro:include" and included is not None:
                inner = element.get("ns")
                self._include(included, element, path, around, f"{namespace}{inner}." if inner else namespace)
        self.used |= dict.fromkeys(_ARG_USE.findall(root.raw))

    def _include(self, name: str, element: XmlElement, user: Path, around: tuple[str, ...], namespace: str) -> None:
        try:
            path = user.parent / self._resolve(name, user)
            file = identity(path)
            if file in around or (file, namespace) in self._seen:
                return
            root = self._open(path, name, element.span, len(around))
        except _NotFollowedError as error:
            if element.get("optional") not in ("true", "True", "1"):
                self._notes.report(ARGUMENTS_NOT_LISTED.at(element.span, path=name, reason=str(error)))
            return
        self.search(root, path, around, namespace)

    def _open(self, path: Path, name: str, place: Span, depth: int) -> XmlElement:
        if depth > _MAX_INCLUDE_DEPTH:
            raise _NotFollowedError(f"more than {_MAX_INCLUDE_DEPTH} files include each other")
        if len(self._seen) > _MAX_FILES:
            raise _NotFollowedError(f"more than {_MAX_FILES} files are included")
        if known := self._roots.get(identity(path)):
            return known
        faults = Diagnostics()
        file = self._loader.open_xml(path, faults, ImportSite(name, place))
        root = _read_root(file, faults) if file else None
        if root is None:
            raise _NotFollowedError(next(iter(faults)).message)
        self._roots[identity(path)] = root
        return root

    def _resolve(self, name: str, user: Path) -> str:
        """Return a file name with its substitutions replaced."""
        text = _SUBSTITUTION.sub(lambda found: self._value(found[1], found[2], user), name)
        if "$" in text or re.search(r"[*?\[]", text):
            raise _NotFollowedError(_COMPUTED_NAME)
        return text

    def _value(self, kind: str, name: str, user: Path) -> str:
        if kind == "dirname":
            return str(user.parent.absolute())
        if kind == "find":
            folder = next(folders_for_xacro(name, self._loader.packages, user.parent, self._loader.roots), None)
            if folder is None:
                raise _NotFollowedError(f"no package named '{name}'; specify its folder with --package {name}=FOLDER")
            return str(folder.absolute())
        declared = self.declarations.get(name)
        default = declared.get("default") if declared else None
        if default is None or "$" in default:
            raise _NotFollowedError(_COMPUTED_NAME)
        return default
