"""The reader of elements as their specs describe them."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, ClassVar

import pytest

from linkforge_compile.core.fields import Choice, Flag, Number, Reference, Text, Vector, _describe
from linkforge_compile.core.models.geometry import Box, Material, Vector3
from linkforge_compile.core.models.joint import Joint, JointDynamics
from linkforge_compile.core.models.link import Inertial, InertiaTensor, Visual
from linkforge_compile.core.models.ros2_control import Ros2Control, Ros2ControlJoint, Ros2ControlSensor
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation
from linkforge_compile.core.models.transmission import Transmission, TransmissionJoint
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.elements import export_children
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.elements import read_element
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft
from linkforge_compile.importers.srdf import read_srdf
from linkforge_compile.importers.urdf import read_urdf
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.lower.elements import lower_children, lower_element
from linkforge_compile.lower.fields import Fields
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap, YamlNode, read
from linkforge_compile.syntax.writer import write
from linkforge_compile.units import LENGTH

NewAttribute = Callable[[type[Element]], AbstractContextManager[None]]

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


def test_texts_and_children_are_read():
    """In a transmission, a number of another spelling stays as it is written."""
    xml = """<transmission name="t"><type>my/Gear</type>
      <joint name="j"><hardwareInterface>effort</hardwareInterface><mechanicalReduction>50</mechanicalReduction></joint>
      <actuator name="m"><mechanicalReduction>1.50</mechanicalReduction></actuator><ratio>2</ratio></transmission>"""
    spec = read_element(reader_of(xml), Transmission)
    joints, actuators = spec.get("joints"), spec.get("actuators")
    assert {entry.name for entry in spec} >= {"type", "parameters"}
    assert joints.child("j").child("hardware_interfaces").items[0].text == "effort"
    assert joints.child("j").child("mechanical_reduction").text == "50"
    assert actuators.child("m").child("extra").text == "<mechanicalReduction>1.50</mechanicalReduction>"


@pytest.fixture
def new_attribute(monkeypatch: pytest.MonkeyPatch) -> NewAttribute:
    """Return a context in which a class has one more line, for an attribute `grade`."""

    @contextmanager
    def with_grade(kind: type[Element]) -> Iterator[None]:
        monkeypatch.setitem(kind.__annotations__, "grade", Annotated[str | None, Text(xml="@grade")])
        _describe.cache_clear()
        try:
            yield
        finally:
            monkeypatch.undo()
            _describe.cache_clear()

    return with_grade


def require_grade(tree: YamlMap, place: str) -> None:
    node: YamlNode | None = tree
    for key in place.split("/"):
        assert node is not None
        node = node.child(key)
    assert isinstance(node, YamlMap)
    assert node.get("grade") is not None
    assert node.get("extra_attributes") is None


@pytest.mark.parametrize(
    ("kind", "place"),
    [
        (Inertial, "links/base/inertial"),
        (InertiaTensor, "links/base/inertial/inertia"),
        (Visual, "links/base/visual"),
        (Box, "links/base/visual/box"),
        (Material, "materials/red"),
        (Joint, "joints/j"),
        (Transmission, "transmissions/t"),
        (TransmissionJoint, "transmissions/t/joints/j"),
        (Ros2Control, "ros2_control/hand"),
        (Ros2ControlJoint, "ros2_control/hand/joints/j"),
        (Ros2ControlSensor, "ros2_control/hand/sensors/s"),
    ],
)
def test_a_new_attribute_is_one_line_in_its_class(kind: type[Element], place: str, new_attribute: NewAttribute):
    """Its key becomes that of the class, where raw XML would keep it in `extra_attributes`."""
    with new_attribute(kind):
        imported = read_urdf(SourceFile("r.urdf", ROBOT), Diagnostics())
    assert imported is not None
    require_grade(imported.tree, place)


@pytest.mark.parametrize(
    ("kind", "place"),
    [
        (VirtualJoint, "virtual_joints/v"),
        (PlanningGroup, "groups/arm"),
        (Chain, "groups/arm/chain"),
        (EndEffector, "end_effectors/hand"),
        (PassiveJoint, "passive_joints/j"),
        (CollisionPair, "disabled_collisions/base/tip"),
        (JointProperty, "joint_properties/j/note"),
        (LinkSphereApproximation, "link_sphere_approximations/tip"),
    ],
)
def test_a_new_attribute_of_an_srdf_is_one_line_in_its_class(
    kind: type[Element], place: str, new_attribute: NewAttribute
):
    urdf = read_urdf(SourceFile("r.urdf", ROBOT), Diagnostics())
    document = read_xml(SourceFile("r.srdf", SRDF), Diagnostics())
    assert urdf is not None
    assert document is not None
    with new_attribute(kind):
        imported = read_srdf(document, urdf, Diagnostics(), {})
    require_grade(imported.tree, f"semantic/{place}")


@dataclass(frozen=True)
class GradedPair(CollisionPair):
    grade: Annotated[str | None, Text()] = None


@dataclass(frozen=True)
class GradedJoint(PassiveJoint):
    grade: Annotated[str | None, Text()] = None


@dataclass(frozen=True)
class GradedGroup(PlanningGroup):
    grade: Annotated[str | None, Text()] = None


@pytest.mark.parametrize(
    ("kind", "section"),
    [
        (GradedPair, "{base: {tip: {reason: Never, grade: a}, end: Never, top: null}}"),
        (GradedJoint, "{j: {grade: a}, k: {}}"),
        (GradedGroup, "{arm: {links: [base], grade: a}, hand: {links: [tip]}}"),
    ],
)
def test_a_new_field_of_an_srdf_is_lowered_and_exported(kind: type[Element], section: str):
    """A derived class stands for one with a new line. Only elements without the field are in their short form."""
    text, sink = f"parts: {section}\n", Diagnostics()
    tree = read(SourceFile("s.yaml", text), sink)
    assert tree is not None
    parts = list(lower_children(kind, Fields(tree, "robot", sink), "parts"))
    assert [vars(part)["grade"] for part in parts] == ["a", None, None][: len(parts)]
    builder = SpecBuilder()
    exported = export_children(builder, parts)
    assert write(builder.map_of({"parts": exported})) == write(tree)


ROBOT = """<robot name="r">
<material name="red" grade="a"><color rgba="1 0 0 1"/></material>
<link name="base">
  <inertial grade="a"><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1" grade="a"/></inertial>
  <visual grade="a"><geometry><box size="1 1 1" grade="a"/></geometry><material name="red"/></visual>
</link>
<link name="tip"><visual><geometry><sphere radius="1"/></geometry></visual></link>
<joint name="j" type="continuous" grade="a"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
<transmission name="t" grade="a"><type>my/Gear</type>
  <joint name="j" grade="a"><hardwareInterface>effort</hardwareInterface></joint><actuator name="m"/></transmission>
<ros2_control name="hand" type="system" grade="a">
  <hardware><plugin>my/Hand</plugin></hardware>
  <joint name="j" grade="a"><state_interface name="position"/></joint>
  <sensor name="s" grade="a"><state_interface name="force"/></sensor>
</ros2_control>
</robot>"""


def test_a_kind_of_field_without_a_reader_is_refused():
    @dataclass(frozen=True, slots=True)
    class Unreadable(Element):
        TAG: ClassVar[str] = "unreadable"

        field: object = None

    Unreadable.__annotations__["field"] = Annotated[Sequence[str], Text()]
    with pytest.raises(TypeError, match="needs a reader of its own"):
        read_element(reader_of("<unreadable/>"), Unreadable)


SRDF = """<robot name="r">
<virtual_joint name="v" type="fixed" parent_frame="world" child_link="base" grade="a"/>
<group name="arm" grade="a"><chain base_link="base" tip_link="tip" grade="a"/></group>
<end_effector name="hand" group="arm" parent_link="base" grade="a"/>
<passive_joint name="j" grade="a"/>
<disable_collisions link1="base" link2="tip" reason="Never" grade="a"/>
<joint_property joint_name="j" property_name="note" value="oiled" grade="a"/>
<link_sphere_approximation link="tip" grade="a"><sphere center="0 0 0" radius="1"/></link_sphere_approximation>
</robot>"""
