"""Each kind of difference and its text."""

# ruff: noqa: E501 a robot and a change take a line each

import re
import time

import pytest

from linkforge_compile import compile_text
from linkforge_compile.compare import Kind, compare, removed_public_names, with_folders
from linkforge_compile.core import (
    Joint,
    JointType,
    Link,
    Robot,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
    Sphere,
    Transform,
    Vector3,
    Visual,
)
from linkforge_compile.export_spec import write_spec
from tests.formats.everything import everything

SPEC = """\
linkforge: 1
name: arm
materials:
  red: {color: [1, 0, 0, 1]}
links:
  base: {visual: {box: [1, 1, 0.1], material: red}, inertial: {mass: 2}}
  torso: {visual: {box: [1, 1, 0.2], material: red}}
  upper: {visual: {mesh: {file: "package://arm/upper.stl"}}, inertial: {mass: 1, inertia: {ixx: 0.1, iyy: 0.1, izz: 0.15}}}
  cart: {visual: {sphere: {radius: 0.1}}}
joints:
  lift: {type: fixed, parent: base, child: torso}
  elbow: {type: revolute, parent: base, child: upper, axis: z, limits: {lower: -90 deg, upper: 90 deg, effort: 10, velocity: 1}}
  rail: {type: prismatic, parent: upper, child: cart, axis: x, limits: {lower: 0, upper: 0.5, effort: 10, velocity: 1}}
sensors:
  imu: {type: imu, link: upper, imu: {}, topic: imu/data}
transmissions:
  drive: {type: transmission_interface/SimpleTransmission, joints: {elbow: {mechanical_reduction: 50}}, actuators: {motor: {}}}
ros2_control:
  hw: {type: system, hardware_plugin: mock, joints: {elbow: {command_interfaces: [position, velocity], state_interfaces: [position]}}}
gazebo:
  - reference: base
    properties: {maxContacts: 10}
semantic:
  groups: {arm: {joints: [elbow, rail]}}
  group_states: {arm: {home: {elbow: 0, rail: 0}}}
  disabled_collisions: {base: {upper: Adjacent}}
"""


def robot_of(spec: str) -> Robot:
    return compile_text(spec).result()


def differences_of(old: str, new: str) -> list[str]:
    assert old in SPEC
    differences = compare(robot_of(SPEC), robot_of(SPEC.replace(old, new)))
    return [f"{one.kind} {'/'.join(one.path)}: {one.text}" for one in differences]


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("upper: 90 deg", "upper: 2.0943951023931953", "changed joints/elbow/limits/upper: 90 deg → 120 deg (+30 deg)"),
        ("upper: 0.5", "upper: 0.6", "changed joints/rail/limits/upper: 0.5 m → 0.6 m (+100 mm)"),
        ("effort: 10, velocity: 1}}\nsen", "effort: 5, velocity: 1}}\nsen", "changed joints/rail/limits/effort: 10 N → 5 N (-50 %)"),
        ("axis: z", "axis: y", "changed joints/elbow/axis: 0 0 1 → 0 1 0"),
        ("type: fixed, parent", "type: floating, parent", "changed joints/lift/type: fixed → floating"),
        ("child: torso", "child: torso, origin: {xyz: [3 mm, 4 mm, 0], rpy: [0, 0, 30 deg]}",
         "changed joints/lift/origin: moved by 5 mm (x +3 mm, y +4 mm), turned by 30 deg"),
        ("parent: base, child: upper", "parent: torso, child: upper", "moved joints/elbow/parent: base → torso"),
        ("ixx: 0.1,", "ixx: 0.15,",
         "changed links/upper/inertial/inertia: ixx 0.1 → 0.15 (+50 %) kg*m^2"),
        ("mass: 1, inertia", "mass: 1.1, inertia", "changed links/upper/inertial/mass: 1 kg → 1.1 kg (+10 %)"),
        ("upper.stl", "new.stl",
         "changed links/upper/visual/0/mesh/file: package://arm/upper.stl → package://arm/new.stl"),
        ("sphere: {radius: 0.1}", "box: [1, 1, 1]", "changed links/cart/visual/0/geometry: sphere, radius 0.1 m → box, size 1 1 1 m"),
        ("color: [1, 0, 0, 1]", "color: [0, 0, 1, 1]", "changed materials/red/color: 1 0 0 1 → 0 0 1 1"),
        ("topic: imu/data", "topic: imu/raw", "changed sensors/imu/topic: imu/data → imu/raw"),
        ("reduction: 50", "reduction: 100", "changed transmissions/drive/joints/elbow/mechanical_reduction: 50 → 100 (+100 %)"),
        ("[position, velocity]", "[position]", "removed ros2_control/hw/joints/elbow/command_interfaces/velocity: velocity"),
        ("hw: {type: system, hardware", "hw: {type: actuator, hardware", "changed ros2_control/hw/type: system → actuator"),
        ("maxContacts: 10", "maxContacts: 20", "changed gazebo/base/properties/maxContacts: 10 → 20 (+100 %)"),
        ("joints: [elbow, rail]", "joints: [elbow]", "removed semantic/groups/arm/joints: rail"),
        ("home: {elbow: 0, rail: 0}", "home: {elbow: 90 deg, rail: 0}",
         "changed semantic/group_states/arm/home/elbow: 0 deg → 90 deg (+90 deg)"),
        ("upper: Adjacent", "cart: Adjacent", "added semantic/disabled_collisions/base/cart: reason Adjacent"),
    ],
)  # fmt: skip
def test_a_change_is_shown_with_units_and_its_amount(old: str, new: str, text: str):
    assert text in differences_of(old, new)


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("stddev: 1", "stddev: 1, bias_mean: 0", "added sensors/imu/imu/angular_velocity_noise/bias_mean: 0"),
        ("name: arm", "name: arm\nversion: 1.1", "added version: 1.1"),
        ("name: arm", "name: arm\nversion: 2.0", "changed version: 1.1 → 2.0"),
        ("inertial: {mass: 2}", "inertial: {mass: 2}, physics: {mu: 1}", "added links/base/physics/mu: 1"),
        ("reduction: 50", "reduction: 50, offset: 0", "added transmissions/drive/joints/elbow/offset: 0 deg"),
    ],
)  # fmt: skip
def test_a_stated_default_is_shown_as_its_field(old: str, new: str, text: str):
    was = SPEC.replace("imu: {}", "imu: {angular_velocity_noise: {stddev: 1}}")
    now = was.replace(old, new)
    there, back = (compare(*map(robot_of, pair)) for pair in ((was, now), (now, was)))
    assert [f"{one.kind} {'/'.join(one.path)}: {one.text}" for one in there] == [text]
    assert [one.path for one in back] == [one.path for one in there]


RAW = """\
extra: |
  <self_filter ignore="a" scale="1.20"><link name="base"/> <link name="upper">0.50 1e-3</link></self_filter>
extra_attributes: {stamp: "007", gain: "0.20"}
"""


@pytest.mark.parametrize(
    ("old", "new", "texts"),
    [
        ('ignore="a" scale="1.20"', 'scale="1.2" ignore="a"', []),
        ('stamp: "007", gain: "0.20"', 'gain: "0.2", stamp: "007"', []),
        ("0.50 1e-3", "0.5  0.001", []),
        ("/> <link", "/><!-- wide --><link", []),
        ("maxContacts: 10", "maxContacts: 10.0", []),
        ('stamp: "007"', 'stamp: "7"', ["changed extra_attributes/stamp: 007 → 7"]),
        ("1.20", "1.5", ["changed extra/self_filter/scale: 1.2 → 1.5 (+25 %)"]),
        ("0.50 1e-3", "0.50 2e-3", ["changed extra/self_filter/link/upper: 0.50 1e-3 → 0.50 2e-3"]),
        ('name="base"', 'name="cart"', [
            'added extra/self_filter/link/cart: <link name="cart"/>',
            'removed extra/self_filter/link/base: <link name="base"/>',
        ]),
        ('<link name="base"/> <link name="upper">0.50 1e-3</link>', '<link name="upper">0.50 1e-3</link><link name="base"/>', []),
        ('scale="1.20"', 'scale="1.2000000001"', []),
        ('<link name="base"/> ', "", ['removed extra/self_filter/link/base: <link name="base"/>']),
        ("</self_filter>", "</self_filter><new/>", ["added extra/new: <new/>"]),
    ],
)  # fmt: skip
def test_raw_xml_is_compared_by_content_and_reported_where_it_differs(old: str, new: str, texts: list[str]):
    spec = SPEC + RAW
    assert old in spec
    there = compare(robot_of(spec), robot_of(spec.replace(old, new)))
    assert [f"{one.kind} {'/'.join(one.path)}: {one.text}" for one in there] == texts


def test_tags_of_one_kind_in_raw_xml_have_an_order():
    path = "extra: <path><via>1 2</via><via>3 4</via><speed/></path>"
    other = "extra: <path><speed/><via>3 4</via><via>1 2</via></path>"
    texts = [f"{'/'.join(one.path)}: {one.text}" for one in compare(robot_of(SPEC + path), robot_of(SPEC + other))]
    assert texts == ["extra/path/via/0: 1 2 → 3 4", "extra/path/via/1: 3 4 → 1 2"]


@pytest.mark.parametrize(
    ("before", "after", "texts"),
    [
        ('<foo><a name="x" v="1"/><a name="y" v="2"/></foo>', '<foo><a name="y" v="2"/><a name="x" v="3"/></foo>',
         ["extra/foo/a/x/v: 1 → 3 (+200 %)"]),
        ('<foo><a name="x" v="1"/></foo>', '<foo><a name="y" v="1"/></foo>', ["extra/foo/a/name: x → y"]),
        ("<foo>a<b/>c</foo>", "<foo>ac<b/></foo>", ["extra/foo: a c → ac"]),
        ("<foo>a<b/>c</foo>", "<foo>a<b/>d</foo>", ["extra/foo: c → d"]),
        ("<foo>a<!-- b -->c</foo>", "<foo>ac</foo>", []),
        ("<foo>a</foo>", "<foo>a<b/></foo>", ["extra/foo/b: <b/>"]),
        ("<foo>1e999</foo>", "<foo>2e999</foo>", ["extra/foo: 1e999 → 2e999"]),
        ("<foo>9007199254740993.0</foo>", "<foo>9007199254740992.0</foo>", ["extra/foo: 9007199254740993.0 → 9007199254740992.0"]),
        ("<foo>9007199254740993</foo>", "<foo>9007199254740993.0</foo>", []),
        ("<foo>1000001</foo>", "<foo>1000000</foo>", ["extra/foo: 1000001 → 1000000 (-0.0001 %)"]),
        ("<foo><plugin>1.10</plugin></foo>", "<foo><plugin>1.1</plugin></foo>", ["extra/foo/plugin: 1.10 → 1.1"]),
        ("<foo><plugin>2.5e-08</plugin></foo>", "<foo><plugin>2.5e-8</plugin></foo>", []),
        ("<foo><plugin>1e05</plugin></foo>", "<foo><plugin>1e5</plugin></foo>", ["extra/foo/plugin: 1e05 → 1e5"]),
    ],
)  # fmt: skip
def test_elements_texts_and_numbers_of_raw_xml_are_distinguished(before: str, after: str, texts: list[str]):
    was, now = (robot_of(f"{SPEC}extra: ['{raw}']") for raw in (before, after))
    assert [f"{'/'.join(one.path)}: {one.text}" for one in compare(was, now)] == texts


def test_the_tolerance_is_that_of_numbers_in_raw_xml_too_but_for_whole_ones():
    was, now = (
        robot_of(f'{SPEC}extra: [\'<foo rate="{rate}" id="{id_}"/>\']')
        for rate, id_ in (("100", "100"), ("100.4", "101"))
    )
    assert [one.path[-1] for one in compare(was, now)] == ["rate", "id"]
    assert [one.path[-1] for one in compare(was, now, tolerance=0.1)] == ["id"]


def test_what_hardware_reads_is_a_text_and_no_number():
    was, now = (
        Ros2Control(
            "hw",
            "system",
            "mock",
            joints=[Ros2ControlJoint("elbow", state_interfaces=["position"], parameters=read)],
            gpios=[Ros2ControlGpio("io", state_interfaces=["a"], parameters=read)],
            sensors=[Ros2ControlSensor("ft", state_interfaces=["b"], parameters=read)],
            parameters=read,
        )
        for read in ({"firmware": "1.10"}, {"firmware": "1.1"})
    )
    there = compare(*(Robot("r", ros2_controls=[hardware]) for hardware in (was, now)))
    assert [one.text for one in there] == ["1.10 → 1.1"] * 4


@pytest.mark.parametrize(
    "plugin",
    [
        "properties: {maxContacts: 10}\n    plugins: {p: {filename: p.so, parameters: {device: '%s'}}}",
        "properties: {sensor: {_name: s, _type: imu, plugin: {_name: p, _filename: p.so, device: '%s'}}}",
    ],
    ids=["its own", "of a sensor"],
)
def test_what_a_plugin_of_gazebo_reads_is_a_text_and_no_number(plugin: str):
    was, now = (robot_of(SPEC.replace("properties: {maxContacts: 10}", plugin % device)) for device in ("1e2", "100"))
    assert [one.text for one in compare(was, now)] == ["1e2 → 100"]


def test_many_tags_of_raw_xml_are_compared_in_time_that_grows_with_them():
    was, now = (
        Robot("r", extra_elements=["<foo>" + "".join(f'<t{tag} v="{v}"/>' for tag in range(4000)) + "</foo>"])
        for v in "ab"
    )
    started = time.process_time()
    assert len(compare(was, now)) == 4000
    assert time.process_time() - started < 2


def test_two_values_are_shown_until_they_differ():
    note = "a note that is longer than what a line can bear, and says what matters at its very end, which is "
    before, after = (
        robot_of(
            SPEC.replace("name: arm", f"name: arm\nmetadata: {{note: '{note}{end}', flag: {flag}}}").replace(
                "0.2]", size
            )
        )
        for end, flag, size in (("one", "true", "0.20000001]"), ("two", "'yes'", "0.20000002]"))
    )
    assert [one.text for one in compare(before, after, tolerance=1e-9)] == [
        "… very end, which is one → … very end, which is two",
        'true → "yes"',
        "1 1 0.20000001 m → 1 1 0.20000002 m",
    ]


def test_a_new_shape_is_shown_with_its_size_and_pose():
    assert differences_of(
        "cart: {visual: {sphere: {radius: 0.1}}}",
        "cart: {visual: [{sphere: {radius: 0.1}}, {box: [1, 1, 2], origin: [0, 0, 5 mm]}]}",
    ) == ["added links/cart/visual/1: box, size 1 1 2 m, at 0 0 0.005 m"]


def test_of_a_long_path_both_ends_are_shown():
    path = f"package://{'_'.join(['long'] * 20)}/meshes/visual/upper.stl"
    [text] = differences_of("package://arm/upper.stl", path)
    assert text.endswith("→ package://long_long_long_long_long…g_long_long/meshes/visual/upper.stl")


def test_a_new_state_is_shown_with_its_positions_and_units():
    text = "added semantic/group_states/arm/out: elbow 90 deg, rail 0.5 m"
    assert differences_of(
        "home: {elbow: 0, rail: 0}", "home: {elbow: 0, rail: 0}, out: {elbow: 90 deg, rail: 0.5}"
    ) == [text]


def test_a_change_from_revolute_to_prismatic_shows_both_units():
    spec = (
        SPEC.replace("type: prismatic", "type: revolute")
        .replace("rail: 0}", "rail: 0.5}")
        .replace("upper: 0.5", "upper: 0.25")
    )
    before, after = robot_of(spec), robot_of(SPEC.replace("rail: 0}", "rail: 0.25}"))
    texts = {"/".join(one.path): one.text for one in compare(before, after)}
    assert texts == {
        "joints/rail/type": "revolute → prismatic",
        "joints/rail/limits/upper": "14.3239 deg → 0.5 m",
        "semantic/group_states/arm/home/rail": "28.6479 deg → 0.25 m",
    }


def test_data_of_the_author_are_compared_one_by_one():
    before, after = (
        robot_of(SPEC.replace("name: arm", f"name: arm\nmetadata: {{{metadata}}}"))
        for metadata in (
            "mass: 1.5, tested: [1, 2, {by: me}], order: [1, 2], gone: null, kept: null",
            "mass: 1.5000000001, tested: [1, 3, {by: you}], order: [2, 1, 0], new: null, kept: null",
        )
    )
    assert [(str(one.kind), "/".join(one.path), one.text) for one in compare(before, after)] == [
        ("changed", "metadata/tested/1", "2 → 3 (+50 %)"),
        ("changed", "metadata/tested/2/by", "me → you"),
        ("changed", "metadata/order", "1 2 → 2 1 0"),
        ("added", "metadata/new", "none"),
        ("removed", "metadata/gone", "none"),
    ]


def test_many_links_of_one_parent_are_sorted_out_in_time_that_grows_with_them():
    before, after = (
        Robot(
            "star",
            links=[Link("hub"), *(Link(f"{tip}{number}") for number in range(400))],
            joints=[
                Joint(f"{tip}j{number}", JointType.FIXED, "hub", f"{tip}{number}", Transform(Vector3(number // 2, 0, 0)))
                for number in range(400)
            ],
        )
        for tip in "ab"
    )  # fmt: skip
    started = time.process_time()
    assert {one.kind for one in compare(before, after)} == {Kind.ADDED, Kind.REMOVED}
    assert time.process_time() - started < 5


def test_many_shapes_of_one_link_find_their_own_in_time_that_grows_with_them():
    shapes = [Visual(Sphere(1 + number)) for number in range(2000)]
    before, after = (Robot("r", links=[Link("hub", visuals=visuals)]) for visuals in (shapes, shapes[::-1]))
    started = time.process_time()
    assert compare(before, after) == ()
    assert time.process_time() - started < 5


def test_a_change_is_reported_once():
    assert len(differences_of("color: [1, 0, 0, 1]", "color: [0, 0, 1, 1]")) == 1
    assert len(differences_of("parent: base, child: upper", "parent: torso, child: upper")) == 1


def test_additions_and_removals_are_shown_in_few_words():
    spec = re.sub(r"  torso:.*\n", "  tool0:\n", SPEC).replace("child: torso", "child: tool0, origin: [0, 0, 1]")
    assert [
        (one.kind, one.path, one.text) for one in compare(robot_of(SPEC), robot_of(spec)) if one.path[0] == "links"
    ] == [
        (Kind.ADDED, ("links", "tool0"), "a frame"),
        (Kind.REMOVED, ("links", "torso"), "1 visual"),
    ]


RED, GREEN = "{sphere: 1, material: red}", "{sphere: 2, material: green}"
TO_GREEN = "color 1 0 0 1 → 0 1 0 1 in MuJoCo, that of the visual before it"
TO_RED = "color 0 1 0 1 → 1 0 0 1 in MuJoCo, that of the visual before it"
TO_NONE = "color 1 0 0 1 → none in MuJoCo, that of the visual before it"


@pytest.mark.parametrize(
    ("before", "after", "recolored"),
    [
        (f"visual: {RED}, collision: {{sphere: 3}}", f"collision: {{sphere: 3}}, visual: {RED}",
         {"collision/0": TO_NONE}),
        (f"visual: [{RED}, {GREEN}], collision: [{{sphere: 3}}, {{sphere: 4}}], shape_order: pairs",
         f"visual: [{RED}, {GREEN}], collision: [{{sphere: 4}}, {{sphere: 3}}], shape_order: pairs",
         {"collision/0": TO_RED, "collision/1": TO_GREEN}),
        (f"visual: [{RED}, {{sphere: 3}}]", f"visual: [{{sphere: 3}}, {RED}]", {"visual/0": TO_NONE}),
        (f"visual: {RED}, collision: {{sphere: 3}}", f"visual: [{RED}, {GREEN}], collision: {{sphere: 3}}", {"collision/0": TO_GREEN}),
        (f"visual: [{RED}, {GREEN}], collision: {{sphere: 3}}", f"visual: {RED}, collision: {{sphere: 3}}",
         {"collision/0": TO_RED}),
        # What a visual says of itself is told there, once.
        (f"visual: {RED}, collision: {{sphere: 3}}", "visual: {sphere: 1, material: green}, collision: {sphere: 3}",
         {}),
        ("visual: {sphere: 1}, collision: visual", "collision: visual, visual: {sphere: 1}", {}),
        (f"visual: [{RED}, {{sphere: 2}}], collision: {{sphere: 3}}",
         f"visual: [{RED}, {{sphere: 2}}], collision: {{sphere: 3}}, shape_order: [visual, collision, visual]", {}),
    ],
)  # fmt: skip
def test_a_shape_colored_by_another_visual_in_mujoco_is_reported(before: str, after: str, recolored: dict[str, str]):
    head = "linkforge: 1\nname: r\nmaterials: {red: {color: [1, 0, 0]}, green: {color: [0, 1, 0]}}\nlinks: {a: "
    one, other = (robot_of(f"{head}{{{link}}}}}") for link in (before, after))
    found = {"/".join(each.path[2:]): each.text for each in compare(one, other)}
    assert {path: text for path, text in found.items() if "MuJoCo" in text} == recolored


def test_a_material_written_after_the_links_is_reported():
    after = SPEC.replace("red: {color: [1, 0, 0, 1]}", "red: {color: [1, 0, 0, 1], after_links: true}")
    (difference,) = compare(robot_of(SPEC), robot_of(after))
    assert (difference.path, difference.text) == (
        ("materials", "red", "after_links"),
        "before the links → after the links",
    )


def test_float_noise_below_the_tolerance_is_not_reported():
    before, after = (
        robot_of(SPEC),
        robot_of(SPEC.replace("upper: 0.5", "upper: 0.5000001").replace("mass: 2", "mass: 2.000001")),
    )
    assert compare(before, after) == ()
    assert len(compare(before, after, tolerance=0)) > 1


def test_renamed_links_and_joints_are_reported_without_references_to_them():
    before = everything()
    text = re.sub(r"\b(finger|shoulder|axle)\b", r"\1_b", write_spec(before))
    after = robot_of(text)
    assert {(one.kind, one.path, one.before, one.after) for one in compare(before, after)} == {
        (Kind.RENAMED, ("links", "finger_b"), "finger", "finger_b"),
        (Kind.RENAMED, ("joints", "shoulder_b"), "shoulder", "shoulder_b"),
        (Kind.RENAMED, ("joints", "axle_b"), "axle", "axle_b"),
    }
    assert [tuple(name) for name in removed_public_names(before, after)] == [
        ("link", "finger", "finger_b"),
        ("joint", "axle", "axle_b"),
        ("joint", "shoulder", "shoulder_b"),
        ("command interface", "shoulder/position", "shoulder_b/position"),
        ("state interface", "shoulder/position", "shoulder_b/position"),
        ("state interface", "shoulder/velocity", "shoulder_b/velocity"),
    ]


def test_a_renamed_state_is_recognized_unless_another_is_similar():
    old, new = "arm: {home: {elbow: 0, rail: 0}}", "arm: {rest: {elbow: 0, rail: 0}}"
    assert differences_of(old, new) == ["renamed semantic/group_states/arm/rest: was 'home'"]
    before, after = (
        robot_of(SPEC.replace("elbow", name).replace(old.replace("elbow", name), state))
        for name, state in (("elbow", old), ("hinge", new.replace("elbow", "hinge")))
    )
    assert [(one.kind, one.path[-1]) for one in compare(before, after)] == [
        (Kind.RENAMED, "hinge"),
        (Kind.RENAMED, "arm/rest"),
    ]
    assert ("group state", "arm/home", "arm/rest") in removed_public_names(before, after)
    twins = "arm: {rest: {elbow: 0, rail: 0}, zero: {elbow: 0, rail: 0}}"
    assert [text.split()[0] for text in differences_of(old, twins)] == ["added", "added", "removed"]


def test_two_alike_are_no_rename():
    twins = "linkforge: 1\nname: r\nlinks: {base: , a: , b: }\njoints:\n  ja: {type: fixed, parent: base, child: a}\n  jb: {type: fixed, parent: base, child: b}\n"
    others = re.sub(r"\b(j?)([ab])\b", r"\1\2\2", twins)
    kinds = {one.kind for one in compare(robot_of(twins), robot_of(others))}
    assert kinds == {Kind.ADDED, Kind.REMOVED}


def test_the_semantic_part_can_be_left_out():
    before, after = robot_of(SPEC), robot_of(SPEC[: SPEC.index("semantic:")])
    assert compare(before, after, semantic=False) == removed_public_names(before, after, semantic=False) == ()
    assert [name.name for name in removed_public_names(before, after)] == ["arm", "arm/home"]


def test_paths_in_other_folders_are_the_same_in_texts_meshes_and_raw_xml():
    spec = """\
linkforge: 1
name: arm
links: {base: {visual: {mesh: "file:///old/arm/a.stl"}}}
extra: ['<config file="/old/arm/c.yaml"/>']
ros2_control:
  hw:
    {type: system, hardware_plugin: p, parameters: {file: /old/arm/c.yaml, other: /old/arm2/c.yaml /x/old/arm/c},
     gpios: {io: {command_interfaces: {out: {map: /old/arm/m.yaml}}}}}
"""
    before = with_folders(robot_of(spec), {"/old/arm": "/new/arm"})
    after = robot_of(spec.replace("/old/arm/", "/new/arm/").replace("/x/new", "/x/old"))
    assert compare(before, after) == ()
    assert with_folders(after, {"/old/arm": "/new/arm"}).links == after.links
