"""Check the values in `defaults`, for those that no entry inherits."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import model
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.expand.uses import Instance
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file import gazebo_elements_of, sensors_of
from linkforge_compile.lower.file_scope import FileScope
from linkforge_compile.lower.joint import check_joint_defaults
from linkforge_compile.lower.link import lower_links
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlNode, YamlScalar

_VALUE_CODES = frozenset(
    {
        model.WRONG_KIND,
        model.WRONG_DIMENSION,
        model.UNKNOWN_UNIT,
        model.NOT_FINITE,
        model.OUT_OF_RANGE,
        model.UNKNOWN_CHOICE,
        model.WRONG_COUNT,
        model.WIDE_ANGLE,
        model.LONG_LENGTH,
        model.UNKNOWN_AXIS,
        model.ZERO_AXIS,
        XACRO_EXPRESSION,
    }
)
"""The faults of single values. What an element lacks or may not have is reported for the entries that inherit."""


def check_defaults(instance: Instance, sink: Diagnostics) -> None:
    """Report faulty values in the defaults of a file and of its modules, unless reported for an entry."""
    reported = {(diagnostic.code, place) for diagnostic in sink for place in _places(diagnostic)}
    for each in instance.with_modules:
        if each.defaults is not None:
            faults = _faults(each.defaults, each)
            sink.report_all(fault for fault in faults if (fault.code, fault.span) not in reported)


def _places(diagnostic: Diagnostic) -> Iterator[Span]:
    yield from (span for span in (diagnostic.span, *(note.span for note in diagnostic.notes)) if span)


def _faults(defaults: YamlMap, instance: Instance) -> Iterator[Diagnostic]:
    """Yield faulty values, read as the fields of entries that have nothing else."""
    entries = _as_entries(defaults)
    if entries is None:
        return
    sink = Diagnostics()
    file = Fields(entries, "defaults", sink, instance.include_stack)
    deque(lower_links(file, FileScope()), maxlen=0)
    deque(file.each("joints", "joint", check_joint_defaults), maxlen=0)
    sensors_of(file)
    gazebo_elements_of(file)
    yield from (fault for fault in sink if fault.code in _VALUE_CODES)


def _as_entries(defaults: YamlMap) -> YamlMap | None:
    """Return the sections of a file with one entry for each default, None for no defaults."""

    def fields_of(**nodes: YamlNode | None) -> YamlMap | None:
        entries = {name: _entry(name, node) for name, node in nodes.items() if node is not None}
        return YamlMap(entries, defaults.span) if entries else None

    shapes = fields_of(visual=defaults.get("visual"), collision=defaults.get("collision"))
    return fields_of(
        links=fields_of(link=defaults.get("link"), shapes=shapes),
        joints=fields_of(joint=defaults.get("joint")),
        sensors=fields_of(sensor=defaults.get("sensor")),
    )


def _entry(name: str, node: YamlNode) -> YamlEntry:
    return YamlEntry(YamlScalar(name, name, node.span), node)
