"""`linkforge where`, run as a program."""

import json
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.cli.test_explain import ARM, CELL


@pytest.fixture
def build(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    run = linkforge("compile", "cell.robot.yaml", "-o", "build/", "--source-map", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    return tmp_path


def line_of(build: Path, text: str) -> int:
    lines = (build / "build" / "cell.urdf").read_text().split("\n")
    return next(number for number, line in enumerate(lines, start=1) if text in line)


def test_a_line_is_shown_with_its_source_and_the_files_between(build: Path):
    number = line_of(build, "<limit ")
    run = linkforge("where", f"build/cell.urdf:{number}:14", cwd=build)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.splitlines() == [
        f'build/cell.urdf:{number}: <limit effort="20" velocity="1"/>',
        "written at arm.robot.yaml:7:22",
        "     7 |     limits: {effort: $(strength), velocity: 1}}",
        "       |                      ^^^^^^^^^^^",
        "computed: $(strength)",
        "used at cell.robot.yaml:5:15",
        "     5 |   left: {use: arm.robot.yaml, parent: table}",
        "       |               ^^^^^^^^^^^^^^",
    ]


def test_a_name_is_reported_where_it_is_written(build: Path):
    run = linkforge("where", "build/cell.urdf", "left_elbow", cwd=build)
    assert run.returncode == 0
    assert run.stdout.splitlines()[:2] == [
        f"build/cell.urdf:{line_of(build, 'left_elbow')}: joint 'left_elbow'",
        "written at arm.robot.yaml:6:3",
    ]


def test_an_unwritten_value_is_shown_as_such(build: Path):
    run = linkforge("where", "build/cell.urdf:1", cwd=build)
    assert run.stdout.splitlines()[1:] == ["no source is recorded for this line"]


def test_a_changed_document_and_a_changed_spec_are_reported(build: Path):
    urdf = build / "build" / "cell.urdf"
    urdf.write_text(urdf.read_text() + "\n")
    (build / "arm.robot.yaml").write_text("# new\n" + ARM)
    run = linkforge("where", "build/cell.urdf", "left_elbow", cwd=build)
    assert run.returncode == 0
    changed = "warning: the source map is out of date, as this file changed since"
    assert f"build/cell.urdf:1:1: {changed} its map was written" in run.stderr
    assert f"arm.robot.yaml:1:1: {changed} it was compiled" in run.stderr
    (build / "arm.robot.yaml").unlink()
    run = linkforge("where", "build/cell.urdf", "left_elbow", cwd=build)
    assert "arm.robot.yaml:1:1: warning: the source cannot be shown: there is no file" in run.stderr


@pytest.mark.parametrize(
    ("options", "codes", "returncode"),
    [((), ["LF7086"], 0), (("--werror",), ["LF7086"], 1), (("--ignore", "LF7086"), [], 0), (("-q",), [], 0)],
)
def test_its_warnings_are_chosen_as_everywhere(
    build: Path, options: tuple[str, ...], codes: list[str], returncode: int
):
    (build / "arm.robot.yaml").write_text("# new\n" + ARM)
    words = ("where", "build/cell.urdf", "left_elbow", "--diagnostics", "json", *options)
    run = linkforge(*words, cwd=build)
    assert [one["code"] for one in json.loads(run.stderr)["diagnostics"]] == codes
    assert (run.returncode, run.stdout.startswith("build/cell.urdf:")) == (returncode, True)


def test_without_a_map_the_header_tells_how_to_get_one(build: Path):
    (build / "build" / "cell.urdf.map.json").unlink()
    run = linkforge("where", "build/cell.urdf:3", cwd=build)
    assert (run.returncode, run.stdout) == (2, "")
    assert "`linkforge compile cell.robot.yaml -o build/cell.urdf --source-map`" in run.stderr


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("build/cell.urdf",), "takes a line of a file, such as robot.urdf:81, or a file and a name in it"),
        (("build/cell.urdf:3", "left_elbow"), "takes a line of a file"),
        (("build/cell.urdf:999",), "lines, found 999"),
        (("build/cell.urdf:1:999",), "line 1 of 'build/cell.urdf' has 21 columns, found 999"),
        (("build/cell.urdf", "left_elbwo"), "there is no 'left_elbwo' in build/cell.urdf; did you mean 'left_elbow'?"),
        (("build/none.urdf:3",), "there is no file 'build/none.urdf'"),
        (("build/cell.urdf.map.json", "base"), "there is no map 'build/cell.urdf.map.json.map.json'"),
        (("build:3",), "there is no file 'build'"),
    ],
)
def test_wrong_usage_is_reported(build: Path, words: tuple[str, ...], expected: str):
    run = linkforge("where", *words, cwd=build)
    assert (run.returncode, run.stdout) == (2, "")
    assert expected in run.stderr


@pytest.mark.parametrize("text", ["", "[]", '{"version": 9}', "[" * 100_000])
def test_a_broken_map_is_reported(build: Path, text: str):
    (build / "build" / "cell.urdf.map.json").write_text(text)
    run = linkforge("where", "build/cell.urdf:3", cwd=build)
    assert (run.returncode, run.stdout) == (2, "")
    assert "cell.urdf.map.json' cannot be read: it is" in run.stderr


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot>\n<link>\n</robot>\n", "expected </link>, found </robot> in line 3"),
        ("<!DOCTYPE robot>\n<robot/>", "it has a document type in line 1"),
    ],
)
def test_a_file_that_is_not_xml_is_reported(build: Path, text: str, reason: str):
    (build / "build" / "cell.urdf").write_text(text)
    run = linkforge("where", "build/cell.urdf", "left_elbow", cwd=build)
    assert run.returncode == 2
    assert f"'build/cell.urdf' is not XML: {reason}" in run.stderr


def test_each_output_has_a_map_without_machine_paths(build: Path):
    plain = linkforge("compile", "cell.robot.yaml", "-o", "plain/", cwd=build)
    assert plain.returncode == 0
    assert (build / "plain" / "cell.urdf").read_bytes() == (build / "build" / "cell.urdf").read_bytes()
    text = (build / "build" / "cell.urdf.map.json").read_text()
    assert [source["path"] for source in json.loads(text)["sources"]] == ["../cell.robot.yaml", "../arm.robot.yaml"]
    assert str(build) not in text
    again = linkforge("compile", "cell.robot.yaml", "-o", "build/", "--source-map", cwd=build)
    assert "build/cell.urdf.map.json is up to date" in again.stderr


def test_a_map_of_standard_output_is_refused(build: Path):
    run = linkforge("compile", "cell.robot.yaml", "--source-map", cwd=build)
    assert (run.returncode, run.stdout) == (2, "")
    assert "takes -o with a folder or a file" in run.stderr


def test_a_map_is_not_called_computed(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nvariables: {half: 1}\nlinks: {base: , upper: }\njoints:\n"
        "  lift: {type: prismatic, parent: base, child: upper, axis: z,\n"
        "    limits: {upper: $(half), effort: 1, velocity: 1}}\n"
    )
    assert linkforge("compile", "arm.robot.yaml", "-o", "build/", "--source-map", cwd=tmp_path).returncode == 0
    lines = (tmp_path / "build" / "arm.urdf").read_text().splitlines()
    number, line = next((at, line) for at, line in enumerate(lines, 1) if "<limit" in line)
    assert "computed: {" not in linkforge("where", f"build/arm.urdf:{number}", cwd=tmp_path).stdout
    value = f"build/arm.urdf:{number}:{line.index('upper=') + 1}"
    assert "computed: $(half)" in linkforge("where", value, cwd=tmp_path).stdout


def test_names_that_contain_the_word_are_listed(build: Path):
    run = linkforge("where", "build/cell.urdf", "elb", cwd=build)
    assert run.stderr == "linkforge where: there is no 'elb' in build/cell.urdf; there is 'left_elbow'\n"
