"""An SRDF beside its URDF: one spec of both, in which what the language refuses of the SRDF stays raw."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol, TypeVar

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.importing import KEPT_RAW, SRDF_OF_ANOTHER, URDF_FOR_SRDF
from linkforge_compile.importers.comments import Comments
from linkforge_compile.importers.document import Imported, Move, read_document
from linkforge_compile.importers.spec_draft import CannotRepresentError
from linkforge_compile.importers.srdf.known import Known, named_parts
from linkforge_compile.importers.srdf.semantic import read_srdf
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_MOST_ROUNDS = 20
"""So often is an SRDF read anew without what the language refuses of it, which may have hidden another of its name.

What it still refuses then is told as errors of the SRDF.
"""

_MOST_JUDGED = 20_000
"""How many elements of both are read anew in all rounds together: twice are read as many as there are."""


class Judged(Protocol):
    """What is known of a spec, its errors among it."""

    @property
    def faults(self) -> tuple[Diagnostic, ...]: ...


J = TypeVar("J", bound=Judged)


def with_srdf(
    urdf: Imported,
    file: SourceFile,
    judge: Callable[[YamlMap], J],
    sink: Diagnostics,
    moved: Move | None = None,
) -> tuple[Imported, J] | None:
    """Return the spec of a URDF with what an SRDF says, and what is known of it; None where that is no SRDF."""
    document = read_document(file, sink, moved)
    if document is None:
        return None
    # Kept raw in the semantic part, the whole robot would come out as an SRDF.
    if part := next((child for child in document.root.children if child.tag in ("link", "joint")), None):
        sink.report(URDF_FOR_SRDF.at(part.span, tag=part.tag))
        return None
    refused: dict[Span, CannotRepresentError] = {}
    sections = sum(len(entry.value) for entry in urdf.tree if isinstance(entry.value, YamlMap))
    elements = 1 + sections + sum(1 for _ in _inside(document.root))
    for _ in range(max(2, min(_MOST_ROUNDS, _MOST_JUDGED // elements))):
        told = Diagnostics()
        whole = _with_semantic(urdf, read_srdf(document, urdf.tree, told, refused))
        judged = judge(whole.tree)
        found = _refusals(document, judged.faults)
        if found.keys() <= refused.keys():
            break
        refused |= found
    other = _of_another_robot(document, urdf.tree)
    if other:
        sink.report(other)
    # That all of another robot's SRDF is kept raw is told in one.
    sink.report_all(one for one in told if not (other and one.code is KEPT_RAW))
    return whole, judged


def _of_another_robot(document: XmlDocument, robot: YamlMap) -> Diagnostic | None:
    """Return what tells that an SRDF names links and joints, and none of them is one of the robot."""
    known, said = Known.of(robot), list(named_parts(document.root))
    if not said or any(part.value in known.links or part.value in known.joints for part in said):
        return None
    names = dict.fromkeys(part.value for part in said)
    name = robot.get("name")
    return SRDF_OF_ANOTHER.at(
        said[0].span, robot=name.text if isinstance(name, YamlScalar) else "", name=said[0].value, count=len(names)
    )


def _with_semantic(urdf: Imported, srdf: Imported) -> Imported:
    """Return the spec of a URDF with the semantic part of an SRDF."""
    tree = YamlMap({**urdf.tree.entries, **srdf.tree.entries}, urdf.tree.span)
    endings: dict[YamlNode, str] = {}
    for one in (urdf, srdf):
        for node, text in one.comments.endings.items():
            holder = tree if node is one.tree else node
            endings[holder] = f"{endings[holder]}\n{text}" if holder in endings else text
    comments = Comments({**urdf.comments.above, **srdf.comments.above}, endings)
    return Imported(tree, comments, (*urdf.documents, *srdf.documents))


def _refusals(document: XmlDocument, faults: tuple[Diagnostic, ...]) -> dict[Span, CannotRepresentError]:
    """Return the elements of an SRDF, by their spans, of which an error tells that the language refuses them."""
    if not faults:
        return {}
    owners = {span: element for element in _inside(document.root) for span in _spans(element)}
    refused: dict[Span, CannotRepresentError] = {}
    for fault in faults:
        if fault.span is not None and (owner := owners.get(fault.span)):
            refused.setdefault(owner.span, CannotRepresentError(fault.message, fault.span))
    return refused


def _inside(element: XmlElement) -> Iterator[XmlElement]:
    for child in element.children:
        yield child
        yield from _inside(child)


def _spans(element: XmlElement) -> Iterator[Span]:
    yield element.span
    yield from (attribute.span for attribute in element.attributes.values())
