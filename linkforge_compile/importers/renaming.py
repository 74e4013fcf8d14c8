"""Replace characters in the names of a document that URDF readers accept and the language does not, such as spaces.

TF, topics and interfaces of ros2_control do not have them either. A name is replaced wherever it is a whole value or a
whole text, also in what plugins read; each character becomes one `_`, or another one where that name is taken.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import NAME_REPLACED
from linkforge_compile.source.xml_tree import ATTRIBUTE, MARKUP, XmlAttribute, XmlContent, XmlDocument, XmlElement
from linkforge_compile.syntax.nodes import xacro_facts

_NAMED = ("link", "joint", "transmission")
_FILLERS = "_-."
_REFERENCES = ("link", "link1", "link2", "base_link", "tip_link", "parent_link", "child_link", "joint_name")
"""Attributes of an SRDF that name links and joints."""
_NAMED_BY_NAME = ("link", "joint", "passive_joint")
"""Tags of an SRDF whose attribute `name` names a link or joint."""
_NUMBERS = re.compile(r"[-+.\deE\s]+")
"""A value that may be a size or an axis; as a name it is replaced only in the attributes of `_NAMING`."""
_NAMING = ("name", "link", "joint", "reference")
_WHOLE_TEXT = re.compile(r"""(?<=["'>])[^"'<>]+(?=["'<])""")

Renamed = Mapping[str, str]
"""Names by those in the document."""


def rename_parts(document: XmlDocument, sink: Diagnostics) -> tuple[XmlDocument, Renamed]:
    """Return a URDF with valid names of the robot, its links, joints and transmissions; report what is replaced."""
    root = document.root
    named = [root, *(child for child in root.children if child.tag in _NAMED)]
    renamed = _valid_names(dict.fromkeys(name for element in named if (name := element.get("name"))))
    if not renamed:
        return document, renamed
    _report(root, renamed, sink)
    return _with_root(document, _with_names(root, renamed)), renamed


def rename_references(document: XmlDocument, renamed: Renamed) -> XmlDocument:
    """Return an SRDF with the names that the links and joints of its robot have got in the URDF."""
    if not renamed:
        return document
    root = document.root
    values = {key: renamed.get(value, value) if key == "name" else value for key, value in root.values.items()}
    return _with_root(document, _with_references(root, renamed)._replace(values=values))


def is_reference(tag: str, attribute: str) -> bool:
    """Whether an attribute in an SRDF names a link or joint."""
    return attribute in _REFERENCES or (attribute == "name" and tag in _NAMED_BY_NAME)


def rename_in_raw(raw: str, renamed: Renamed) -> str:
    """Return raw XML of a URDF with its names replaced."""
    return _WHOLE_TEXT.sub(lambda found: _new_name(found[0], renamed), raw) if renamed else raw


def rename_in_raw_srdf(raw: str, renamed: Renamed) -> str:
    """Return raw XML of an SRDF with the new names of links and joints."""

    def rename(start: re.Match[str]) -> str:
        def rename_one(found: re.Match[str]) -> str:
            value = "single" if found["double"] is None else "double"
            if found[value] not in renamed or not is_reference(start["tag"], found["name"]):
                return found[0]
            return f"{found[0][: found.start(value) - found.start()]}{renamed[found[value]]}{found[0][-1]}"

        return ATTRIBUTE.sub(rename_one, start[0]) if start["tag"] else start[0]

    return MARKUP.sub(rename, raw) if renamed else raw


def _valid_names(names: Collection[str]) -> Renamed:
    """Return the first free replacement of each name that is not valid; names of expressions stay as they are."""
    renamed: dict[str, str] = {}
    taken = set(names)
    for name in names:
        if not name.strip() or is_valid_name(name) or xacro_facts(name):
            continue
        candidates = ("".join(one if is_valid_name(one) else filler for one in name) for filler in _FILLERS)
        if valid := next((one for one in candidates if one not in taken), None):
            renamed[name] = valid
            taken.add(valid)
    return renamed


def _with_root(document: XmlDocument, root: XmlElement) -> XmlDocument:
    return XmlDocument(root, tuple(root if item is document.root else item for item in document.content))


def _report(root: XmlElement, renamed: Renamed, sink: Diagnostics) -> None:
    """Report the first name that is replaced, and how many more there are."""
    first: dict[str, XmlAttribute] = {}
    for element in root.walk():
        if not renamed.keys().isdisjoint(element.values.values()):
            for attribute in element.attributes.values():
                first.setdefault(attribute.value, attribute)
    places = [attribute for name, attribute in first.items() if name in renamed]
    name = places[0].value
    count = len(places) - 1
    notes = [Note(f"and {count} more like this, the next one here", places[1].span)] if count else []
    sink.report(NAME_REPLACED.at(places[0].span, name=name, new=renamed[name], notes=notes))


def _with_names(element: XmlElement, renamed: Renamed) -> XmlElement:
    values = {
        key: renamed.get(value, value) if key in _NAMING or not _NUMBERS.fullmatch(value) else value
        for key, value in element.values.items()
    }
    content: tuple[XmlContent, ...] = tuple(
        _with_names(item, renamed)
        if isinstance(item, XmlElement)
        else _new_name(item, renamed)
        if isinstance(item, str)
        else item
        for item in element.content
    )
    children = tuple(item for item in content if isinstance(item, XmlElement))
    text = "".join(item for item in content if isinstance(item, str))
    return element.with_content(values, content, children, text)


def _with_references(element: XmlElement, renamed: Renamed) -> XmlElement:
    values = {
        name: renamed.get(value, value) if is_reference(element.tag, name) else value
        for name, value in element.values.items()
    }
    content: tuple[XmlContent, ...] = tuple(
        _with_references(item, renamed) if isinstance(item, XmlElement) else item for item in element.content
    )
    children = tuple(item for item in content if isinstance(item, XmlElement))
    return element.with_content(values, content, children, element.text)


def _new_name(text: str, renamed: Renamed) -> str:
    name = text.strip()
    return text.replace(name, renamed[name]) if name in renamed else renamed.get(text, text)
