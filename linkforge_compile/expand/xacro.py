"""Expand xacro files and read the result as specs, with each element at the place where it was written."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import XACRO_ARGUMENT, XACRO_FORBIDDEN, XACRO_WARNS
from linkforge_compile.expand.annotating_sink import with_use_trace
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expand.xacro_faults import XacroReporter
from linkforge_compile.expand.xacro_use import WrittenElements, XacroAnswers, XacroUse
from linkforge_compile.expressions import FAULT
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlNode, YamlScalar
from linkforge_compile.units import Quantity, number_text, parse_quantity

if TYPE_CHECKING:
    from linkforge_compile.importers.document import Imported, Move

FORBIDDEN = "LINKFORGE_NO_XACRO"
"""The environment variable that, set to anything, forbids expanding xacro files."""


class Expansion(NamedTuple):
    """The expanded text of a xacro file; `moved` gives its elements the places where they were written.

    `files` are the files in which they were written, the first one first, and the text itself. `arguments` are the
    names of the arguments that the file uses.
    """

    text: SourceFile
    moved: Move
    files: tuple[SourceFile, ...]
    arguments: frozenset[str]


class XacroRobot(NamedTuple):
    """The robot read from an expanded xacro file, and the files in which it was written, the first one first."""

    imported: Imported
    file: SourceFile
    others: tuple[SourceFile, ...]


def open_xacro(use: XacroUse, loader: Loader, sink: Diagnostics) -> SpecFile | None:
    """Expand a xacro file and read it as a spec; None after a reported error."""
    robot = read_xacro(use, loader, sink)
    if robot is None:
        return None
    tree, folder = robot.imported.tree, use.path.parent
    included = {file: SpecFile(file, tree, folder, use.package) for file in robot.others}
    return SpecFile(robot.file, tree, folder, use.package, included, use.packages or {})


def read_xacro(use: XacroUse, loader: Loader, sink: Diagnostics, *, keeps_refused: bool = False) -> XacroRobot | None:
    """Expand a xacro file and read the robot; `keeps_refused` as in `read_urdf`. None after a reported error."""
    from linkforge_compile.importers.urdf import read_urdf

    expansion = expand_xacro(use, loader, sink)
    if expansion is None:
        return None
    inside = with_use_trace(sink, (use.used.where,))
    imported = read_urdf(expansion.text, inside, expansion.moved, keeps_refused=keeps_refused)
    main, *others = expansion.files
    return XacroRobot(imported, main, tuple(others)) if imported else None


def expand_xacro(use: XacroUse, loader: Loader, sink: Diagnostics) -> Expansion | None:
    """Expand a xacro file with any content; None after a reported error."""
    from linkforge_compile.importers.xacro import Failed, moved_back, run_xacro

    main = loader.open_xml(use.path, sink, use.used)
    arguments = _argument_texts(use, sink)
    if main is None or arguments is None:
        return None
    if os.environ.get(FORBIDDEN) or not loader.runs_xacro:
        sink.report(XACRO_FORBIDDEN.at(use.used.where, path=use.used.text, variable=FORBIDDEN))
        return None
    answers = XacroAnswers(use, loader)
    result = run_xacro(use.path, arguments, answers)
    written = WrittenElements(result, main, loader)
    inside = with_use_trace(sink, (use.used.where,))
    reporter = XacroReporter(use, written, loader, sink, inside)
    if isinstance(result, Failed):
        reporter.report_failure(result, answers)
        return None
    reporter.report_unknown_arguments(result.arguments, result.wanted)
    for warning in result.warnings:
        inside.report(XACRO_WARNS.at(main.whole, text=warning))
    expanded = SourceFile(f"{main.name} (expanded)", result.text, order=main.order)
    files = (main, *written.files, expanded)
    moved = partial(moved_back, find=written.element)
    return Expansion(expanded, moved, files, frozenset((*result.arguments, *result.wanted)))


def _argument_texts(use: XacroUse, sink: Diagnostics) -> dict[str, str] | None:
    """Return the arguments as text, the only type that xacro has; None after a reported error."""
    texts: dict[str, str] = {}
    is_complete = not use.arguments.is_partial
    for name, entry in use.arguments.entries.items():
        text = _argument_text(entry.value, use)
        if text is FAULT:
            is_complete = False
        elif isinstance(text, str):
            texts[name] = text
        else:
            sink.report(XACRO_ARGUMENT.at(entry.value.span, name=name))
            is_complete = False
    return texts if is_complete else None


def _argument_text(node: YamlNode, use: XacroUse) -> object:
    """Return an argument as text; FAULT after a reported error, None for a list, a map or nothing."""
    if use.arguments.as_text and isinstance(node, YamlScalar):
        quantity = parse_quantity(node.text)
        return number_text(quantity.value) if quantity else node.text
    value = use.evaluator.value(node) if use.evaluator else plain_value(node)
    match value:
        case bool():
            return "true" if value else "false"
        case Quantity():
            return number_text(value.value)
        case int() | float():
            return number_text(value)
        case str():
            return value
    return FAULT if value is FAULT else None
