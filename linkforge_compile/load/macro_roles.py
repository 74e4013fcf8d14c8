"""What the parameters of a macro are for, as it is written: the link above its joint, the place there, its prefix."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    from linkforge_compile.load.xacro_library import Macro, XacroLibrary
    from linkforge_compile.source.xml_tree import XmlElement


ORIGIN = "origin"
"""The block that an entry of `modules` gives as its `origin`."""


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
_PARENTS = ("parent", "parent_link")
_ONLY = re.compile(r"\s*\$\{\s*(\w+)\s*\}\s*")
_WITH_END = re.compile(r"\s*\$\{\s*(\w+)\s*\}([\w.-]*)\s*")
_FIRST = re.compile(r"\s*\$\{\s*(\w+)\s*\}(_)?")


def parameters_with(kind: str, macro: Macro, roles: Iterable[Role]) -> Iterator[str]:
    return (role.parameter for role in roles if role.kind == kind and macro.parameter(role.parameter))


def fields_of(macro: Macro, library: XacroLibrary) -> dict[str, str]:
    """Return the parameters and blocks that a field of an entry of `modules` gives, and that field."""
    roles = [*roles_of(macro, library)]
    place = [next(parameters_with(kind, macro, roles), None) for kind in ("xyz", "rpy")]
    fields = dict.fromkeys(filter(None, place), ORIGIN) if None not in place else {}
    fields |= {block.name: ORIGIN for block in macro.blocks if block.name == ORIGIN and block.block == "*"}
    named = {"parent": own_parent(macro, roles), "prefix": own_prefix(macro, library, roles)}
    return fields | {own.name: field for field, own in named.items() if own}


def own_parent(macro: Macro, roles: Sequence[Role]) -> OwnParent | None:
    links = {(role.parameter, role.suffix) for role in roles if role.kind == "link"}
    parents = [
        OwnParent(role.parameter, role.suffix)
        for role in roles
        if role.kind == "parent" and macro.parameter(role.parameter) and (role.parameter, role.suffix) not in links
    ]
    if parents:
        return min(parents, key=lambda one: bool(one.suffix))
    # What becomes of it is not known before xacro runs: it is in a property, or goes to a macro of another file.
    return next((OwnParent(one.name, "") for one in macro.parameters if one.is_required and one.name in _PARENTS), None)


def own_prefix(macro: Macro, library: XacroLibrary, roles: Iterable[Role]) -> OwnPrefix | None:
    named = [role for role in roles if "prefix" in role.kind and "prefix" in role.parameter]
    name = next((role.parameter for role in named if macro.parameter(role.parameter)), None)
    if name is None:
        return OwnPrefix(_NAME, True, True) if {*_starts(macro, library)} == {_NAME} else None
    return OwnPrefix(name, all(role.kind == "prefix_" for role in named if role.parameter == name))


def _starts(macro: Macro, library: XacroLibrary, callers: frozenset[str] = frozenset()) -> Iterator[str | None]:
    """Yield for each name of a link or joint the parameter with which it begins, None for none of the macro's."""
    for element in macro.element.walk():
        called = library.macros.get(element.tag.removeprefix("xacro:")) if element.tag.startswith("xacro:") else None
        if called and called.name not in callers:
            for start in {*_starts(called, library, callers | {macro.name})}:
                yield _parameter_outside(start, called, element)
        elif element.tag in ("link", "joint"):
            found = _FIRST.match(element.get("name") or "")
            yield found[1] if found and macro.parameter(found[1]) else None


def _parameter_outside(name: str | None, called: Macro, call: XmlElement) -> str | None:
    """Return the parameter with which the value of a parameter of a called macro begins around the call."""
    parameter = called.parameter(name) if name else None
    if parameter is None or (given := call.get(parameter.name)) is None:
        return name if parameter and parameter.is_forwarded else None
    found = _FIRST.match(given)
    return found[1] if found else None


def roles_of(macro: Macro, library: XacroLibrary, callers: frozenset[str] = frozenset()) -> Iterator[Role]:
    """Yield what names in a macro are for, also in the macros that it calls."""
    for element in macro.element.walk():
        if element.tag == "joint":
            yield from _roles_in_joint(element)
        if element.tag == "link" and (found := _WITH_END.fullmatch(element.get("name") or "")):
            yield Role(found[1], "link", found[2])
        if element.tag in ("link", "joint") and (found := _FIRST.match(element.get("name") or "")):
            yield Role(found[1], "prefix_" if found[2] else "prefix")
        called = library.macros.get(element.tag.removeprefix("xacro:")) if element.tag.startswith("xacro:") else None
        if called and called.name not in callers:
            inner = roles_of(called, library, callers | {macro.name})
            yield from filter(None, (_role_outside(role, called, element) for role in inner))


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
