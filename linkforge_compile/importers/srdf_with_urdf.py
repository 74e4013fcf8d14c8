"""Add an SRDF to the spec of its URDF; what the language refuses of the SRDF stays raw."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator

from linkforge_compile.compilation import Compilation
from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.importing import KEPT_RAW, SRDF_OF_ANOTHER, SRDF_OF_MORE, URDF_FOR_SRDF
from linkforge_compile.diagnostics.grouping import join_names
from linkforge_compile.importers.document import Comments, Imported, Move, read_document
from linkforge_compile.importers.renaming import is_reference, rename_references
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.srdf import SemanticNames, read_srdf
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.xml_tree import XmlAttribute, XmlDocument, XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_MAX_ROUNDS = 20
"""How often an SRDF is read again without what the language refuses, which may uncover another part of the same name.

What the language refuses in the last round is reported as an error.
"""

_MAX_READ = 20_000
"""How many elements of both documents are read in all rounds together, unless two rounds are more."""

_GROUP_REFERENCES = ("group", "parent_group")
"""Attributes that name planning groups."""

_SEVERAL = 3
"""So many unknown names are parts that the robot does not have; fewer are probably misspelled, and reported each."""


def with_srdf(
    urdf: Imported,
    file: SourceFile,
    check: Callable[[YamlMap], Compilation],
    sink: Diagnostics,
    moved: Move | None = None,
) -> tuple[Imported, Compilation] | None:
    """Return the spec of a URDF with the content of an SRDF, and the result of `check`; None if it is no SRDF."""
    document = read_document(file, sink, moved)
    if document is None:
        return None
    # As raw XML in the semantic part, the links and joints of a URDF would become part of the SRDF.
    if part := next((child for child in document.root.children if child.tag in ("link", "joint")), None):
        sink.report(URDF_FOR_SRDF.at(part.span, tag=part.tag))
        return None
    document = rename_references(document, urdf.renamed)
    refused: dict[XmlElement, CannotRepresentError] = {}
    entries = sum(len(entry.value) for entry in urdf.tree if isinstance(entry.value, YamlMap))
    elements = entries + sum(1 for _ in document.root.walk())
    for _ in range(max(2, min(_MAX_ROUNDS, _MAX_READ // elements))):
        round_sink = Diagnostics()
        whole = _merge(urdf, read_srdf(document, urdf, round_sink, refused))
        checked = check(whole.tree)
        found = _refusals(document, checked.diagnostics)
        if found.keys() <= refused.keys():
            break
        refused |= found
    sink.report_all(_without_absent_parts(round_sink, document, whole.tree))
    return whole, checked


def _without_absent_parts(found: Diagnostics, document: XmlDocument, robot: YamlMap) -> Iterator[Diagnostic]:
    """Yield the diagnostics of an SRDF; one replaces those about parts of another robot, or of a larger one."""
    if other := _find_other_robot(document, robot):
        yield other
        yield from (one for one in found if one.code is not KEPT_RAW)
        return
    absent = _find_absent_parts(document, robot)
    names = dict.fromkeys(one.value for one in absent)
    if len(names) < _SEVERAL:
        yield from found
        return
    yield SRDF_OF_MORE.at(absent[0].span, robot=_name_of(robot), names=join_names(names))
    explained = {one.span for one in absent} | set(_spans_of_absent_groups(document, robot))
    yield from (one for one in found if not (one.code is KEPT_RAW and one.span in explained))


def _find_absent_parts(document: XmlDocument, robot: YamlMap) -> list[XmlAttribute]:
    """Return what names links and joints that neither the robot nor the SRDF has, in the order of the file."""
    known = SemanticNames.of(robot)
    names = known.links | known.joints | _names_in(robot, "virtual_joints")
    return [one for one in _references(document.root) if one.value not in names]


def _spans_of_absent_groups(document: XmlDocument, robot: YamlMap) -> Iterator[Span]:
    """Yield the elements and attributes that name planning groups which are not in the spec."""
    groups = _names_in(robot, "groups")
    for element in document.root.walk():
        for name, attribute in element.attributes.items():
            if (name in _GROUP_REFERENCES or (name == "name" and element.tag == "group")) and (
                attribute.value not in groups
            ):
                yield from (element.span, attribute.span)


def _names_in(robot: YamlMap, section: str) -> set[str]:
    semantic = robot.get("semantic")
    entries = semantic.child(section) if semantic else None
    return {entry.name for entry in entries} if isinstance(entries, YamlMap) else set()


def _name_of(robot: YamlMap) -> str:
    name = robot.get("name")
    return name.text if isinstance(name, YamlScalar) else ""


def _find_other_robot(document: XmlDocument, robot: YamlMap) -> Diagnostic | None:
    """Return a diagnostic if an SRDF names links and joints, but none of the robot's."""
    known, references = SemanticNames.of(robot), list(_references(document.root))
    if not references or any(one.value in known.links or one.value in known.joints for one in references):
        return None
    names = {one.value for one in references}
    first = references[0]
    return SRDF_OF_ANOTHER.at(first.span, robot=_name_of(robot), name=first.value, count=len(names))


def _references(element: XmlElement) -> Iterator[XmlAttribute]:
    """Yield the attributes that name links and joints, in the order of the file."""
    for name, attribute in element.attributes.items():
        if is_reference(element.tag, name):
            yield attribute
    for child in element.children:
        yield from _references(child)


def _merge(urdf: Imported, srdf: Imported) -> Imported:
    """Return the spec of a URDF with the semantic part of an SRDF."""
    tree = YamlMap({**urdf.tree.entries, **srdf.tree.entries}, urdf.tree.span)
    endings: dict[YamlNode, str] = {}
    for one in (urdf, srdf):
        for node, text in one.comments.endings.items():
            holder = tree if node is one.tree else node
            endings[holder] = f"{endings[holder]}\n{text}" if holder in endings else text
    comments = Comments({**urdf.comments.above, **srdf.comments.above}, endings)
    return Imported(tree, comments, (*urdf.documents, *srdf.documents))


def _refusals(document: XmlDocument, faults: tuple[Diagnostic, ...]) -> dict[XmlElement, CannotRepresentError]:
    """Return the elements of an SRDF that have an error; those that a xacro made in one place have it together."""
    if not faults:
        return {}
    owners = defaultdict[Span, list[XmlElement]](list)
    for element in document.root.walk():
        for span in {*_spans(element)}:
            owners[span].append(element)
    refused: dict[XmlElement, CannotRepresentError] = {}
    for fault in faults:
        if fault.span is not None:
            for owner in owners.get(fault.span, ()):
                refused.setdefault(owner, CannotRepresentError(fault.message, fault.span))
    return refused


def _spans(element: XmlElement) -> Iterator[Span]:
    yield element.span
    yield from (attribute.span for attribute in element.attributes.values())
