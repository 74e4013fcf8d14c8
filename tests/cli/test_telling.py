"""In which form diagnostics come out of the commands, which of them, and where."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree

from tests.cli.in_process import linkforge
from tests.cli.test_check import FAULTY
from tests.cli.test_compile import PENDULUM

HEAVY = PENDULUM.replace("mass: 1.5", "mass: 1.5, inertia: {ixx: 0.1, iyy: 0.1, izz: 0.5}").replace("rod", "bar")
"""Compiles, with the one warning LF6003."""


@pytest.fixture
def specs(tmp_path: Path) -> Path:
    (tmp_path / "clean.robot.yaml").write_text(PENDULUM)
    (tmp_path / "faulty.robot.yaml").write_text(FAULTY)
    (tmp_path / "heavy.robot.yaml").write_text(HEAVY)
    return tmp_path


def codes(text: str) -> list[str]:
    return [one["code"] for one in json.loads(text)["diagnostics"]]


def test_check_writes_forms_for_programs_to_standard_output(specs: Path):
    words = ("check", "clean.robot.yaml", "faulty.robot.yaml", "heavy.robot.yaml")
    run = linkforge(*words, "--format", "json", cwd=specs)
    assert run.returncode == 1
    assert codes(run.stdout) == ["LF4105", "LF2101", "LF2202", "LF6003"]
    assert run.stderr == "checked 3 specs: 3 errors, 1 warning\n"
    assert linkforge(*words, "--diagnostics", "json", cwd=specs).stdout == run.stdout


def test_compile_keeps_standard_output_for_the_robot(specs: Path):
    run = linkforge("compile", "heavy.robot.yaml", "--diagnostics", "json", cwd=specs)
    assert run.returncode == 0
    assert etree.fromstring(run.stdout.encode()).tag == "robot"
    assert codes(run.stderr) == ["LF6003"]
    run = linkforge("compile", "faulty.robot.yaml", "--diagnostics", "sarif", "-o", "out/", cwd=specs)
    assert (run.returncode, run.stdout) == (1, "")
    assert len(json.loads(run.stderr)["runs"][0]["results"]) == 3
    run = linkforge("compile", "clean.robot.yaml", "--diagnostics", "json", "-o", "out/", cwd=specs)
    assert codes(run.stderr) == []


def test_annotations_name_files_from_the_top_of_the_checkout(specs: Path):
    (specs / "robots").mkdir()
    (specs / "faulty.robot.yaml").rename(specs / "robots" / "faulty.robot.yaml")
    words = ("check", "faulty.robot.yaml", "--format", "github")
    run = linkforge(*words, cwd=specs / "robots", GITHUB_WORKSPACE=str(specs))
    assert run.stdout.splitlines()[0].startswith("::error file=robots/faulty.robot.yaml,line=4,col=45,")
    run = linkforge(*words, cwd=specs / "robots", GITHUB_WORKSPACE="")
    assert run.stdout.splitlines()[0].startswith("::error file=faulty.robot.yaml,line=4,col=45,")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ((), ["LF6003"]),
        (("--ignore", "LF6"), []),
        (("--ignore", "lf5,LF6003"), []),
        (("--select", "LF5"), []),
        (("--select", "LF5", "--select", "LF60"), ["LF6003"]),
        (("-q",), []),
        (("-q", "--werror"), ["LF6003"]),
    ],
)
def test_warnings_are_chosen(specs: Path, words: tuple[str, ...], expected: list[str]):
    assert codes(linkforge("check", "heavy.robot.yaml", "--format", "json", *words, cwd=specs).stdout) == expected


def test_warnings_taken_for_errors_stop_the_output(specs: Path):
    words = ("heavy.robot.yaml", "--werror")
    run = linkforge("check", *words, cwd=specs)
    assert run.returncode == 1
    assert ": error: " in run.stderr
    assert run.stderr.endswith("checked 1 spec: 1 error\n")
    run = linkforge("compile", *words, "-o", "out/", cwd=specs)
    assert run.returncode == 1
    assert not (specs / "out").exists()
    assert linkforge("compile", *words, "--ignore", "LF6003", cwd=specs).returncode == 0


def test_quiet_is_silent_when_all_is_well(specs: Path):
    for words in (("check", "heavy.robot.yaml"), ("compile", "clean.robot.yaml", "-o", "out/")):
        run = linkforge(*words, "-q", cwd=specs)
        assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    assert linkforge("check", "faulty.robot.yaml", "-q", cwd=specs).stderr.count(": error: ") == 3


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--ignore", "LF600O"), "no diagnostic has the code 'LF600O'; did you mean 'LF6"),
        (("--select", "E501"), "no diagnostic has the code 'E501'"),
        (("--ignore", "LF4102"), "LF4102 is an error, which cannot be ignored"),
        (("--ignore", "LF11"), "LF11 selects only errors, which cannot be ignored"),
        (("--format", "xml"), "invalid choice: 'xml'"),
        (("-", "--all-variants"), "--all-variants takes files, not standard input"),
    ],
)
def test_an_option_that_cannot_be_followed_is_wrong_usage(specs: Path, words: tuple[str, ...], expected: str):
    run = linkforge("check", "heavy.robot.yaml", *words, cwd=specs)
    assert run.returncode == 2
    assert expected in run.stderr


def test_a_spec_is_checked_from_standard_input_with_paths_from_here(specs: Path):
    cell = "linkforge: 1\nname: cell\nmodules: {arm: {use: clean.robot.yaml, with: {lenght: 1}}}\n"
    run = linkforge("check", "-", cwd=specs, stdin=cell)
    assert run.returncode == 1
    assert run.stderr.startswith("<stdin>:3:47: error: no parameter named 'lenght'; did you mean 'length'? [LF3020]\n")
    assert linkforge("check", "-", cwd=specs, stdin=cell.replace("lenght", "length")).returncode == 0
    required = PENDULUM.replace(", default: 0.5 m", "")
    assert linkforge("check", "-", cwd=specs, stdin=required).returncode == 0
    assert linkforge("compile", "-", cwd=specs, stdin=required).returncode == 1


def test_no_more_is_read_of_standard_input_than_of_a_file(specs: Path):
    run = linkforge("check", "-", cwd=specs, stdin="#" * (16 * 1024**2 + 1))
    assert (run.returncode, run.stdout) == (2, "")
    assert "standard input is larger than 16 MiB" in run.stderr


def test_colors_are_written_on_request(specs: Path):
    always = linkforge("check", "faulty.robot.yaml", "--color", "always", cwd=specs, NO_COLOR="1")
    assert "\033[1;31merror:" in always.stderr
    never = linkforge("check", "faulty.robot.yaml", "--color", "never", cwd=specs, FORCE_COLOR="1")
    assert "\033" not in never.stderr


@pytest.mark.skipif(os.name == "nt", reason="POSIX's pseudo-terminals")
def test_on_a_terminal_text_is_colored_and_refers_to_explain(specs: Path):
    ours, theirs = os.openpty()
    command = (sys.executable, "-m", "linkforge_compile", "compile", "faulty.robot.yaml")
    plain = {name: value for name, value in os.environ.items() if name not in {"NO_COLOR", "FORCE_COLOR"}}
    subprocess.run(command, cwd=specs, stderr=theirs, check=False, timeout=60, env={**plain, "TERM": "xterm"})
    os.close(theirs)
    stderr = os.read(ours, 10_000).decode()
    os.close(ours)
    assert "\033[1;31merror:" in stderr
    assert stderr.endswith("run 'linkforge explain LF4105' for more\r\n")


def test_the_problem_matcher_is_written(specs: Path):
    assert linkforge("matcher", "-o", "matcher.json", cwd=specs).returncode == 0
    assert json.loads((specs / "matcher.json").read_text())["problemMatcher"][0]["owner"] == "linkforge"
