"""The reader of elements as their specs describe them."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, ClassVar

import pytest

from linkforge_compile.core.fields import Children, Choice, Flag, Number, Parameters, Reference, Spec, Text, Vector
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.joint import JointDynamics
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.elements import read_element
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.lower.elements import lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap
from linkforge_compile.units import LENGTH

ORIGIN = Vector3(0.0, 0.0, 0.0)


class Law(StrEnum):
    LINEAR = "linear"
    SQUARE = "square"


@dataclass(frozen=True, slots=True)
class Friction(JointDynamics):
    """Dynamics with a field of each simple kind."""

    static: Annotated[float, Number(xml="@static_friction")] = 0.5
    is_smooth: Annotated[bool, Flag(key="smooth", xml="@smooth")] = False
    note: Annotated[str | None, Text()] = None
    law: Annotated[Law, Choice(Law)] = Law.LINEAR
    offset: Annotated[Vector3, Vector(LENGTH)] = ORIGIN
    frame: Annotated[str | None, Reference("link", xml="in/@link")] = None


def reader_of(xml: str) -> ElementReader:
    document = read_xml(SourceFile("r.urdf", xml), Diagnostics())
    assert document is not None
    return ElementReader(SpecDraft(), document.root)


def lowered(spec: YamlMap) -> Friction:
    sink = Diagnostics()
    part = lower_element(Friction, Fields(spec, "dynamics", sink))
    assert not list(sink)
    assert part is not None
    return part


def test_every_simple_kind_of_field_is_read():
    xml = """<dynamics damping="2" static_friction="3" smooth="true" note="oiled" law="square" offset="1 2 3">
      <in link="base"/></dynamics>"""
    spec = read_element(reader_of(xml), Friction)
    assert set(spec.entries) == {"damping", "static", "smooth", "note", "law", "offset", "frame"}
    part = lowered(spec)
    expected = Friction(2.0, 0.0, 3.0, True, "oiled", Law.SQUARE, Vector3(1.0, 2.0, 3.0), "base")
    assert part == expected


def test_defaults_are_left_out_and_not_kept_raw():
    """A default that stays an extra attribute would be written twice, LF7001."""
    xml = '<dynamics friction="0" static_friction="0.50" smooth="0" law="linear" offset="0 0.0 -0"/>'
    spec = read_element(reader_of(xml), Friction)
    assert not spec.entries
    assert lowered(spec) == Friction()


@pytest.mark.parametrize("attribute", ['smooth="maybe"', 'offset="1 2"', 'static_friction="much"', 'damping="-1"'])
def test_a_value_of_another_kind_cannot_be_represented(attribute: str):
    with pytest.raises(CannotRepresentError, match=attribute.partition("=")[0]):
        read_element(reader_of(f"<dynamics {attribute}/>"), Friction)


@pytest.mark.parametrize(
    ("annotation", "spec"),
    [
        (Sequence[JointDynamics], Children()),
        (dict[str, str], Parameters()),
        (str, Text(xml="note/text()")),
        (Sequence[str], Text()),
    ],
)
def test_a_kind_of_field_without_a_reader_is_refused(annotation: type, spec: Spec):
    @dataclass(frozen=True, slots=True)
    class Unreadable(Element):
        TAG: ClassVar[str] = "unreadable"

        field: object = None

    Unreadable.__annotations__["field"] = Annotated[annotation, spec]
    with pytest.raises(TypeError, match="needs a reader of its own"):
        read_element(reader_of("<unreadable/>"), Unreadable)
