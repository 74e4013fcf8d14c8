"""Read the document of a URDF or SRDF: a named `<robot>` without xacro."""

from __future__ import annotations

import posixpath
from collections.abc import Callable
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import NOT_A_ROBOT, NOTHING_EXPANDED, ROBOT_WITHOUT_NAME, STILL_XACRO
from linkforge_compile.importers.comments import Comments
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
from linkforge_compile.syntax import YamlMap

Move = Callable[[XmlDocument], XmlDocument]
"""Gives the elements of a document the places where they were written."""


class Imported(NamedTuple):
    """The spec of an imported robot: its tree, with the spans of the documents, and its comments."""

    tree: YamlMap
    comments: Comments
    documents: tuple[XmlDocument, ...] = ()
    """The URDF, then the SRDF."""


def read_document(file: SourceFile, sink: Diagnostics, moved: Move | None = None) -> XmlDocument | None:
    """Return the document of a named robot; None if the file is none, which is reported.

    `moved` is given for a document that was expanded from a xacro.
    """
    document = read_xml(file, sink)
    if document is None:
        return None
    document = moved(document) if moved else document
    root = document.root
    if root.tag != "robot":
        sink.report(NOT_A_ROBOT.at(root.span, tag=root.tag))
        return None
    if xacro := _first_of_xacro(root):
        name = posixpath.basename(file.name).removesuffix(".xml") if file.path else "NAME.urdf"
        sink.report(STILL_XACRO.at(xacro.span, tag=xacro.tag, name=f"{name}.xacro"))
        return None
    if moved and not root.children:
        sink.report(NOTHING_EXPANDED.at(root.span))
        return None
    if root.get("name") is None:
        sink.report(ROBOT_WITHOUT_NAME.at(root.span))
        return None
    return document


def _first_of_xacro(root: XmlElement) -> XmlElement | None:
    """Return the first element that xacro would have replaced, at any depth."""
    if "<xacro:" not in root.raw:
        return None
    stack = [root]
    while stack:
        element = stack.pop()
        if element.tag.startswith("xacro:"):
            return element
        stack += reversed(element.children)
    return None
