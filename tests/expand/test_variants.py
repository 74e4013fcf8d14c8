"""Test the precedence of `variants`, and what is reported of those that are not selected."""

from dataclasses import replace
from pathlib import Path

import pytest

from linkforge_compile import compile_file, compile_text
from linkforge_compile.limits import Limit
from linkforge_compile.pipeline import check_variants
from tests.expand.assembling import write

SPEC = """\
linkforge: 1
name: arm
parameters: {hardware: {enum: [mock, gazebo, real], default: mock}, reach: 1 m, size: $(reach / 2)}
variants:
  sim: {hardware: gazebo, size: $(reach * 3)}
  lab: {reach: 20 cm}
  plain:
links: {base: }
metadata: {hardware: $(hardware), reach: $(reach), size: $(size)}
"""


def values(**options):
    robot = compile_text(SPEC, **options).result()
    return [robot.metadata[name] for name in ("hardware", "reach", "size")]


@pytest.mark.parametrize(
    ("options", "found"),
    [
        ({}, ["mock", "1", "0.5"]),
        ({"variant": "plain"}, ["mock", "1", "0.5"]),
        ({"variant": "sim"}, ["gazebo", "1", "3"]),
        ({"variant": "lab"}, ["mock", "0.2", "0.1"]),
        ({"variant": "sim", "parameters": ["hardware=real"]}, ["real", "1", "3"]),
        ({"variant": "sim", "parameters": {"reach": 2}}, ["gazebo", "2", "6"]),
    ],
)
def test_a_parameter_beats_the_variant_beats_the_default(options, found):
    assert values(**options) == found


def test_an_unknown_variant_is_reported_as_typed():
    (diagnostic,) = compile_text(SPEC, name="arm.robot.yaml", variant="simm").diagnostics
    assert str(diagnostic) == (
        "<command line>:1:11: error: arm.robot.yaml has no variant named 'simm'; did you mean 'sim'? [LF3080]"
    )


def test_of_several_variants_the_last_one_that_sets_a_parameter_decides():
    assert values(variant="sim+lab")[:2] == ["gazebo", "0.2"]
    assert values(variant="lab+plain+sim")[:2] == ["gazebo", "0.2"]
    clashing = SPEC.replace("lab: {reach: 20 cm}", "lab: {hardware: real}")
    found = [compile_text(clashing, variant=name).result().metadata["hardware"] for name in ("sim+lab", "lab+sim")]
    assert found == ["real", "gazebo"]


def test_variants_that_set_a_parameter_to_different_values_are_reported_unless_it_is_given():
    clashing = SPEC.replace("lab: {reach: 20 cm}", "lab: {hardware: real}")
    (warning,) = compile_text(clashing, name="arm.robot.yaml", variant="sim+lab").diagnostics
    assert str(warning) == (
        "arm.robot.yaml:6:19: warning: parameter 'hardware' is set by variant 'lab', which replaces what variant 'sim' "
        "sets [LF3081]"
    )
    assert [str(note.span) for note in warning.notes] == ["arm.robot.yaml:5:19"]
    assert not compile_text(clashing, variant="sim+lab", parameters=["hardware=mock"]).diagnostics


@pytest.mark.parametrize(
    ("type_", "first", "second", "differ"),
    [
        ("string", "gazebo", "gazebo", False),
        ("string", "1.10", "1.1", True),
        ("length", "1 m", "1000 mm", False),
        ("length", "1 m", "1", False),
        ("number", "2", "2.0", False),
        ("number", "2", "$(b * 2)", False),
        ("number", "$(b * 2)", "2", False),
        ("number", "$(b * 2)", "3", False),
        ("list", "[1, 2]", "[1, 3]", True),
    ],
)
def test_variants_disagree_if_their_values_of_the_type_are_known_to_differ(type_, first, second, differ):
    spec = f"""\
linkforge: 1
name: arm
parameters: {{a: {{type: {type_}}}, b: 1}}
variants: {{x: {{a: {first}}}, q: {{a: {second}}}}}
links: {{base: }}
"""
    for variant in ("x+q", "q+x"):
        found = [one.code.id for one in compile_text(spec, variant=variant).diagnostics]
        assert found == (["LF3081"] if differ else [])


def test_a_variant_with_a_plus_in_its_name_is_one():
    spec = SPEC.replace("plain:", "sim+lab: {hardware: real}")
    assert compile_text(spec, variant="sim+lab").result().metadata["hardware"] == "real"


def test_each_unknown_name_of_several_variants_is_reported_at_its_place():
    found = compile_text(SPEC, name="arm.robot.yaml", variant="lab+simm+other").diagnostics
    assert [str(one).partition(": error")[0] for one in found] == ["<command line>:1:15", "<command line>:1:20"]
    assert [one.code.id for one in found] == ["LF3080", "LF3080"]


@pytest.mark.parametrize(
    ("variants", "expected"),
    [
        ("{sim: {}, lab: {}}", "its variants are 'sim' and 'lab'"),
        (
            "{" + ", ".join(f"v{number}: {{}}" for number in range(9)) + "}",
            "its variants are 'v0', 'v1', 'v2', 'v3', 'v4', 'v5', 'v6', 'v7' and 1 more",
        ),
        ("{}", "it declares no variants"),
    ],
)
def test_an_unknown_variant_is_reported_with_the_known_ones(variants: str, expected: str):
    spec = f"linkforge: 1\nname: arm\nvariants: {variants}\nlinks: {{base: }}\n"
    (diagnostic,) = compile_text(spec, variant="other").diagnostics
    assert diagnostic.message == f"<text> has no variant named 'other'; {expected}"


def test_an_expression_of_a_variant_is_checked_even_if_not_selected():
    spec = SPEC.replace("$(reach * 3)", "$(reech * 3)")
    assert [one.code.id for one in compile_text(spec).diagnostics] == ["LF3107"]
    assert not compile_text(SPEC.replace("$(reach * 3)", "$(1 / (reach - reach))")).diagnostics


def test_a_required_parameter_is_set_by_a_variant():
    spec = SPEC.replace("reach: 1 m", "reach: {type: length}")
    assert [one.code.id for one in compile_text(spec).diagnostics] == ["LF3021"]
    assert not compile_text(spec, variant="lab").diagnostics


def test_the_variants_of_a_module_mean_nothing(tmp_path: Path):
    write(tmp_path, {"robot.robot.yaml": "variants: {sim: {}}\nmodules: {arm: {use: arm.robot.yaml}}\n"})
    (tmp_path / "arm.robot.yaml").write_text(SPEC.replace("lab: {reach: 20 cm}", "lab: {rich: 20 cm}"))
    assert not compile_file(tmp_path / "robot.robot.yaml", variant="sim").diagnostics
    assert compile_file(tmp_path / "arm.robot.yaml").robot is None


def test_a_path_in_a_variant_is_relative_to_its_file(tmp_path: Path):
    write(
        tmp_path,
        {
            "arms/arm.robot.yaml": """
                parameters: {mesh: {type: file, default: a.stl}}
                variants: {other: {mesh: meshes/b.stl}}
                links: {base: {visual: {mesh: $(mesh)}}}
            """
        },
    )
    robot = compile_file(tmp_path / "arms/arm.robot.yaml", variant="other").result()
    assert robot.links[0].visuals[0].geometry.resource == "meshes/b.stl"


def test_every_variant_is_checked_and_the_defaults(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(SPEC + "joints: {$(hardware): {type: fixed, parent: base, child: tip}}\n")
    compilations = check_variants(tmp_path / "arm.robot.yaml")
    assert list(compilations) == [None, "sim", "lab", "plain"]
    assert {one.diagnostics[0].code.id for one in compilations.values()} == {"LF4102"}


MANY = f"""\
linkforge: 1
name: arm
variants: {{{", ".join(f"v{number}: " for number in range(12))}}}
links: {{base: }}
modules: {{tool: {{use: tool.robot.yaml, parent: base}}}}
"""
TOOL = "linkforge: 1\nname: tool\nlinks: {tip: }\n"


@pytest.mark.parametrize(
    ("limit", "text", "before"),
    [
        (Limit.CHARACTERS_READ, TOOL + "#" * 800, 4 * ["LF3301"]),
        (Limit.VALUES, TOOL + "metadata: {x: [" + "0, " * 600 + "0]}", 4 * ["LF3301"]),
        (Limit.VALUES, TOOL + "metadata: {x: [" + "0, " * 500 + "0]}", 5 * [""]),
        (Limit.VALUES, TOOL + "metadata: {x: [" + "0, " * 500 + "0}", 5 * ["LF1009"]),
        (Limit.ROUNDS, TOOL.replace("tip:", "tip_$(i): {for: {i: 601}}"), 4 * ["LF3301"]),
    ],
)
def test_variants_share_what_five_compiles_may_take(
    limit: Limit, text: str, before: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(limit, "_value_", replace(limit.value, most=600))
    (tmp_path / "tool.robot.yaml").write_text(text)
    (tmp_path / "arm.robot.yaml").write_text(MANY)
    found = check_variants(tmp_path / "arm.robot.yaml").values()
    codes = [one and " ".join(diagnostic.code.id for diagnostic in one.diagnostics) for one in found]
    assert codes == [*before, "LF3304", *[None] * (12 - len(before))]


def test_the_check_budget_is_shared_by_all_variants(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    # The defaults and all variants together may have five times as many entries as one compile.
    monkeypatch.setattr(Limit.ENTRIES, "_value_", replace(Limit.ENTRIES.value, most=28))
    (tmp_path / "tool.urdf").write_text("<robot name='tool'><link name='tip'/></robot>")
    (tmp_path / "tool.srdf").write_text("<robot name='tool'><group name='all'><link name='tip'/></group></robot>")
    (tmp_path / "arm.robot.yaml").write_text(MANY.replace("tool.robot.yaml", "tool.urdf, srdf: tool.srdf"))
    found = check_variants(tmp_path / "arm.robot.yaml")
    assert [name for name, one in found.items() if one is None] == ["v9", "v10", "v11"]
