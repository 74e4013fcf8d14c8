"""Replace characters in the names of a document that readers of URDF accept and the language does not, such as spaces.

TF, topics and interfaces of ros2_control do not have them either. A name is replaced wherever it is a whole value or a
whole text, also in what plugins read; each character becomes one `_`, or another one where that name is taken.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping

from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import NAME_REPLACED
from linkforge_compile.source.xml_tree import XmlAttribute, XmlContent, XmlDocument, XmlElement
from linkforge_compile.syntax.nodes import xacro_facts

_NAMED = ("link", "joint", "transmission")
_FILLERS = "_-."
_WHOLE_TEXT = re.compile(r"""(?<=["'>])[^"'<>]+(?=["'<])""")

Renamed = Mapping[str, str]
"""Names by those in the document."""


def rename_parts(document: XmlDocument, sink: Diagnostics) -> tuple[XmlDocument, Renamed]:
    """Return a URDF with valid names of the robot, its links, joints and transmissions; report what is replaced."""
    root = document.root
    named = [root, *(child for child in root.children if child.tag in _NAMED)]
    taken = dict.fromkeys(name for element in named if (name := element.get("name")))
    renamed = _valid_names(taken, lambda name: name not in taken)
    if renamed:
        _report(root, renamed, sink)
    return _with_names_in(document, renamed), renamed


def rename_references(document: XmlDocument, known: Collection[str]) -> XmlDocument:
    """Return an SRDF with the names that the parts of its robot, which are `known`, got in the URDF."""
    written = dict.fromkeys(value for element in document.root.walk() for value in element.values.values())
    return _with_names_in(document, _valid_names(written, known.__contains__))


def rename_in_raw(raw: str, renamed: Renamed) -> str:
    """Return raw XML with its names replaced."""
    return _WHOLE_TEXT.sub(lambda found: _new_name(found[0], renamed), raw) if renamed else raw


def _valid_names(names: Iterable[str], is_usable: Callable[[str], bool]) -> Renamed:
    """Return the first usable replacement of each name that is not valid; names of expressions stay as they are."""
    renamed: dict[str, str] = {}
    for name in names:
        if not name.strip() or is_valid_name(name) or xacro_facts(name):
            continue
        candidates = ("".join(one if is_valid_name(one) else filler for one in name) for filler in _FILLERS)
        if valid := next((one for one in candidates if is_usable(one) and one not in renamed.values()), None):
            renamed[name] = valid
    return renamed


def _with_names_in(document: XmlDocument, renamed: Renamed) -> XmlDocument:
    if not renamed:
        return document
    root = _with_names(document.root, renamed)
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
    values = {key: renamed.get(value, value) for key, value in element.values.items()}
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


def _new_name(text: str, renamed: Renamed) -> str:
    name = text.strip()
    return text.replace(name, renamed[name]) if name in renamed else renamed.get(text, text)
