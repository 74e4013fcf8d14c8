"""Diagnostics of a tree that does not fit the schema, their places, and what the next stage gets."""

from textwrap import dedent

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlFault, YamlMap, read

HEADER = "linkforge: 1\nname: arm\n"


def validated(text: str) -> tuple[YamlMap, list[str]]:
    """Return what is left of the tree, and each fault as `line:column message`."""
    sink = Diagnostics()
    tree = read(SourceFile("arm.robot.yaml", dedent(text)), sink)
    assert tree is not None
    assert not list(sink), "the text itself is faulty"
    left = validate(tree, sink)
    reported = list(sink)
    assert [fault.order for fault in reported] == sorted(fault.order for fault in reported)
    return left, [f"{fault.span.line}:{fault.span.column} {fault.message}" for fault in reported if fault.span]


def sentences(text: str) -> list[str]:
    """Return the messages about a body that follows a correct header, without the places."""
    return [fault.split(" ", 1)[1] for fault in validated(HEADER + dedent(text))[1]]


SENTENCES = {
    "links: {arm: {visuals: {}}}": "'visuals' is not a key of a link; did you mean 'visual'?",
    "links: {arm: {mass: 3}}": "'mass' is not a key of a link; write 'inertial: {mass: 3}'",
    "links: {arm: {box: [1, 1, 1]}}": "'box' is not a key of a link; it belongs under 'visual' or 'collision'",
    "links: {arm: {name: arm}}": "'name' is not a key of a link; its name is its key",
    "links: {arm: {visual: {geometry: {}}}}": (
        "'geometry' is not a key of a visual; write the shape itself, such as 'box: [1, 1, 1]'"
    ),
    "joints: {a: {dynamics: {stick: 1}}}": (
        "'stick' is not a key of a joint's dynamics; its keys are damping and friction"
    ),
    "sensor: {}": "'sensor' is not a key of a robot; did you mean 'sensors'?",
    "sensors: {eye: {width: 640}}": "'width' is not a key of a sensor; write 'camera: {width: 640}'",
    "sensors: {eye: {type: lidar, lidar: {noise: 3}}}": (
        "'noise' takes a map of type, mean, stddev, bias_mean and bias_stddev, found 3"
    ),
    "gazebo: {plugins: {a: {paramters: {b: 1}}}}": ("'paramters' is not a key of a plugin; did you mean 'parameters'?"),
    "links: {arm: {gazebo: {stopCfm: 1}}}": "'stopCfm' is not a key of a gazebo block; did you mean 'stop_cfm'?",
    "ros2_control: {arm: {parameters: {a: {b: 1}}}}": "'a' takes text, found a map",
    "links: {arm: {extra: {a: 1}}}": "'extra' takes XML or a list of XML texts, found a map",
    "links: [base, arm]": (
        "'links' takes a map of links by name, found a list; write each entry under its name, without '-': 'base: …'"
    ),
    "links: {arm: box}": "'arm' takes a map of visual, collision, inertial, physics and gazebo, found 'box'",
    "links: {arm: {inertial: {mass: [3]}}}": "'mass' takes a number [kg] or a quantity such as '3 kg', found a list",
    "links: {arm: {inertial: {mass: true}}}": "'mass' takes a number [kg] or a quantity such as '3 kg', found true",
    "links: {arm: {inertial: {mass: '3'}}}": (
        "'mass' takes a number [kg] or a quantity such as '3 kg', found the text '3'; write 3 without quotes"
    ),
    "joints: {a: {limits: {upper: far}}}": (
        "'upper' takes a number [rad or m] or a quantity such as '90 deg' or '40 mm', found 'far'"
    ),
    "joints: {a: {dynamics: {damping: 3 kg}}}": "'damping' takes a number, found '3 kg'",
    "joints: {a: {parent: {}}}": "'parent' takes a name, found a map",
    "joints: {a: {type: revolut}}": (
        "'type' takes 'revolute', 'continuous', 'prismatic', 'fixed', 'floating' or 'planar', found 'revolut'; "
        "did you mean 'revolute'?"
    ),
    "joints: {a: {axis: up}}": "'axis' takes 'x', 'y', 'z', '-x', '-y', '-z' or three numbers, found 'up'",
    "joints: {a: {axis: [0, 1]}}": "'axis' takes three numbers, found 2",
    "joints: {a: {origin: {xyz: [0, 0, up]}}}": (
        "item 3 of 'xyz' takes a number [m] or a quantity such as '25 mm', found 'up'"
    ),
    "joints: {a: {origin: 3}}": "'origin' takes a map (xyz, rpy) or three lengths, found 3",
    "links: {arm: {collision: visuals}}": (
        "'collision' takes 'visual', a collision or a list of collisions, found 'visuals'; did you mean 'visual'?"
    ),
    "links: {arm: {visual: [{sphere: 1}, ]}, tool: {visual: [3]}}": (
        "item 1 of 'visual' takes a map with a shape (box, cylinder, sphere, capsule or mesh), found 3"
    ),
    "joints: {a: {origin: [0, 0, ~]}}": (
        "item 3 of 'origin' takes a number [m] or a quantity such as '25 mm', found nothing"
    ),
    "semantic: {groups: {a: {joints: [{for: {i: 3}, vale: joint_$(i)}]}}}": (
        "'vale' is not a key of the long form; did you mean 'value'?"
    ),
    "semantic: {groups: {a: {joints: [{name: shoulder}]}}}": (
        "item 1 of 'joints' takes a name, found a map; write 'shoulder'"
    ),
    "links: {a: {when: 3}}": "'when' takes true, false or an expression $(...), found 3",
    "modules: {a: {override: {links: {b: {visual: {0: {bix: [1, 1, 1]}}}}}}}": (
        "'bix' is not a key of a visual; its keys are name, origin, box, cylinder, sphere, capsule, mesh and material"
    ),
    "modules: {a: {override: {joint: {}}}}": "'joint' is not a key of an override; did you mean 'joints'?",
}


@pytest.mark.parametrize(("body", "sentence"), SENTENCES.items(), ids=SENTENCES)
def test_a_fault_is_one_sentence(body: str, sentence: str):
    assert sentences(body) == [sentence]


def test_a_long_text_is_shortened():
    assert sentences("links: {arm: " + "long " * 20 + "}")[0].endswith(
        "found 'long long long long long long long long…'"
    )


RIGHT = {
    "an expression stands for any value, list or object": """
        links: {a: $(a), b: {visual: $(v), collision: $(c), inertial: {mass: -$(m), inertia: $(i)}}}
        joints: {a: {type: $(t), axis: $(v), origin: $(o), limits: $(v)}, b: {origin: {xyz: [$(x), 0, 0]}}}
        semantic: {passive_joints: $(p), groups: $(g)}
    """,
    "nothing said is as if not written": """
        version:
        links: {tool0: , arm: {visual: , inertial: {mass: }}}
        joints: {shoulder: {limits: , axis: , type: ~}}
        semantic:
    """,
    "text and names are taken as written": """
        version: 1.0
        links: {1: , true: }
        joints: {2: {parent: 1, child: true}}
    """,
    "names are for later stages to judge": """
        links: {wheel_$(side): , "a b": , visuals: }
    """,
    "what begins with x- is the author's own": """
        x-anchors: {visuals: [1, {linkforge: 3}]}
    """,
}


@pytest.mark.parametrize("body", RIGHT.values(), ids=RIGHT)
def test_nothing_is_reported_where(body: str):
    assert sentences(body) == []


def test_all_faults_are_reported_at_once_each_at_its_place():
    _, reported = validated("""\
        linkforge: 1
        name: arm
        link: {}
        joints:
          elbow: {type: hinge, limits: {upper: far, efort: 3}}
    """)
    assert reported == [
        "3:1 'link' is not a key of a robot; did you mean 'links'?",
        "5:17 'type' takes 'revolute', 'continuous', 'prismatic', 'fixed', 'floating' or 'planar', "
        "found 'hinge'; write 'revolute'",
        "5:40 'upper' takes a number [rad or m] or a quantity such as '90 deg' or '40 mm', found 'far'",
        "5:45 'efort' is not a key of a joint's limits; did you mean 'effort'?",
    ]


def test_every_fault_within_the_matching_branch_of_a_union_is_reported():
    reported = sentences("links: {arm: {visual: [{boxx: 1, box: [1]}, {origin: {rpz: 1, xyz: {}}}]}}")
    assert reported == [
        "'boxx' is not a key of a visual; did you mean 'box'?",
        "'box' takes three lengths, found 1",
        "'rpz' is not a key of an origin; its keys are xyz and rpy",
        "'xyz' takes three lengths, found a map",
    ]


@pytest.mark.parametrize(
    ("use", "place"),
    [
        ("collision: *v", "5:7"),
        ("collision: [*v]", "5:18"),
        ("collision: {name: c, <<: *v}", "5:18"),
        ("visual: {sphere: {radius: 1}}, collision: *v", "5:38"),
    ],
)
def test_what_an_alias_brings_in_is_reported_with_the_place_that_uses_it(use: str, place: str):
    sink = Diagnostics()
    text = HEADER + f"x-shape: &v {{color: red}}\nlinks:\n  a: {{{use}}}\n"
    tree = read(SourceFile("r", text), sink)
    assert tree is not None
    validate(tree, sink)
    [reported] = sink
    assert str(reported.span) == "r:3:14"
    assert [(note.message, str(note.span)) for note in reported.notes] == [("inserted here", f"r:{place}")]


def test_of_several_uses_that_do_not_fit_the_first_in_the_file_is_reported():
    sink = Diagnostics()
    uses = "".join(f"  {name}: {{visual: *v}}\n" for name in "hgfedcba")  # jsonschema takes them as a set has them
    tree = read(SourceFile("r", HEADER + f"x-shape: &v {{color: red}}\nlinks:\n{uses}"), sink)
    assert tree is not None
    validate(tree, sink)
    assert [str(note.span) for reported in sink for note in reported.notes] == ["r:5:7"]


@pytest.mark.parametrize("text", ["name: arm\n", "name: arm\nlinkforge:\n"])
def test_a_missing_version_is_reported_first(text: str):
    _, reported = validated(text)
    assert reported == ["1:1 write 'linkforge: 1' first: it states which version of the language the file uses"]


def test_another_version_is_reported_at_its_number():
    _, reported = validated("linkforge: 2\nname: arm\n")
    assert reported == ["1:12 'linkforge' takes 1, the version of the language, found 2"]


def test_a_robot_without_a_name_is_reported():
    assert validated("linkforge: 1\n")[1] == [
        "1:1 a robot needs a 'name'; a file for 'include' is checked with the file that includes it"
    ]


def test_what_is_faulty_does_not_go_on_and_the_rest_does():
    left, _ = validated(HEADER + "foo: 1\nlinks:\n  arm: {visuals: 1, inertial: {mass: [3], density: 2700}}\n  base:\n")
    links = left.get("links")
    assert isinstance(links, YamlMap)
    assert isinstance(left.get("foo"), YamlFault)
    assert list(links.entries) == ["arm", "base"]
    arm = links.get("arm")
    assert isinstance(arm, YamlMap)
    assert isinstance(arm.get("visuals"), YamlFault)
    inertial = arm.get("inertial")
    assert isinstance(inertial, YamlMap)
    assert isinstance(inertial.get("mass"), YamlFault)
    assert not isinstance(inertial.get("density"), YamlFault)


def test_only_an_included_file_needs_no_name():
    tree = read(SourceFile("part.yaml", "linkforge: 1\nlinks: {base: }\n"), Diagnostics())
    assert tree is not None
    sink = Diagnostics()
    assert validate(tree, sink, is_included=True) is tree
    assert not list(sink)
    validate(tree, sink)
    assert [diagnostic.code.id for diagnostic in sink] == ["LF2003"]


def test_a_faultless_tree_is_returned_as_it_is():
    tree = read(SourceFile("arm.robot.yaml", HEADER + "links: {base: }\n"), Diagnostics())
    assert tree is not None
    assert validate(tree, Diagnostics()) is tree


def test_what_was_a_fault_before_is_not_validated_again():
    sink = Diagnostics()
    text = HEADER + "links: {base: {visual: {box: [1, 1], origin: {xyz: 3, rpy: 4}}}}\n"
    tree = read(SourceFile("arm.robot.yaml", text), sink)
    assert tree is not None
    once = validate(tree, sink)
    again = Diagnostics()
    assert validate(once, again) is once
    assert not list(again)
