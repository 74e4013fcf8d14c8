"""`defaults` by themselves: values that no entry took over are judged where they stand."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import model
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.lowering.fields import Fields
from linkforge_compile.lowering.gazebo import lower_gazebo_elements
from linkforge_compile.lowering.joint import read_joint_of_any_type
from linkforge_compile.lowering.link import lower_links
from linkforge_compile.lowering.scope import FileScope
from linkforge_compile.lowering.sensor import lower_sensors
from linkforge_compile.modules.assembly import Instance
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
    """Report what is wrong with the defaults of a file and of its modules, but for places that were told of."""
    told = {place for diagnostic in sink for place in _places(diagnostic)}
    for one in instance.with_modules:
        if one.defaults is not None:
            sink.report_all(fault for fault in _faults(one.defaults, one) if fault.span not in told)


def _places(diagnostic: Diagnostic) -> Iterator[Span]:
    yield from (span for span in (diagnostic.span, *(note.span for note in diagnostic.notes)) if span)


def _faults(defaults: YamlMap, instance: Instance) -> Iterator[Diagnostic]:
    """Yield what is wrong with values, read as the fields of entries that have nothing else."""
    sink = Diagnostics()
    file = Fields(_as_entries(defaults), "defaults", sink, instance.trail)
    readers: tuple[Iterator[object], ...] = (
        lower_links(file, FileScope()),
        file.each("joints", "joint", read_joint_of_any_type),
        lower_sensors(file),
        lower_gazebo_elements(file),
    )
    for entries in readers:
        deque(entries, maxlen=0)
    return (fault for fault in sink if fault.code in _OF_A_VALUE)


def _as_entries(defaults: YamlMap) -> YamlMap:
    """Return the sections of a file that has one entry for each default."""
    shapes = {key: entry for key, entry in defaults.entries.items() if key in {"visual", "collision"}}
    sections = {
        "links": {"link": defaults.get("link"), "shapes": YamlMap(shapes, defaults.span)},
        "joints": {"joint": defaults.get("joint")},
        "sensors": {"sensor": defaults.get("sensor")},
    }
    return _map({name: _map(entries, defaults.span) for name, entries in sections.items()}, defaults.span)


def _map(nodes: Mapping[str, YamlNode | None], span: Span) -> YamlMap:
    keys = {name: YamlScalar(name, name, span) for name in nodes}
    return YamlMap({name: YamlEntry(keys[name], node) for name, node in nodes.items() if node is not None}, span)
