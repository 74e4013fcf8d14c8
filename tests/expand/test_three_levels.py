"""A fault deep in modules points into the file that has it, with every `use` that brought it in, innermost first."""

import pytest

from linkforge_compile import compile_file

CELL = "linkforge: 1\nname: cell\nlinks: {table: }\nmodules:\n  left: {use: arm.robot.yaml, parent: table}\n"
ARM = "linkforge: 1\nname: arm\nlinks: {upper: }\nmodules:\n\n  hand: {use: hand.robot.yaml, parent: upper}\n"
HAND = "linkforge: 1\nname: hand\nlinks: {palm: }\nmodules:\n\n\n  tip: {use: tip.robot.yaml, parent: palm}\n"
TIP = "linkforge: 1\nname: tip\n"

FAULTS = {
    "the shape of the file": ("LF2101", "links: {pad: {visuals: {sphere: 1}}}"),
    "an expression": ("LF3107", "links: {pad: {visual: {sphere: $(radius)}}}"),
    "a value": ("LF5002", "links: {pad: {visual: {sphere: 3 kg}}}"),
    "a name": ("LF4102", "links: {pad: }\njoints: {glue: {type: fixed, parent: pda, child: pad}}"),
    "a body": ("LF6003", "links: {pad: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 5}}}}"),
    "a semantic part": (
        "LF5602",
        "links: {a: , b: }\njoints: {j: {type: fixed, parent: a, child: b}}\n"
        "semantic: {groups: {g: {chain: {base_link: b, tip_link: a}}}}",
    ),
}


@pytest.mark.parametrize(("code", "tip"), FAULTS.values(), ids=FAULTS)
def test_a_fault_three_modules_deep_is_reported_with_every_use(code: str, tip: str, tmp_path):
    for name, text in {"cell": CELL, "arm": ARM, "hand": HAND, "tip": f"{TIP}{tip}\n"}.items():
        (tmp_path / f"{name}.robot.yaml").write_text(text)
    diagnostics = [one for one in compile_file(tmp_path / "cell.robot.yaml").diagnostics if one.code.id == code]
    assert len(diagnostics) == 1
    assert diagnostics[0].span.file.path.name == "tip.robot.yaml"
    uses = [(note.span.file.path.name, note.span.line) for note in diagnostics[0].notes if note.message == "used here"]
    assert uses == [("hand.robot.yaml", 7), ("arm.robot.yaml", 6), ("cell.robot.yaml", 5)]
