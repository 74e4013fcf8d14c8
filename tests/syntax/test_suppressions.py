"""Comments that suppress diagnostics."""

from dataclasses import replace
from pathlib import Path

import pytest

from linkforge_compile import compile_file, compile_text
from linkforge_compile.diagnostics.reports import merge_reports
from linkforge_compile.limits import Limit
from linkforge_compile.pipeline import check_variants
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.parser import suppressions_in
from tests.yaml_case import compile_yaml


def found(text: str) -> list[tuple[int, list[str]]]:
    return [(one.line, [code for code, _ in one.codes]) for one in suppressions_in(SourceFile("a.robot.yaml", text))]


@pytest.mark.parametrize(
    ("text", "ignores"),
    [
        ("a: 1  # linkforge: ignore LF6003", [(1, ["LF6003"])]),
        ("a: 1  #linkforge:ignore LF6003", [(1, ["LF6003"])]),
        ("a: 1  # linkforge: ignore LF6003, LF6004 LF5606 for 2 reasons, LF1", [(1, ["LF6003", "LF6004", "LF5606"])]),
        ("# linkforge: ignore LF6003\n\n# why\n\nb: 1\n", [(5, ["LF6003"])]),
        ("b:\n  [1, # linkforge: ignore LF6003\n  2]\n", [(2, ["LF6003"])]),
        ("b: |\n  text\n# linkforge: ignore LF6003\nc: 1\n", [(4, ["LF6003"])]),
        ("\ufeffa: 1  # linkforge: ignore LF6003", [(1, ["LF6003"])]),
        ("a: 1\r\nb: 2  # linkforge: ignore LF6003\r\n", [(2, ["LF6003"])]),
        ("b: {mass:}  # linkforge: ignore LF6003", [(1, ["LF6003"])]),
        ("a: 1  # linkforge: ignore", [(1, [])]),
        ("a: 1  # linkforge: ignored LF6003", []),
        ("a: 'x # linkforge: ignore LF6003'", []),
        ("b: >-\n  x\n  # linkforge: ignore LF6003\n  y\n", []),
        ("a: x#linkforge: ignore", []),
        ("a: '1  # linkforge: ignore LF6003", []),
    ],
)
def test_a_comment_is_found_where_yaml_sees_one(text: str, ignores: list[tuple[int, list[str]]]):
    assert found(text) == ignores


def test_a_comment_is_placed_at_its_codes():
    (ignore,) = suppressions_in(SourceFile("a.robot.yaml", "é: 1  # linkforge: ignore LF6003, LF6004"))
    assert str(ignore.span) == "a.robot.yaml:1:7"
    assert [(span.column, span.text) for _, span in ignore.codes] == [(27, "LF6003"), (35, "LF6004")]


def test_an_error_is_reported_though_a_comment_ignores_it():
    compile_yaml("""
        linkforge: 1
        name: case
        links: {base: }
        joints:
          # linkforge: ignore LF4102   # W[LF1203]:23 LF4102 is an error, which cannot be ignored
          hinge: {type: fixed, parent: base, child: hand}   # E[LF4102]:45 no link named 'hand'
    """)


def test_what_is_ignored_in_a_module_is_not_reported_of_the_robot(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks:\n"
        "  base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 5}}}  # linkforge: ignore LF6003\n"
    )
    (tmp_path / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: cell\nlinks: {floor: }\nmodules:\n"
        "  left: {use: arm.robot.yaml, parent: floor}\n  right: {use: arm.robot.yaml, parent: floor}\n"
    )
    assert compile_file(tmp_path / "cell.robot.yaml").diagnostics == ()


def test_an_ignore_that_one_variant_needs_is_not_reported(tmp_path: Path):
    text = """\
linkforge: 1
name: arm
parameters: {heavy: false}
variants: {heavy: {heavy: true}}
links:
  base:
    inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: $(5 if heavy else 1)}}  # linkforge: ignore LF6003
  # linkforge: ignore LF6004
  tool: {visual: {sphere: 0.1}}
joints: {weld: {type: fixed, parent: base, child: tool}}
"""
    (tmp_path / "arm.robot.yaml").write_text(text)
    runs = {str(name): one.diagnostics for name, one in check_variants(tmp_path / "arm.robot.yaml").items()}
    assert [one.code.id for one in runs["None"]] == ["LF1204", "LF1204"]
    (reported,) = merge_reports(runs)
    assert reported.message == "LF6004 is not reported on line 9; remove it from this comment"


def test_comments_are_counted_by_their_codes_and_end_the_compile_beyond_the_bound(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(Limit.IGNORED_CODES, "_value_", replace(Limit.IGNORED_CODES.value, most=3))
    spec = "linkforge: 1\nname: r\nlinks: {base: }\n# linkforge: ignore LF6003, LF6004\n"
    few = compile_text(spec + "# linkforge: ignore LF6005\n")
    assert {reported.code.id for reported in few.diagnostics} == {"LF1204"}
    (reported,) = compile_text(spec + "# linkforge: ignore\n# linkforge: ignore\n").diagnostics
    assert (reported.code.id, reported.span and reported.span.line) == ("LF3301", 6)
    assert "3 codes in `linkforge: ignore` comments" in reported.message
