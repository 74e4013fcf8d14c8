"""`for` and `when`: what is there, how often, in which order, and what is never computed."""

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, DeletedNames
from linkforge_compile.expand.values import size_of
from tests.expand.assembling import Assembled, assemble, plain, write


def links(assembled: Assembled) -> object:
    return plain(assembled.instance.tree.get("links"))


def test_for_gives_the_product_and_the_first_name_varies_slowest():
    made = assemble("links: {wheel_$(side)_$(end): {for: {side: [left, right], end: [front, rear]}}}")
    assert list(links(made)) == ["wheel_left_front", "wheel_left_rear", "wheel_right_front", "wheel_right_rear"]


def test_a_number_counts_from_zero_and_a_value_may_use_the_names_before_it():
    made = assemble("""
        parameters: {rows: 2}
        links: {cell_$(row)_$(column): {for: {row: $(rows + 1), column: $(row)}}}
    """)
    assert list(links(made)) == ["cell_1_0", "cell_2_0", "cell_2_1"]


def test_items_may_be_maps_and_reach_everything_nested():
    made = assemble("""
        links: {$(w.name)_wheel: {for: {w: [{name: left, y: 0.2}]}, visual: {box: [1, 1, 1], origin: [0, $(w.y), 0]}}}
    """)
    assert links(made) == {"left_wheel": {"visual": {"box": [1, 1, 1], "origin": [0, 0.2, 0]}}}


def test_items_of_lists_repeat_without_a_key():
    made = assemble("links: {a: {visual: [{sphere: 1}, {for: {r: [2, 3]}, sphere: $(r)}]}}")
    assert links(made) == {"a": {"visual": [{"sphere": 1}, {"sphere": 2}, {"sphere": 3}]}}


def test_one_visual_counts_as_an_item():
    made = assemble("links: {a: {visual: {for: {r: [2, 3]}, sphere: $(r)}}}")
    assert links(made) == {"a": {"visual": [{"sphere": 2}, {"sphere": 3}]}}


def test_values_that_are_not_objects_use_the_long_form():
    made = assemble("""
        parameters: {thumb: false}
        semantic:
          passive_joints: [{for: {f: [a, b]}, value: $(f)_tip}, {when: $(thumb), value: thumb}, wrist]
          group_states:
            hand: {open: {"$(f)_tip": {for: {f: [a, b]}, value: 90 deg}, thumb: {when: $(thumb), value: 1}}}
          disabled_collisions: {"$(f)_tip": {for: {f: [a, b]}, value: {palm: Never}}}
    """)
    assert plain(made.instance.tree.get("semantic")) == {
        "passive_joints": ["a_tip", "b_tip", "wrist"],
        "group_states": {"hand": {"open": {"a_tip": "90 deg", "b_tip": "90 deg"}}},
        "disabled_collisions": {"a_tip": {"palm": "Never"}, "b_tip": {"palm": "Never"}},
    }


def test_when_removes_entries_items_and_parts():
    made = assemble("""
        parameters: {real: false}
        links:
          base: {visual: [{when: $(not real), sphere: 1}, {when: $(real), sphere: 2}], inertial: {when: false, mass: 1}}
          motor: {when: $(real)}
          tool: {when: , inertial: {when: $(null), mass: 1}}
    """)
    assert links(made) == {"base": {"visual": [{"sphere": 1}]}, "tool": {"inertial": {"mass": 1}}}


def test_parts_removed_by_when_are_not_computed():
    made = assemble("""
        parameters: {fingers: {type: integer, default: 0}}
        links:
          gap: {when: $(fingers > 0), visual: {sphere: $(1 / fingers)}}
          each_$(i): {when: $(fingers > 0), for: {i: $(7 / fingers)}}
          odd_$(i): {for: {i: 3}, when: $(i % 2 == 1), visual: {sphere: $(1 / i)}}
    """)
    assert not made.messages
    assert list(links(made)) == ["odd_1"]


def test_disabled_names_are_remembered_with_the_place_of_their_when():
    made = assemble("""
        parameters: {drive: false}
        links: {wheel_$(side): {for: {side: [left, right]}, when: $(drive)}}
    """)
    removed = made.instance.removed.names
    assert {name: (note.span.line, note.span.column) for name, note in removed.items()} == {
        "wheel_left": (4, 59),
        "wheel_right": (4, 59),
    }


def test_only_what_has_a_name_of_its_own_is_remembered_as_disabled():
    made = assemble("semantic: {disabled_collisions: {base: {tool: {when: false, value: Never}}}}")
    assert made.instance.removed == DeletedNames()


def test_for_and_when_are_plain_keys_in_free_parts():
    text = "{for: {a: 1}, when: no, value: 3, list: [{for: 1, value: 2}]}"
    made = assemble(f"""
        parameters: {{given: {{type: map, default: {text}}}}}
        variables: {{own: {text}}}
        metadata: {{written: {text}, given: $(given), own: $(own)}}
        semantic: {{joint_properties: {{elbow: {{when: 1, value: 2}}}}}}
    """)
    whole = {"for": {"a": 1}, "when": "no", "value": 3, "list": [{"for": 1, "value": 2}]}
    assert made.metadata == {"written": whole, "given": whole, "own": whole}
    assert plain(made.instance.tree.get("semantic")) == {"joint_properties": {"elbow": {"when": 1, "value": 2}}}
    assert not made.messages


def test_modules_repeat_each_with_its_own_arguments(tmp_path):
    write(tmp_path, {"leg.robot.yaml": "parameters: {length: 1}\nmetadata: {length: $(length)}"})
    made = assemble(
        """
        modules: {leg_$(i): {for: {i: 3}, when: $(i != 1), use: leg.robot.yaml, with: {length: $(10 * i)}}}
        """,
        folder=tmp_path,
    )
    lengths = {leg.name: plain(leg.tree.get("metadata").get("length")) for leg in made.instance.modules}
    assert lengths == {"leg_0": 0, "leg_2": 20}


def test_a_fault_inside_a_for_is_reported_once():
    made = assemble("links: {a_$(i): {for: {i: 4}, visual: {sphere: $(j)}}}")
    assert made.messages == ["no parameter, variable or 'for' name 'j' here"]


def test_copies_with_the_same_name_are_reported():
    made = assemble('links: {"a_$(min(i, 1))": {for: {i: 3}}}')
    assert made.messages == ["the expressions give the key 'a_1' twice"]


@pytest.mark.parametrize(
    "written",
    [
        "{for: {i: 1000000000}}",
        "{for: {i: 100000, j: 100000}}",
        "{for: {i: 1000, j: 1000, k: 1}}",
        "{for: {i: 600}, visual: {for: {j: 2000}, sphere: $(j)}}",
    ],
)
def test_the_work_of_for_is_bounded(written: str):
    names = "".join(f"_$({name})" for name in "ijk" if f"{name}:" in written.partition("visual")[0])
    with pytest.raises(BeyondLimitError, match="more than 50,000 iterations of 'for'"):
        assemble(f"links: {{a{names}: {written}}}")


def test_a_file_without_repetition_is_not_walked_twice():
    made = assemble("links: {a: {visual: {sphere: 1}}}\nmetadata: {x: $(1 + 1)}")
    assert made.metadata == {"x": 2}
    assert made.instance.removed == DeletedNames()


def test_the_keys_of_computed_maps_count_as_values_for_they_need_as_much_memory():
    assert size_of({"left": 1, "right": (2, "<a/>")}, 99) == (1 + 2 + 2 + 2 + 1, 9 + 4, 2)
