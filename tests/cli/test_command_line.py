"""How words of the command line are read: `--`, names of options, and names of files in any locale."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile.cli.main import COMMANDS, COMMANDS_BY_TASK, main
from linkforge_compile.formats import declared_options
from tests.cli.in_process import linkforge

SPEC = "linkforge: 1\nname: arm\nlinks: {base: }\n"


@pytest.mark.parametrize(
    ("words", "output"),
    [
        (("check", "-q", "--", "-arm.robot.yaml", "b.robot.yaml"), ""),
        (("compile", "-o", "build/", "--", "-arm.robot.yaml"), ""),
        (("diff", "--", "-arm.robot.yaml", "b.robot.yaml"), "-arm.robot.yaml and b.robot.yaml are the same robot\n"),
    ],
)
def test_words_after_two_dashes_are_no_options(tmp_path: Path, words: tuple[str, ...], output: str):
    for name in ("-arm.robot.yaml", "b.robot.yaml"):
        (tmp_path / name).write_text(SPEC)
    run = linkforge(*words, cwd=tmp_path)
    assert (run.returncode, run.stdout) == (0, output), run.stderr


def test_a_file_whose_name_begins_with_a_dash_is_quoted_as_written(tmp_path: Path):
    run = linkforge("deps", "--", "-arm.robot.yaml", "-b.robot.yaml", cwd=tmp_path)
    assert run.returncode == 2
    assert "takes one spec, found 2: -arm.robot.yaml, -b.robot.yaml" in run.stderr


@pytest.mark.parametrize("words", [("compile", "--form", "urdf"), ("check", "--all"), ("diff", "--tol", "1")])
def test_an_abbreviated_option_is_refused(tmp_path: Path, words: tuple[str, ...]):
    (tmp_path / "arm.robot.yaml").write_text(SPEC)
    run = linkforge(*words, "arm.robot.yaml", cwd=tmp_path)
    assert run.returncode == 2
    assert f"unrecognized arguments: {words[1]}" in run.stderr


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_every_command_has_an_example_of_it(command: str, tmp_path: Path):
    _, _, examples = linkforge(command, "--help", cwd=tmp_path).stdout.partition("\nexamples:\n")
    assert any(f"{line} ".startswith(f"  linkforge {command} ") for line in examples.splitlines())


def test_linkforge_alone_says_what_to_do_first(tmp_path: Path):
    run = linkforge(cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    steps = [line.split()[1] for line in run.stdout.splitlines() if line.startswith("  linkforge ")]
    assert steps == ["init", "import", "migrate", "check", "view", "compile"]
    assert "linkforge COMMAND --help" in run.stdout


def test_the_first_steps_work_as_they_are_printed(tmp_path: Path):
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="base"/></robot>')
    lines = [line.split() for line in linkforge(cwd=tmp_path).stdout.splitlines() if line.startswith("  linkforge ")]
    first = {words[1]: words[1 : 3 if words[1] in ("init", "check") else 5] for words in lines}
    for name in ("init", "import", "check", "compile"):
        run = linkforge(*first[name], cwd=tmp_path)
        assert run.returncode == 0, run.stderr
    assert (tmp_path / "build" / "arm.urdf").exists()


def test_the_help_lists_every_command_once_by_task(tmp_path: Path):
    text = linkforge("--help", cwd=tmp_path).stdout
    _, _, listed = text.partition("show program's version number and exit\n")
    assert [line.split()[0] for line in listed.splitlines() if line.startswith("  ")] == list(COMMANDS)
    assert [line for line in listed.splitlines() if line.endswith(":")] == [f"{task}:" for task in COMMANDS_BY_TASK]


@pytest.mark.skipif(sys.platform != "linux", reason="only where the names of files are bytes")
def test_names_of_files_are_the_same_in_the_locale_c(tmp_path: Path):
    (tmp_path / "é.robot.yaml").write_text(SPEC)
    (tmp_path / "hall.robot.yaml").write_text(
        f"{SPEC}modules: {{m: {{use: é.robot.yaml, parent: base, prefix: m_}}}}\n"
    )
    for name in ("é", "hall"):
        command = [sys.executable, "-m", "linkforge_compile", "compile", f"{name}.robot.yaml"]
        outputs = {
            locale: subprocess.run(
                command, cwd=tmp_path, env={**os.environ, **settings}, capture_output=True, check=True, timeout=60
            ).stdout
            for locale, settings in {"C": {"LC_ALL": "C", "PYTHONUTF8": "0"}, "UTF-8": {"PYTHONUTF8": "1"}}.items()
        }
        assert outputs["C"] == outputs["UTF-8"]
        assert f"from {name}.robot.yaml" in outputs["C"].decode()


def test_options_of_formats_are_those_of_commands_on_which_they_have_an_effect(capfd: pytest.CaptureFixture[str]):
    names = {f"--{option.name}" for option in declared_options()}
    for command in COMMANDS:
        with pytest.raises(SystemExit):
            main([command, "--help"])
        shown = names.intersection(capfd.readouterr().out.split())
        effects = {
            "compile": names,
            "watch": names,
            "check": names,
            "deps": names,
            "sweep": names,
            "diff": {"--gazebo"},
        }
        assert shown == effects.get(command, set())
