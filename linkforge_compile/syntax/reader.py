"""Reads a spec's text into the positioned tree."""

from __future__ import annotations

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.limits import Budget
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.syntax.entries import STUCK, kind_of
from linkforge_compile.syntax.event_reader import read_events
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.nodes import Tags, YamlFault, YamlMap, YamlNode, YamlScalar


def read(file: SourceFile, sink: Diagnostics, budget: Budget | None = None) -> YamlMap | None:
    """Read the one YAML document of a file; None where its text or its top level is at fault, which is reported.

    A node at fault becomes a YamlFault, as does what a repeated key says, and reading goes on; only malformed YAML ends
    it.
    What it holds is counted in the budget, each alias as a copy of its own; without one it is a compile by itself.
    """
    root = _root(file, sink, budget or Budget(), None)
    if root is None or isinstance(root, YamlMap):
        return root
    _report_top_level(root, sink)
    return None


def read_data(file: SourceFile, sink: Diagnostics, tags: Tags, budget: Budget | None = None) -> YamlNode | None:
    """Read a file of data, which may be of any shape and hold `tags`, but no others; None as for `read`."""
    root = _root(file, sink, budget or Budget(), tags)
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DATA.at(file.whole))
        return None
    return root


def _root(file: SourceFile, sink: Diagnostics, budget: Budget, tags: Tags | None) -> YamlNode | None:
    """Return the top of the one document, None where the text cannot be read; `tags` is None for a spec."""
    if forbidden := FORBIDDEN_CHARACTER.search(file.counted):
        span = file.between(*forbidden.span())
        sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
        return None
    return read_events(Marks(file), sink, budget, tags)


def _report_top_level(root: YamlNode, sink: Diagnostics) -> None:
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DOCUMENT.at(root.span.file.whole))
    elif isinstance(root, YamlScalar) and STUCK.fullmatch(root.text):
        sink.report(codes.SPACE_AFTER_COLON.at(root.span, text=root.text))
    elif not isinstance(root, YamlFault):
        sink.report(codes.TOP_LEVEL_NOT_MAP.at(root.span, found=kind_of(root)))
