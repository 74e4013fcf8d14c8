"""The joint that attaches the links of a macro to others, if the macro can be a module."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkforge_compile.migration.placeholders import key_of
from linkforge_compile.migration.symbols import CannotTranslateError, NotConstantError, symbols_in
from linkforge_compile.migration.template import Choice, Content, Element, Use
from linkforge_compile.migration.written import canonical

Guards = tuple[ast.expr, ...]
"""The conditions under which something exists."""


def find_attachment(content: list[Content], *, may_be_nested: bool = False) -> Element | None:
    """Return the joint that attaches the links of a content to another link; None if there is none.

    It is in the content itself, or `may_be_nested` in what a module in it is.

    Raises:
        CannotTranslateError: if the content cannot be a module: its links are not one tree, or it is about others.
        NotConstantError: if that depends on names.

    """
    found = list(parts_of(content, ()))
    own = {id(one) for one in _own_elements(content)}
    links = {_name(one, "name") for one, _ in found if one.tag == "link"}
    joints = [(one, guards) for one, guards in found if one.tag == "joint"]
    if not links:
        raise CannotTranslateError("it has no links of its own")
    outside = [(one, guards) for one, guards in joints if _end(one, "parent") not in links]
    if conditions := [test for _, guards in outside for test in guards]:
        raise NotConstantError(frozenset().union(*map(symbols_in, conditions)))
    children = {_end(one, "child") for one, _ in joints if _end(one, "parent") in links}
    roots = links - children
    if len(roots) != 1:
        raise CannotTranslateError("its links are not one tree")
    if len(outside) > 1:
        raise CannotTranslateError("more than one joint attaches it to other links")
    attached = outside[0][0] if outside else None
    if attached is not None and id(attached) not in own and not may_be_nested:
        raise CannotTranslateError("the joint that attaches it is in a macro that is a module")
    if attached is not None and _end(attached, "child") not in roots:
        raise CannotTranslateError("the joint to another link does not carry its root")
    _require_own(found, links, {_name(one, "name") for one, _ in joints})
    return attached


def _own_elements(content: list[Content]) -> Iterator[Element]:
    for one in content:
        if isinstance(one, Choice):
            yield from _own_elements(one.content)
        elif isinstance(one, Element):
            yield one


def _require_own(found: list[tuple[Element, Guards]], links: set[str], joints: set[str]) -> None:
    for one, _ in found:
        if one.tag == "gazebo" and (reference := _name(one, "reference")) and reference not in links | joints:
            raise CannotTranslateError("it has settings for a part outside of it")
        if one.tag in ("ros2_control", "transmission"):
            inner = {_name(part, "name") for part in one.content if isinstance(part, Element) and part.tag == "joint"}
            if inner - joints:
                raise CannotTranslateError(f"its {one.tag} is about joints outside of it")
        if one.tag == "joint":
            for part in one.content:
                if isinstance(part, Element) and part.tag == "mimic" and _name(part, "joint") not in joints:
                    raise CannotTranslateError("a joint of it follows one outside of it")
            if _end(one, "child") not in links:
                raise CannotTranslateError("a joint of it carries a link outside of it")


def parts_of(content: list[Content], guards: Guards) -> Iterator[tuple[Element, Guards]]:
    for one in content:
        if isinstance(one, Choice):
            yield from parts_of(one.content, (*guards, one.test))
        elif isinstance(one, Element):
            yield one, guards
        elif isinstance(one, Use) and one.inline is not None:
            yield from parts_of(one.inline, guards)


def _name(element: Element, attribute: str) -> str:
    parts = canonical(element.attributes.get(attribute, ()))
    return "".join(part if isinstance(part, str) else f"<{key_of(part)}>" for part in parts)


def _end(joint: Element, tag: str) -> str:
    found = next((one for one in joint.content if isinstance(one, Element) and one.tag == tag), None)
    return _name(found, "link") if found else ""
