"""The model to Python's own tools and libraries for data: type hints, asdict, JSON, YAML, derived classes."""

import copy
import dataclasses
import inspect
import json
import pickle
import typing
import weakref
from collections.abc import Iterator

import pytest
import yaml

import linkforge_compile
from linkforge_compile import core
from linkforge_compile.core import (
    Box,
    Collision,
    Color,
    Cylinder,
    GazeboElement,
    GazeboPlugin,
    IMUInfo,
    Inertial,
    InertiaTensor,
    Interface,
    Joint,
    JointLimits,
    JointMimic,
    JointType,
    Link,
    Material,
    Robot,
    Ros2Control,
    Ros2ControlJoint,
    Sensor,
    SensorNoise,
    SensorType,
    Transform,
    Transmission,
    Vector3,
    Visual,
)
from linkforge_compile.core.part import Inside
from tests.yaml_case import compile_yaml

CONTROL = Ros2Control(
    "arm",
    hardware_plugin="mock_components/GenericSystem",
    joints=[Ros2ControlJoint("elbow", ["position"], [Interface("velocity", {"min": "-1"})], {"gain": "2"})],
    parameters={"port": "/dev/tty0"},
)
ELBOW = Joint(
    "elbow",
    JointType.REVOLUTE,
    "base",
    "arm",
    Transform(Vector3(0.0, 0.0, 0.5)),
    Vector3(0.0, 0.0, 1.0),
    JointLimits(-1.0, 1.0),
    mimic=JointMimic("wrist", stated=["offset"]),
    extra_inside=[Inside("parent", extra_attributes={"x": "1"})],
)
PARTS = [
    CONTROL,
    ELBOW,
    Sensor("imu", SensorType.IMU, "base", imu_info=IMUInfo(SensorNoise(stddev=0.1))),
    Transmission.create_simple("t", "elbow"),
    GazeboElement("base", {"kp": "1"}, [GazeboPlugin("p", "libp.so", {"a": {"_b": "c"}, "d": ["e", "f"]})]),
    Inertial(2.0, inertia=InertiaTensor(1.0, 1.0, 1.0)),
    Material("red", Color(1.0, 0.0, 0.0)),
]
ARM = Link("arm", Inertial(1.0), visuals=[Visual(Cylinder(0.1, 0.5))], collisions=[Collision(Box(Vector3(1, 1, 1)))])
ROBOT = Robot(
    "r", links=[Link("base"), ARM], joints=[dataclasses.replace(ELBOW, mimic=None)], ros2_controls=[CONTROL]
).add_group("g", joints=["elbow"])


def public() -> Iterator[object]:
    """Yield what the two packages export, and the methods and properties of the classes among it."""
    exported = [getattr(package, name) for package in (linkforge_compile, core) for name in package.__all__]
    for item in exported:
        if inspect.isfunction(item):
            yield item
        elif inspect.isclass(item) and item.__module__.startswith("linkforge_compile"):
            yield item
            for name, member in inspect.getmembers_static(item):
                accessor = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
                is_ours = inspect.isfunction(accessor) and accessor.__module__.startswith("linkforge_compile")
                if is_ours and (name == "__init__" or not name.startswith("_")):
                    yield accessor


def test_type_hints_of_all_that_is_public_can_be_read():
    for item in public():
        assert isinstance(typing.get_type_hints(item, include_extras=True), dict), item.__qualname__


def test_type_hints_are_the_classes_themselves():
    assert typing.get_type_hints(Robot.add_sensor)["sensor"] is Sensor
    assert typing.get_type_hints(Joint.__init__)["limits"] == JointLimits | None
    assert typing.get_type_hints(linkforge_compile.render_urdf)["robot"] is Robot


def test_a_class_of_ones_own_in_another_module_has_type_hints():
    @dataclasses.dataclass(frozen=True)
    class Elbow(Joint):
        maker: str = ""

    assert typing.get_type_hints(Elbow.__init__)["limits"] == JointLimits | None


def test_a_vector_is_its_three_numbers():
    vector = Vector3(1.0, 2.0, 3.0)
    assert [field.name for field in dataclasses.fields(Vector3)] == ["x", "y", "z"]
    assert Vector3(*dataclasses.astuple(vector)) == vector


def test_a_compiled_robot_becomes_json_and_yaml():
    robot = compile_yaml("""
        linkforge: 1
        name: r
        links: {base: {visual: {box: [1, 1, 1]}}, arm: {}}
        joints:
          elbow:
            type: revolute
            parent: base
            child: arm
            axis: z
            limits: {lower: 0, upper: 1, effort: 1, velocity: 1}
    """).result()
    converted = dataclasses.asdict(robot)
    assert type(converted["links"][0]) is dict
    assert converted["links"][0]["visuals"][0]["geometry"]["size"] == {"x": 1.0, "y": 1.0, "z": 1.0}
    assert "source" not in converted["links"][0]
    del converted["resource_resolver"]
    assert json.loads(json.dumps(converted))["joints"][0]["type"] == "revolute"
    assert yaml.safe_load(yaml.safe_dump(converted)) == json.loads(json.dumps(converted))


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_a_part_becomes_yaml(part):
    converted = dataclasses.asdict(part)
    assert yaml.safe_load(yaml.safe_dump(converted)) == json.loads(json.dumps(converted))


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_pydantic_reads_what_it_wrote(part):
    pydantic = pytest.importorskip("pydantic")
    adapter = pydantic.TypeAdapter(type(part))
    assert adapter.validate_python(adapter.dump_python(part)) == part
    assert adapter.validate_json(adapter.dump_json(part)) == part
    assert adapter.validate_json(json.dumps(dataclasses.asdict(part))) == part


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_cattrs_reads_what_it_wrote(part):
    converter = pytest.importorskip("cattrs").Converter()
    assert converter.structure(converter.unstructure(part), type(part)) == part
    assert json.dumps(converter.unstructure(list(ROBOT.links)))


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_msgspec_reads_a_converted_part(part):
    msgspec = pytest.importorskip("msgspec")
    assert msgspec.convert(dataclasses.asdict(part), type(part)) == part


def test_libraries_report_what_the_constructor_refuses():
    pydantic = pytest.importorskip("pydantic")
    converted = {**dataclasses.asdict(ELBOW), "child": "base"}
    with pytest.raises(core.RobotValidationError, match="cannot be the same"):
        pydantic.TypeAdapter(Joint).validate_python(converted)


T = typing.TypeVar("T")


class Tagged(Joint, typing.Generic[T]):
    """A joint with a list of its own, which is no field."""

    def __init_subclass__(cls, maker: str = "", **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        cls.maker = maker

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "tags", [])


class Made(Tagged[int], maker="us"):
    pass


def test_a_class_of_ones_own_may_be_generic_and_have_keywords():
    assert Made.maker == "us"
    assert Made("j", "fixed", "a", "b").name == "j"


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda part: pickle.loads(pickle.dumps(part))])
def test_a_deep_copy_has_a_state_of_its_own(copied):
    joint = Made("j", "fixed", "a", "b")
    other = copied(joint)
    other.tags.append("spare")
    assert (other, joint.tags) == (joint, [])


@pytest.mark.parametrize("part", [*PARTS, ROBOT, ARM, Vector3(0, 0, 0)], ids=lambda part: type(part).__name__)
def test_every_part_can_be_watched(part):
    assert weakref.ref(part)() is part


def test_links_of_a_robot_are_a_tuple():
    assert isinstance(ROBOT.links, tuple)
    assert isinstance(ROBOT.semantic.groups, tuple)
