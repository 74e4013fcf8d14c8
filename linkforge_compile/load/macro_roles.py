"""What the parameters of a macro are for, as it is written: the link above its joint, the place there, its prefix."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import TYPE_CHECKING, Literal, NamedTuple

from linkforge_compile.units import Dimension

if TYPE_CHECKING:
    from linkforge_compile.load.xacro_library import Macro, XacroLibrary
    from linkforge_compile.source import Span
    from linkforge_compile.source.xml_tree import XmlElement


ORIGIN = "origin"
"""The block that an entry of `modules` gives as its `origin`."""


DIMENSIONS: Mapping[tuple[str, str], Dimension] = {
    ("origin", "xyz"): Dimension.LENGTH,
    ("origin", "rpy"): Dimension.ANGLE,
    ("box", "size"): Dimension.LENGTH,
    ("mass", "value"): Dimension.MASS,
    **{(shape, size): Dimension.LENGTH for shape in ("cylinder", "capsule") for size in ("radius", "length")},
    ("sphere", "radius"): Dimension.LENGTH,
}
"""Attributes whose numbers always have the same dimension."""


class OwnPrefix(NamedTuple):
    """The parameter that a macro puts before its names; some add an underscore themselves.

    `is_name` of a parameter `name` with which all names begin, so that it is the name of the module.
    """

    name: str
    adds_underscore: bool
    is_name: bool = False


class OwnParent(NamedTuple):
    """The parameter for the link above the joint of a macro, which some call without the end of its name."""

    name: str
    suffix: str


class Role(NamedTuple):
    """What a parameter is for: the link above a joint, its place there, a link of the macro, or the start of names.

    `suffix` is what the macro adds to the name of a link.
    """

    parameter: str
    kind: Literal["parent", "xyz", "rpy", "link", "prefix", "prefix_"]
    suffix: str = ""


_NAME = "name"
_MAX_DEPTH = 30
_MOST_ROLES = 1000
_PARENTS = ("parent", "parent_link")
_ONLY = re.compile(r"\s*\$\{\s*(\w+)\s*\}\s*")
_WITH_END = re.compile(r"\s*\$\{\s*(\w+)\s*\}([\w.-]*)\s*")
_FIRST = re.compile(r"\s*\$\{\s*(\w+)\s*\}(_)?")


class MacroRoles:
    """What the parameters of the macros of a library are for, also in the macros that they call."""

    def __init__(self, library: XacroLibrary) -> None:
        self._library = library
        self._roles: dict[str, tuple[Role, ...]] = {}
        self._starts: dict[str, tuple[str | None, ...]] = {}

    def fields(self, macro: Macro) -> dict[str, str]:
        """Return the parameters and blocks that a field of an entry of `modules` gives, and that field."""
        place = self.place(macro)
        fields = dict.fromkeys(filter(None, place), ORIGIN) if None not in place else {}
        fields |= {block.name: ORIGIN for block in macro.blocks if block.name == ORIGIN and block.block == "*"}
        named = {"parent": self.parent(macro), "prefix": self.prefix(macro)}
        return fields | {own.name: field for field, own in named.items() if own}

    def place(self, macro: Macro) -> tuple[str | None, str | None]:
        """Return the parameters for the `xyz` and the `rpy` of the joint to the link above, None for none."""
        by_kind = {one.kind: one.parameter for one in reversed(self._of(macro)) if macro.parameter(one.parameter)}
        return by_kind.get("xyz"), by_kind.get("rpy")

    def parent(self, macro: Macro) -> OwnParent | None:
        """Return the parameter for the link above."""
        roles = self._of(macro)
        links = {(role.parameter, role.suffix) for role in roles if role.kind == "link"}
        parents = [
            OwnParent(role.parameter, role.suffix)
            for role in roles
            if role.kind == "parent" and macro.parameter(role.parameter) and (role.parameter, role.suffix) not in links
        ]
        if parents:
            return min(parents, key=lambda one: bool(one.suffix))
        # What becomes of it is not known before xacro runs: it is in a property, or goes to a macro of another file.
        named = (OwnParent(one.name, "") for one in macro.parameters if one.is_required and one.name in _PARENTS)
        return next(named, None)

    def prefix(self, macro: Macro) -> OwnPrefix | None:
        """Return the parameter with which the names begin."""
        named = [role for role in self._of(macro) if "prefix" in role.kind and "prefix" in role.parameter]
        name = next((role.parameter for role in named if macro.parameter(role.parameter)), None)
        if name is None:
            return OwnPrefix(_NAME, True, True) if self._starts_of(macro) == (_NAME,) else None
        return OwnPrefix(name, all(role.kind == "prefix_" for role in named if role.parameter == name))

    def _of(self, macro: Macro, depth: int = 0) -> tuple[Role, ...]:
        if macro.name not in self._roles:
            self._roles[macro.name] = ()  # while it calls itself
            found = dict.fromkeys(self._roles_in(macro, depth))
            self._roles[macro.name] = tuple(islice(found, _MOST_ROLES))
        return self._roles[macro.name]

    def _roles_in(self, macro: Macro, depth: int) -> Iterator[Role]:
        for element in macro.element.walk():
            if element.tag == "joint":
                yield from _roles_in_joint(element)
            if element.tag == "link" and (found := _WITH_END.fullmatch(element.get("name") or "")):
                yield Role(found[1], "link", found[2])
            if element.tag in ("link", "joint") and (found := _FIRST.match(element.get("name") or "")):
                yield Role(found[1], "prefix_" if found[2] else "prefix")
            if called := self._called(element, macro, depth):
                inner = self._of(called, depth + 1)
                yield from filter(None, (_role_outside(role, called, element) for role in inner))

    def _starts_of(self, macro: Macro, depth: int = 0) -> tuple[str | None, ...]:
        """Return the parameters with which names of links and joints begin, None for that of another name."""
        if macro.name not in self._starts:
            self._starts[macro.name] = ()
            self._starts[macro.name] = tuple(dict.fromkeys(self._starts_in(macro, depth)))
        return self._starts[macro.name]

    def _starts_in(self, macro: Macro, depth: int) -> Iterator[str | None]:
        for element in macro.element.walk():
            if called := self._called(element, macro, depth):
                yield from (_parameter_outside(one, called, element) for one in self._starts_of(called, depth + 1))
            elif element.tag in ("link", "joint"):
                found = _FIRST.match(element.get("name") or "")
                yield found[1] if found and macro.parameter(found[1]) else None

    def _called(self, element: XmlElement, caller: Macro, depth: int) -> Macro | None:
        """Return the macro that an element calls, which a namespace may have in place of those around it."""
        if depth == _MAX_DEPTH or not element.tag.startswith("xacro:"):
            return None
        macros, name = self._library.macros, element.tag.removeprefix("xacro:")
        *spaces, _ = caller.name.split(".")
        names = (".".join((*spaces[:count], name)) for count in range(len(spaces), -1, -1))
        return next((macros[one] for one in names if one in macros), None)


def _parameter_outside(name: str | None, called: Macro, call: XmlElement) -> str | None:
    """Return the parameter with which the value of a parameter of a called macro begins around the call."""
    parameter = called.parameter(name) if name else None
    if parameter is None or (given := call.get(parameter.name)) is None:
        return name if parameter and parameter.is_forwarded else None
    found = _FIRST.match(given)
    return found[1] if found else None


def _roles_in_joint(joint: XmlElement) -> Iterator[Role]:
    """Yield the parameters that are the parent of a joint, and its place there."""
    by_tag = {child.tag: child for child in joint.children}
    parent = _WITH_END.fullmatch(by_tag["parent"].get("link") or "") if "parent" in by_tag else None
    # A link whose name a macro composes is mostly its own, made by another macro.
    if parent is None or (parent[2] and "parent" not in parent[1]):
        return
    yield Role(parent[1], "parent", parent[2])
    kinds: tuple[Literal["xyz", "rpy"], ...] = ("xyz", "rpy")
    for kind in kinds:
        if "origin" in by_tag and (found := _ONLY.fullmatch(by_tag["origin"].get(kind) or "")):
            yield Role(found[1], kind)


def _role_outside(role: Role, called: Macro, call: XmlElement) -> Role | None:
    """Return what a role of a parameter of a called macro is around the call."""
    parameter, given = called.parameter(role.parameter), call.get(role.parameter)
    if given is None:
        return role if parameter and parameter.is_forwarded else None
    if role.kind in ("parent", "link") and (found := _WITH_END.fullmatch(given)):
        return Role(found[1], role.kind, found[2] + role.suffix)
    if found := _ONLY.fullmatch(given):
        return Role(found[1], role.kind)
    if "prefix" in role.kind and (found := _FIRST.match(given)):
        return Role(found[1], "prefix_" if found[2] else "prefix")
    return None


_EXPRESSION = re.compile(r"\$\{([^}]*)\}")
_HALF_OR_TWICE = r"(?<![\d.])(?:0?\.5|2(?:\.0*)?)(?![\d.])"


def dimension_of(parameter: str, macro: Macro) -> tuple[Dimension, Span] | None:
    """Return the dimension of a parameter, by the first attribute that has it, and the place of that.

    The attribute may have half of it, twice of it, or the sum with a number. Another factor may have a dimension of its
    own: `${length * 1.5}` may be the mass of a profile.
    """
    scaled = rf"(?:{_HALF_OR_TWICE}\s*\*\s*)?\b{re.escape(parameter)}\b(?:\s*[*/]\s*{_HALF_OR_TWICE})?"
    own = re.compile(rf"[-+\d.\s(]*{scaled}[-+\d.\s)]*")
    for element in macro.element.walk():
        for name, attribute in element.attributes.items():
            dimension = DIMENSIONS.get((element.tag, name))
            if dimension and any(map(own.fullmatch, _EXPRESSION.findall(element.values[name]))):
                return dimension, attribute.span
    return None
