"""docs/commands.md lists every command, and its exit codes are those of the command line."""

import re

import pytest

from benchmarks import lines
from linkforge_compile import cli
from linkforge_compile.cli.main import COMMANDS
from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "commands.md").read_text("utf-8")


def test_every_command_is_listed():
    assert set(re.findall(r"^linkforge (\w+) ", PAGE, re.MULTILINE)) == set(COMMANDS)


def test_every_exit_code_is_explained():
    explained = {int(code) for code in re.findall(r"^\| (\d+) \| ", PAGE, re.MULTILINE)}
    assert explained == {cli.OK, cli.FAULTY_SPEC, cli.WRONG_USAGE, cli.INTERNAL_FAULT, cli.INTERRUPTED}


@pytest.mark.parametrize("counted", [*lines.ROBOTS, *lines.TWINS], ids=lambda counted: counted.name)
def test_the_comparison_states_the_lines_of_a_robot(counted: lines.Robot | lines.Twin):
    page = (ROOT / "docs" / "compared-with-xacro.md").read_text("utf-8")
    assert f"| {lines.of_xacro(counted)} | {lines.of_ours(counted)} |" in page
