"""Modules: what an instance knows of its use, and how far uses lead."""

from itertools import pairwise
from pathlib import Path

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand import Instance, Unset, arguments_from_text, expand
from linkforge_compile.expand.expand_uses import MAX_DEPTH
from linkforge_compile.load import Loader
from tests.expand.assembling import metadata_of, plain, write


def compiled(folder: Path, sink: Diagnostics, *, unset: Unset = Unset.ERROR) -> Instance:
    loader = Loader()
    spec = loader.open(folder / "robot.robot.yaml", sink)
    assert spec, [str(diagnostic) for diagnostic in sink]
    return expand(spec, arguments_from_text((), sink), loader, sink, unset=unset)


def messages(sink: Diagnostics) -> list[str]:
    return [diagnostic.message for diagnostic in sink.sorted()]


@pytest.fixture
def sink() -> Diagnostics:
    return Diagnostics()


def test_a_module_is_computed_in_its_own_scope_with_what_its_user_gives(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                parameters: {reach: 1 m}
                variables: {own: robot}
                modules:
                  left: {use: arm.robot.yaml, with: {reach: $(reach / 2)}}
                  right: {use: arm.robot.yaml, with: {}}
            """,
            "arm.robot.yaml": """
                parameters: {reach: 0.1 m}
                variables: {own: arm}
                metadata: {who: "$(name) $(own) $(reach) $(standalone)"}
            """,
        },
    )
    assembly = compiled(tmp_path, sink)
    assert not messages(sink)
    assert [metadata_of(module)["who"] for module in assembly.modules] == ["arm arm 0.5 false", "arm arm 0.1 false"]


def test_an_instance_has_its_name_prefix_entry_and_include_stack(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                parameters: {side: left}
                modules:
                  $(side)_arm: {use: arm.robot.yaml, parent: $(side)_shoulder}
                  bare: {use: arm.robot.yaml, prefix: ""}
                  other: {use: arm.robot.yaml, prefix: $(side)_}
            """,
            "arm.robot.yaml": "modules: {hand: {use: hand.robot.yaml}}",
            "hand.robot.yaml": "links: {palm: }",
        },
    )
    assembly = compiled(tmp_path, sink)
    left = assembly.modules[0]
    (hand,) = left.modules
    assert [(module.name, module.prefix) for module in assembly.modules] == [
        ("left_arm", "left_arm_"),
        ("bare", ""),
        ("other", "left_"),
    ]
    assert plain(left.entry.node) == {"use": "arm.robot.yaml", "parent": "left_shoulder"}
    assert (left.entry.span.text, left.entry.at("parent").text) == ("$(side)_arm", "$(side)_shoulder")
    assert [(Path(use.file.name).name, use.line) for use in hand.include_stack] == [
        ("arm.robot.yaml", 3),
        ("robot.robot.yaml", 5),
    ]
    assert hand.entry.trail == left.include_stack
    # The modules of one `for` have the same `use`.
    assert [use.module for use in hand.include_stack] == ["hand", "left_arm"]


def test_a_fault_of_a_module_has_a_note_of_its_use(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": "modules: {a: {use: arm.robot.yaml}}",
            "arm.robot.yaml": "metadata: {a: $(unknown)}",
        },
    )
    compiled(tmp_path, sink)
    (diagnostic,) = sink
    assert [note.message for note in diagnostic.notes] == ["used here"]
    assert diagnostic.notes[0].span.text == "arm.robot.yaml"


def test_a_fault_of_an_argument_is_reported_at_the_argument(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": "modules: {a: {use: arm.robot.yaml, with: {reach: 3 kg}}}",
            "arm.robot.yaml": "parameters: {reach: 1 m}\nmetadata: {r: $(reach)}",
        },
    )
    assembly = compiled(tmp_path, sink)
    (diagnostic,) = sink
    assert diagnostic.span.text == "3 kg"
    assert [note.span.text for note in diagnostic.notes] == ["reach"]
    assert metadata_of(assembly.modules[0]) == {"r": "FAULT"}


def test_a_required_parameter_of_a_module_is_an_error_even_if_those_of_the_robot_are_not_checked(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                parameters: {reach: {type: length}}
                modules: {a: {use: arm.robot.yaml}, b: {use: arm.robot.yaml, with: {reach: $(reach)}}}
            """,
            "arm.robot.yaml": "parameters: {reach: {type: length}}",
        },
    )
    compiled(tmp_path, sink, unset=Unset.NOTE)
    assert messages(sink) == [
        "nothing sets 'reach' here, so parts that depend on it are not checked",
        "parameter 'reach' has no default and must be set; write 'with: {reach: LENGTH}'",
    ]


def test_arguments_may_come_from_a_variable(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                variables: {arm: {reach: 3 m, label: $$(x)}, whole: {use: arm.robot.yaml, with: {reach: 4 m}}}
                modules: {a: {use: arm.robot.yaml, with: $(arm)}, b: $(whole)}
            """,
            "arm.robot.yaml": "parameters: {reach: 1 m, label: none}\nmetadata: {r: $(reach) $(label)}",
        },
    )
    assembly = compiled(tmp_path, sink)
    assert not messages(sink)
    assert [metadata_of(module) for module in assembly.modules] == [{"r": "3 $(x)"}, {"r": "4 none"}]


def test_a_faulty_argument_name_asks_for_no_other_argument(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": "modules: {a: {use: arm.robot.yaml, with: {$(key): 1}}}",
            "arm.robot.yaml": "parameters: {reach: {type: length}}",
        },
    )
    compiled(tmp_path, sink)
    assert messages(sink) == ["no parameter, variable or 'for' name 'key' here"]


@pytest.mark.parametrize("entry", ["use: gone.robot.yaml", "use: $(x)", "use: arm.robot.yaml, prefix: $(x)"])
def test_a_module_that_cannot_be_had_is_an_instance_without_a_tree(tmp_path, sink, entry):
    write(tmp_path, {"robot.robot.yaml": f"modules: {{a: {{{entry}}}}}", "arm.robot.yaml": "links: {base: }"})
    (module,) = compiled(tmp_path, sink).modules
    assert (module.name, module.tree) == ("a", None)
    assert module.prefix == ("" if "prefix" in entry else "a_")
    assert len(sink) == 1


def test_modules_at_fault_as_a_whole_may_be_any(tmp_path, sink):
    write(tmp_path, {"robot.robot.yaml": "modules: $(x)"})
    (module,) = compiled(tmp_path, sink).modules
    assert (module.tree, module.prefix) == (None, "")
    assert len(sink) == 1


def test_one_file_may_be_used_often_and_is_read_once(tmp_path):
    uses = "".join(f"  a{number}: {{use: ./arm.robot.yaml}}\n" for number in range(20))
    write(tmp_path, {"robot.robot.yaml": f"modules:\n{uses}", "arm.robot.yaml": "links: {base: }"})
    sink, loader = Diagnostics(), Loader()
    spec = loader.open(tmp_path / "robot.robot.yaml", sink)
    assembly = expand(spec, arguments_from_text((), sink), loader, sink)
    assert len({module.tree.get("links") for module in assembly.modules}) == 1
    assert [path.name for path in loader.files] == ["robot.robot.yaml", "arm.robot.yaml"]


def test_the_circle_is_reported_with_each_of_its_lines(tmp_path, sink):
    write(
        tmp_path,
        {
            "robot.robot.yaml": "modules: {a: {use: parts/a.robot.yaml}}",
            "parts/a.robot.yaml": "modules: {b: {use: b.robot.yaml}}",
            "parts/b.robot.yaml": "modules: {a: {use: ../robot.robot.yaml}}",
        },
    )
    compiled(tmp_path, sink)
    (diagnostic,) = sink
    path = "robot.robot.yaml → parts/a.robot.yaml → parts/b.robot.yaml → robot.robot.yaml"
    assert diagnostic.message == f"modules use each other in a cycle: {path}"
    assert diagnostic.span.text == "../robot.robot.yaml"
    assert [note.span.text for note in diagnostic.notes[:2]] == ["parts/a.robot.yaml", "b.robot.yaml"]


def test_uses_are_bounded_in_depth(tmp_path, sink):
    names = ["robot", *(f"m{depth}" for depth in range(1, MAX_DEPTH + 2))]
    specs = {f"{name}.robot.yaml": f"modules: {{a: {{use: {inner}.robot.yaml}}}}" for name, inner in pairwise(names)}
    write(tmp_path, {**specs, f"{names[-1]}.robot.yaml": "links: {base: }"})
    compiled(tmp_path, sink)
    assert messages(sink) == [f"modules are used inside modules more than {MAX_DEPTH} deep"]


def test_uses_are_bounded_in_number(tmp_path, sink):
    ten = "{" + ", ".join(f"m{number}: {{use: NEXT.robot.yaml}}" for number in range(10)) + "}"
    names = ["robot", "a", "b", "c", "d"]
    specs = {f"{name}.robot.yaml": "modules: " + ten.replace("NEXT", inner) for name, inner in pairwise(names)}
    write(tmp_path, {**specs, "d.robot.yaml": "links: {base: }"})
    with pytest.raises(BeyondLimitError, match="more than 30,000 links, joints, other entries and modules"):
        compiled(tmp_path, sink)
