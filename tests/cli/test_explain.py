"""`linkforge explain`, run as a program."""

from pathlib import Path

import pytest

from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.resources import manual_folder
from tests.cli.test_compile import linkforge

ARM = """\
linkforge: 1
name: arm
parameters: {strength: 20 N*m}
links: {base: , upper: }
joints:
  elbow: {type: continuous, parent: base, child: upper, axis: z,
    limits: {effort: $(strength), velocity: 1}}
"""
CELL = """\
linkforge: 1
name: cell
links: {table: }
modules:
  left: {use: arm.robot.yaml, parent: table}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    return tmp_path


def test_a_value_is_told_with_its_place_its_expression_and_the_files_between(cell: Path):
    run = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/effort", cwd=cell)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.splitlines() == [
        "joints/left_elbow/limits/effort: 20 N*m",
        "written at arm.robot.yaml:7:22",
        "     7 |     limits: {effort: $(strength), velocity: 1}}",
        "       |                      ^^^^^^^^^^^",
        "computed: $(strength)",
        "used at cell.robot.yaml:5:15",
        "     5 |   left: {use: arm.robot.yaml, parent: table}",
        "       |               ^^^^^^^^^^^^^^",
    ]


def test_what_nobody_wrote_is_told_as_such(cell: Path):
    run = linkforge("explain", "cell.robot.yaml", "joints/left_joint/type", cwd=cell)
    assert run.stdout.splitlines()[:3] == [
        "joints/left_joint/type: fixed",
        "nothing is written for it",
        "what it belongs to is written at cell.robot.yaml:5:3",
    ]


def test_parameters_are_set_before(cell: Path):
    run = linkforge("explain", "arm.robot.yaml", "joints/elbow/limits/effort", "strength:=7", cwd=cell)
    assert run.stdout.startswith("joints/elbow/limits/effort: 7 N*m\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("arm.robot.yaml",), "takes a spec and a path, such as joints/elbow/limits/effort"),
        (("arm.robot.yaml", "joints/elbwo"), "there is no 'elbwo' in 'joints'; did you mean 'elbow'?"),
    ],
)
def test_wrong_usage_is_told(cell: Path, words: tuple[str, ...], said: str):
    run = linkforge("explain", *words, cwd=cell)
    assert (run.returncode, run.stdout) == (2, "")
    assert said in run.stderr


def test_a_spec_with_errors_is_told(cell: Path):
    (cell / "arm.robot.yaml").write_text(ARM.replace("axis: z", "axis: w"))
    run = linkforge("explain", "arm.robot.yaml", "name", cwd=cell)
    assert (run.returncode, run.stdout) == (1, "")
    assert "axis" in run.stderr


def test_what_an_override_and_a_default_gave_way_to_is_told(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(ARM + "defaults: {joint: {limits: {effort: 5, velocity: 9}}}\n")
    patch = "override: {joints: {elbow: {limits: {effort: 30 N*m}}}}"
    (tmp_path / "cell.robot.yaml").write_text(CELL.replace("parent: table", f"parent: table, {patch}"))
    run = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/effort", cwd=tmp_path)
    told = [line for line in run.stdout.splitlines() if " at " in line]
    assert run.stdout.startswith("joints/left_elbow/limits/effort: 30 N*m\n")
    assert told[0].startswith("written at cell.robot.yaml:5:")
    assert told[1:3] == [
        "instead of what is written at arm.robot.yaml:7:22",
        "instead of what is written at arm.robot.yaml:8:37",
    ]
    unchanged = linkforge("explain", "cell.robot.yaml", "joints/left_elbow/limits/velocity", cwd=tmp_path)
    assert "instead of what is written at arm.robot.yaml:8:50" in unchanged.stdout
    assert "cell.robot.yaml:5:15" not in run.stdout


def test_a_code_is_explained_by_its_page_of_the_manual(tmp_path: Path):
    run = linkforge("explain", "lf1002", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout == (manual_folder() / "LF1002.md").read_text("utf-8")


def test_a_page_is_styled_where_colours_are_asked_for(tmp_path: Path):
    run = linkforge("explain", "LF1002", cwd=tmp_path, FORCE_COLOR="1", NO_COLOR="")
    assert run.stdout.startswith("\033[1mLF1002: YAML is indented with spaces, found a tab\033[0m\n")
    assert "```" not in run.stdout
    assert "    \033[36mlinks:\033[0m" in run.stdout.splitlines()


def test_all_codes_are_listed(tmp_path: Path):
    lines = linkforge("explain", "--codes", cwd=tmp_path).stdout.splitlines()
    assert [line.partition(" ")[0] for line in lines] == sorted(REGISTER)
    assert "LF4102  error    no link named '…'" in lines


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("LF4192",), "no diagnostic has the code 'LF4192'; did you mean 'LF4102'?"),
        (("--codes", "LF4102"), "--codes lists all codes and takes no words, found 'LF4102'"),
    ],
)
def test_a_code_that_is_none_is_wrong_usage(tmp_path: Path, words: tuple[str, ...], said: str):
    run = linkforge("explain", *words, cwd=tmp_path)
    assert run.returncode == 2
    assert said in run.stderr
