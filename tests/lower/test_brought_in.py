"""A fault in what an alias or `<<` inserts is reported at its anchor, with the place of use."""

import pytest

from linkforge_compile import compile_text

SPEC = """linkforge: 1
name: r
x-limits: &limits {lower: -1, upper: 1, effort: 20 N*m, velocity: 1}
x-shape: &shape {sphere: 2 kg}
x-mass: &mass {mass: 2 kg}
x-name: &name nowhere
links: {a: , b: , c: }
joints:
  one: {type: revolute, parent: a, child: b, axis: z, limits: *limits}
  two: {type: prismatic, parent: b, child: c, axis: z}
"""


@pytest.mark.parametrize(
    ("line", "used", "code", "notes"),
    [
        (10, "two: {limits: *limits,", "LF5002", [("10:9", ", for limits of joint 'two'")]),
        (10, "two: {limits: {<<: *limits},", "LF5002", [("10:17", ", for limits of joint 'two'")]),
        (7, "links: {a: {visual: *shape},", "LF5002", [("7:13", ", for visual of link 'a'")]),
        (7, "links: {a: {visual: [*shape]},", "LF5002", [("7:13", ", for visual of link 'a'")]),
        (7, "links: {a: {inertial: *mass},", "LF5111", [("7:13", ", for inertial of link 'a'")]),
        (7, "links: {a: {visual: {sphere: 1, material: *name}},", "LF4105", [("7:33", ", for visual of link 'a'")]),
        (7, "links: {a: {collision: {sphere: 2 kg}},", "LF5002", []),
        (10, "two: {mimic: {joint: *name},", "LF4103", [("10:17", "")]),
    ],
)
def test_an_aliased_value_is_shown_with_its_use(line: int, used: str, code: str, notes: list[tuple[str, str]]):
    lines = SPEC.splitlines()
    lines[line - 1] = lines[line - 1].replace("links: {a: ,", used).replace("two: {", used + " ")
    diagnostics = [one for one in compile_text("\n".join(lines), name="r").diagnostics if one.code.id == code]
    assert [(note.message, str(note.span)) for note in diagnostics[0].notes] == [
        (f"inserted here{owner}", f"r:{place}") for place, owner in notes
    ]
