"""The joint that attaches the links of a macro to others, and what else of a macro is about others."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice

from linkforge_compile.migration.placeholders import key_of
from linkforge_compile.migration.symbols import (
    CannotTranslateError,
    NotConstantError,
    Parts,
    Reference,
    as_expression,
    as_parts,
    joined,
    symbols_in,
    symbols_of,
)
from linkforge_compile.migration.template import Choice, Content, Element, FileDraft, Use, walk
from linkforge_compile.migration.written import canonical
from linkforge_compile.source.xml_tree import XmlElement

Links = Mapping[str, str]
"""The names of links by what they may be, where a part of a name is chosen."""

_MOST_ALTERNATIVES = 16

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
    links = _links(found)
    joints = [(one, guards) for one, guards in found if one.tag == "joint"]
    if not links:
        what = "it has joints, and no links" if joints else "it has no links and joints"
        raise CannotTranslateError(what)
    outside = [(one, guards) for one, guards in joints if _end(one, "parent", links) not in links]
    if conditions := [test for _, guards in outside for test in guards]:
        raise NotConstantError(frozenset().union(*map(symbols_in, conditions)))
    children = {_end(one, "child", links) for one, _ in joints if _end(one, "parent", links) in links}
    roots = {*links.values()} - children
    certain = {_name(one, "name") for one, guards in found if one.tag == "link" and not guards}
    if not roots or len(roots & certain) > 1 or len(_trees(links, [one for one, _ in joints])) > 1:
        raise CannotTranslateError("its links are not one tree")
    if len(outside) > 1:
        raise CannotTranslateError("more than one joint attaches it to other links")
    attached = outside[0][0] if outside else None
    if attached is not None and id(attached) not in own and not may_be_nested:
        raise CannotTranslateError("the joint that attaches it is in a macro that is a module")
    if attached is not None and _end(attached, "child", links) not in roots:
        raise CannotTranslateError("the joint to another link does not carry its root")
    _require_own(found, links, {_name(one, "name") for one, _ in joints})
    return attached


def outer_parts(content: list[Content]) -> frozenset[XmlElement]:
    """Return what of a content is about other parts, so that the file that uses it as a module has to have it.

    These are the joints to other links, unless one always carries the root of its largest tree of links, the links of
    its other trees, and settings for parts outside of it.
    """
    found = list(parts_of(content, ()))
    links = _links(found)
    joints = [(one, guards) for one, guards in found if one.tag == "joint"]
    inner = [one for one, _ in joints if _end(one, "parent", links) in links and _end(one, "child", links) in links]
    roots = {*links.values()} - {_end(one, "child", links) for one in inner}
    outer = [(one, guards) for one, guards in joints if one not in inner]
    tree = _main_tree(links, inner, roots)
    mounts = [one for one, guards in outer if not guards and _end(one, "child", links) in tree & roots]
    carried = {_end(one, "child", links) for one, _ in outer} - tree
    is_mount = len(mounts) == 1 and len(outer) == 1 + len(
        [one for one, _ in outer if _end(one, "child", links) in carried]
    )
    moved = [one for one, _ in outer if not (is_mount and one in mounts)]
    moved += [one for one in inner if _end(one, "child", links) not in tree]
    moved += [one for one, _ in found if one.tag == "link" and _name(one, "name") not in tree]
    names = tree | {_name(one, "name") for one, _ in joints if one not in moved}
    moved += [one for one, _ in found if one.tag in _SETTINGS and not _subjects(one) <= names]
    return frozenset(one.origin for one in moved if one.origin is not None)


def parameters_in_names(content: list[Content]) -> frozenset[str]:
    """Return the parameters in the names of links and joints."""
    names = (one.attributes.get("name", ()) for one, _ in parts_of(content, ()) if one.tag in ("link", "joint"))
    symbols = frozenset().union(*(symbols_of(canonical(parts)) for parts in names))
    return frozenset(one.wish for one in symbols if one.role == "parameter")


def settings_outside(content: list[Content]) -> frozenset[XmlElement]:
    """Return the settings of a content that are for parts outside of it."""
    found = [one for one, _ in parts_of(content, ())]
    names = {_name(one, "name") for one in found if one.tag in ("link", "joint")}
    outside = (one for one in found if one.tag in _SETTINGS and not _subjects(one) <= names)
    return frozenset(one.origin for one in outside if one.origin is not None)


def _main_tree(links: Links, joints: list[Element], roots: set[str]) -> set[str]:
    """Return the links of the tree that has most of them; all of them if there is none."""
    names = {*links.values()}
    largest = max(_trees(links, joints), key=len, default=names)
    return largest if largest & roots and 2 * len(largest) > len(names) else names


def _trees(links: Links, joints: list[Element]) -> list[set[str]]:
    """Return the links that hang together; the root of them may be another one on each condition."""
    beside: dict[str, list[str]] = {name: [] for name in links.values()}
    for joint in joints:
        parent, child = _end(joint, "parent", links), _end(joint, "child", links)
        if parent in beside and child in beside:
            beside[parent].append(child)
            beside[child].append(parent)
    trees: list[set[str]] = []
    seen: set[str] = set()
    for name in beside:
        waiting, tree = [name], set[str]()
        while waiting:
            if (link := waiting.pop()) not in seen:
                seen.add(link)
                tree.add(link)
                waiting += beside[link]
        trees += [tree] if tree else []
    return trees


def repeated_parts(contents: list[list[Content]]) -> frozenset[XmlElement]:
    """Return the elements of ros2_control and transmissions that have one name in several contents, as raw XML may."""
    found = [one for content in contents for one, _ in parts_of(content, ()) if one.tag in _SETTINGS[1:]]
    names = Counter((one.tag, _name(one, "name")) for one in found)
    return frozenset(one.origin for one in found if one.origin and names[one.tag, _name(one, "name")] > 1)


_SETTINGS = ("gazebo", "ros2_control", "transmission")


def _subjects(settings: Element) -> set[str]:
    """Return the names of the parts that settings are about."""
    if settings.tag == "gazebo":
        return {name} if (name := _name(settings, "reference")) else set()
    return {_name(one, "name") for one in settings.content if isinstance(one, Element) and one.tag == "joint"}


def _own_elements(content: list[Content]) -> Iterator[Element]:
    for one in content:
        if isinstance(one, Choice):
            yield from _own_elements(one.content)
        elif isinstance(one, Element):
            yield one


def _require_own(found: list[tuple[Element, Guards]], links: Links, joints: set[str]) -> None:
    for one, _ in found:
        if one.tag in _SETTINGS and not _subjects(one) <= {*links.values()} | joints:
            raise CannotTranslateError("it has settings for a part outside of it")
        if one.tag == "joint":
            for part in one.content:
                if isinstance(part, Element) and part.tag == "mimic" and _name(part, "joint") not in joints:
                    raise CannotTranslateError("a joint of it follows one outside of it")
            if _end(one, "child", links) not in links:
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
    return _text_of(canonical(element.attributes.get(attribute, ())))


def _text_of(parts: Parts) -> str:
    return "".join(part if isinstance(part, str) else f"<{key_of(part)}>" for part in parts)


def _links(found: Iterable[tuple[Element, Guards]]) -> Links:
    links: dict[str, str] = {}
    for name in [one.attributes.get("name", ()) for one, _ in found if one.tag == "link"]:
        texts = [_text_of(parts) for parts in _alternatives(name)]
        links |= {text: texts[0] for text in texts if text == texts[0] or text not in links}
    return links


def _end(joint: Element, tag: str, links: Links) -> str:
    """Return the name of the link at an end of a joint; of alternatives the one that is among certain links."""
    found = next((one for one in joint.content if isinstance(one, Element) and one.tag == tag), None)
    if found is None:
        return ""
    texts = [_text_of(parts) for parts in _alternatives(found.attributes.get("link", ()))]
    return next((links[text] for text in texts if text in links), texts[0])


def _alternatives(parts: Parts) -> Iterator[Parts]:
    """Yield a text as it is, and then with each alternative of what is chosen in it."""
    parts = canonical(parts)
    yield parts
    for number, part in enumerate(parts):
        choice = part
        if isinstance(part, Reference) and part.symbol.role == "variable" and part.symbol.value:
            choice = as_expression(part.symbol.value)
        if isinstance(choice, ast.IfExp):
            for side in (choice.body, choice.orelse):
                others = _alternatives(joined(parts[:number], as_parts(side), parts[number + 1 :]))
                yield from islice(others, _MOST_ALTERNATIVES)
            return


def require_known_blocks(file: FileDraft) -> None:
    """Refuse a module in which a block that is no parameter is anywhere but in the attaching joint."""
    attached = file.attachment.content if file.attachment else []
    for one in walk(file.content):
        if isinstance(one, Element) and one.calls == ("block", "") and one not in attached:
            raise CannotTranslateError("it inserts a block of its call")
