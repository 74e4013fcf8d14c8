"""Sections whose line may be missing: other entries stay where they are."""

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import read

HEADER = "linkforge: 1\nname: arm\n"


def reported(body: str) -> list[str]:
    sink = Diagnostics()
    tree = read(SourceFile("arm.robot.yaml", HEADER + body), sink)
    assert tree is not None
    validate(tree, sink)
    return [diagnostic.code.id for diagnostic in sink]


RIGHT = {
    "a joint lacks what defaults give": "defaults: {joint: {type: fixed}}\njoints: {a: {child: b}, c: {child: d}}",
    "a joint says only its type": "joints: {a: {type: fixed, child: b}, b: {type: revolute}}",
    "a joint says only what a link may say": "joints: {a: {child: b}, b: {gazebo: {mu1: 1}}}",
    "links have the names of sections": "links: {base: , sensors: , joints: , arm: {visual: {sphere: 0.1}}}",
    "variables hold what links do": "variables: {a: 1, wheel: {visual: {sphere: 0.1}}, steel: {color: [1, 1, 1]}}",
    "parameters have the names of sections": "parameters: {links: 3, joints: {type: integer, default: 2}}",
    "variables without a value have such names": "variables: {joints: , n: 3}",
    "a variable without a value stands before one of those names": "variables: {joints: , links: 2}",
    "no variable of any value has the keys of a joint": "variables: {parameters: , variants: , joints: , n: {a: 3}}",
    "variables have the keys of an object and other values": "variables: {gazebo: , plugins: {mock: mock/System}}",
    "variables are called as the keys of an object": "variables: {gazebo: , gravity: true}",
    "metadata have such names": "metadata: {joints: , author: me}",
    "a variant says what a joint does": "variants: {links: , joints: {child: 3}}",
    "a note of the author's own has such names": "x-notes: {joints: , todo: measure again}",
    "a note of the author's own looks like a section": "x-notes: {joints: , a: {parent: b, child: c}}\nlinks: {b: }",
    "one of several sections says nothing": "materials: \nlinks: {base: }\njoints:",
}


@pytest.mark.parametrize("body", RIGHT.values(), ids=RIGHT)
def test_nothing_is_reported_where(body: str):
    assert reported(body) == []


MEANT_OTHERWISE = {
    "the section is there already": "frames: {a: {parent: b}}\nlinks: {b: , c: {parent: b}}",
    "an entry has keys of its own section besides": "links: {b: , c: {parent: b, visual: {sphere: 0.1}}}",
    "all of a section are of another": "links: {c: {parent: b, child: d, type: fixed}, e: {parent: b, child: c}}",
    "a value is of another kind than in the object": "parameters: {a: 1, plugins: {mock: mock/System, sim: b}}",
    "it is not the end of a section": "links: {b: , c: {type: fixed, parent: b, child: d}, d: {visual: {sphere: 0.1}}}",
}


@pytest.mark.parametrize("body", MEANT_OTHERWISE.values(), ids=MEANT_OTHERWISE)
def test_keys_are_reported_one_by_one_where(body: str):
    assert set(reported(body)) == {"LF2101"}
