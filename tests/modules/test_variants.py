"""`variants`: what beats what, and what is told of those that nobody chose."""

from pathlib import Path

import pytest

from linkforge_compile import compile_file, compile_text
from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.pipeline import check_variants
from tests.modules.assembling import write

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


def test_an_unknown_variant_is_told_as_it_was_typed():
    (told,) = compile_text(SPEC, name="arm.robot.yaml", variant="simm").diagnostics
    assert str(told) == (
        "<command line>:1:11: error: arm.robot.yaml has no variant named 'simm'; did you mean 'sim'? [LF3080]"
    )


@pytest.mark.parametrize(
    ("variants", "said"),
    [
        ("{sim: {}, lab: {}}", "its variants are 'sim' and 'lab'"),
        (
            "{" + ", ".join(f"v{number}: {{}}" for number in range(9)) + "}",
            "its variants are 'v0', 'v1', 'v2', 'v3', 'v4', 'v5', 'v6', 'v7' and 1 more",
        ),
        ("{}", "it declares no variants"),
    ],
)
def test_an_unknown_variant_is_told_with_those_that_there_are(variants: str, said: str):
    spec = f"linkforge: 1\nname: arm\nvariants: {variants}\nlinks: {{base: }}\n"
    (told,) = compile_text(spec, variant="other").diagnostics
    assert told.message == f"<text> has no variant named 'other'; {said}"


def test_an_expression_of_a_variant_is_read_even_where_nobody_chose_it():
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


def test_variants_share_what_five_compiles_may_take(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    class Spent(Budget):
        def __init__(self, times: int = 1, *, shared_by: str = "", within: Budget | None = None) -> None:
            super().__init__(times, shared_by=shared_by, within=within)
            if shared_by:
                self.spend(Limit.ENTRIES, times * Limit.ENTRIES.most - 15, None)

    monkeypatch.setattr("linkforge_compile.pipeline.Budget", Spent)
    (tmp_path / "arm.robot.yaml").write_text(SPEC)
    *whole, (last, ended) = check_variants(tmp_path / "arm.robot.yaml").items()
    assert [(name, one.diagnostics) for name, one in whole] == [(None, ()), ("sim", ())]
    assert (last, [one.code.id for one in ended.diagnostics]) == ("lab", ["LF3301"])
    assert "more than 150,000 links" in ended.diagnostics[0].message
    assert "in all its variants together" in ended.diagnostics[0].message
