"""`defaults` by themselves: values that no entry took over are judged where they stand."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import model
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.file import gazebo_elements_of, sensors_of
from linkforge_compile.lower.joint import read_joint_of_any_type
from linkforge_compile.lower.link import lower_links
from linkforge_compile.lower.scope import FileScope
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlNode, YamlScalar

_OF_A_VALUE = frozenset(
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
"""What is wrong with a value whatever stands beside it; what an entry lacks or may not have is the entry's."""


def judge_defaults(instance: Instance, sink: Diagnostics) -> None:
    """Report what is wrong with the defaults of a file and of its modules, but for what was told of the same place."""
    told = {(diagnostic.code, place) for diagnostic in sink for place in _places(diagnostic)}
    for one in instance.with_modules:
        if one.defaults is not None:
            sink.report_all(fault for fault in _faults(one.defaults, one) if (fault.code, fault.span) not in told)


def _places(diagnostic: Diagnostic) -> Iterator[Span]:
    yield from (span for span in (diagnostic.span, *(note.span for note in diagnostic.notes)) if span)


def _faults(defaults: YamlMap, instance: Instance) -> Iterator[Diagnostic]:
    """Yield what is wrong with values, read as the fields of entries that have nothing else."""
    entries = _as_entries(defaults)
    if entries is None:
        return
    sink = Diagnostics()
    file = Fields(entries, "defaults", sink, instance.include_stack)
    deque(lower_links(file, FileScope()), maxlen=0)
    deque(file.each("joints", "joint", read_joint_of_any_type), maxlen=0)
    sensors_of(file)
    gazebo_elements_of(file)
    yield from (fault for fault in sink if fault.code in _OF_A_VALUE)


def _as_entries(defaults: YamlMap) -> YamlMap | None:
    """Return the sections of a file that has one entry for each default, None for none."""

    def said(**nodes: YamlNode | None) -> YamlMap | None:
        entries = {name: _entry(name, node) for name, node in nodes.items() if node is not None}
        return YamlMap(entries, defaults.span) if entries else None

    shapes = said(visual=defaults.get("visual"), collision=defaults.get("collision"))
    return said(
        links=said(link=defaults.get("link"), shapes=shapes),
        joints=said(joint=defaults.get("joint")),
        sensors=said(sensor=defaults.get("sensor")),
    )


def _entry(name: str, node: YamlNode) -> YamlEntry:
    return YamlEntry(YamlScalar(name, name, node.span), node)
