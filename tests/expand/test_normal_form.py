"""Short forms made long: each is equal to its long form."""

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.long_forms import SHORT_FORMS, long_form, long_object, with_frames_as_joints
from linkforge_compile.schema.registry import definitions
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap, YamlNode, read
from tests.expand.assembling import plain


def node_of(text: str) -> YamlNode:
    tree = read(SourceFile("test.yaml", f"node: {text}"), Diagnostics())
    assert tree
    return tree.entries["node"].value


@pytest.mark.parametrize(
    ("path", "short", "long"),
    [
        ("joints a origin", "[1, 2, 3]", {"xyz": [1, 2, 3]}),
        ("links a visual 0 sphere", "1 m", {"radius": "1 m"}),
        ("links a visual 0 mesh", "a.stl", {"file": "a.stl"}),
        ("links a visual", "{sphere: 1}", [{"sphere": 1}]),
        ("links a visual 0 material", "steel", "steel"),
        ("modules a joint", "mount", {"name": "mount"}),
        ("semantic groups a chains", "{base_link: a}", [{"base_link": "a"}]),
        ("ros2_control a joints b command_interfaces", "[position, effort]", {"position": None, "effort": None}),
        ("links a visual", "", None),
        ("joints a axis", "x", "x"),
        ("links a visual 0 box", "[1, 2, 3]", {"size": [1, 2, 3]}),
        ("semantic disabled_collisions a b", "Never", {"reason": "Never"}),
    ],
)
def test_a_short_form_is_its_long_one(path: str, short: str, long: object):
    shape = shapes()
    for key in path.split():
        shape = (shape.item if key == "0" else None) or shape.under(key)
    assert plain(long_form(node_of(short), shape)) == long


@pytest.mark.parametrize(("title", "key"), SHORT_FORMS.items())
def test_a_short_form_is_of_an_object_that_has_the_key(title: str, key: str):
    unions = [branch for whole in definitions().values() for branch in whole.get("anyOf", [whole])]
    assert any(key in branch.get("properties", {}) for branch in unions if branch.get("title") == title)


def test_a_copied_collision_has_the_shapes_without_their_paint():
    link = node_of("{visual: {name: a, sphere: 1, origin: [0, 0, 1], material: steel}, collision: visual}")
    assert isinstance(link, YamlMap)
    assert plain(long_object(link, shapes().under("links").under("a")))["collision"] == [
        {"sphere": 1, "origin": [0, 0, 1]}
    ]


def test_a_chain_is_the_first_of_the_chains():
    group = node_of("{chains: [{base_link: b}], chain: {base_link: a}}")
    assert isinstance(group, YamlMap)
    whole = long_object(group, shapes().under("semantic").under("groups").under("a"))
    assert plain(whole) == {"chains": [{"base_link": "a"}, {"base_link": "b"}]}


def test_frames_become_links_and_fixed_joints_after_those_of_the_file():
    tree = node_of(
        "{links: {a: }, frames: {tool: {parent: a, origin: [0, 0, 1]}, eye: {parent: a, joint: lid}, bad: 3}}"
    )
    assert isinstance(tree, YamlMap)
    assert plain(with_frames_as_joints(tree)) == {
        "links": {"a": None, "tool": {}, "eye": {}},
        "joints": {
            "tool_joint": {"type": "fixed", "parent": "a", "origin": [0, 0, 1], "child": "tool"},
            "lid": {"type": "fixed", "parent": "a", "child": "eye"},
        },
        "frames": {"bad": 3},
    }
