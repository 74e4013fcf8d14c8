"""The README's commands are the ones that CI runs, and its robot is the one that it shows."""

import re

import pytest

from benchmarks import lines
from linkforge_compile import compile_text, render_urdf
from linkforge_compile.cli.main import COMMANDS
from linkforge_compile.diagnostics.render_text import render_text
from linkforge_compile.units import UNITS
from tests.conftest import ROOT

README = (ROOT / "README.md").read_text("utf-8")


def test_ci_runs_the_test_command_of_the_readme():
    last = (ROOT / ".ci" / "run").read_text("utf-8").strip().splitlines()[-1]
    assert last in README


def test_every_file_that_the_readme_names_exists():
    for target in re.findall(r"\]\((?!http)([^)#]+)", README):
        assert (ROOT / target).exists(), target


def test_the_readme_lists_every_command():
    listed = re.findall(r"^linkforge (\w+) ", README, re.MULTILINE)
    assert set(listed) == set(COMMANDS)


def block(language: str) -> str:
    """Return the README's first block of code in a language."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)[0]


def test_the_robot_of_the_readme_compiles_to_what_it_shows():
    banner = "Compiled by linkforge from pendulum.robot.yaml; edit that file, not this one."
    assert render_urdf(compile_text(block("yaml")).result(), banner=banner) == block("xml")


def test_the_mistakes_of_the_readme_are_reported_as_shown():
    spec = block("yaml")
    for right, wrong in (("collision:", "colision:"), ("child: rod", "child: rood"), ("effort: 2 N*m", "effort: 2 kg")):
        assert right in spec
        spec = spec.replace(right, wrong)
    assert render_text(compile_text(spec, name="pendulum.robot.yaml").diagnostics) == block("text")


def test_the_readme_names_every_unit():
    line = next(line for line in README.splitlines() if line.startswith("Units: "))
    assert set(UNITS) <= set(re.findall(r"[^\s`;]+", line))


@pytest.mark.parametrize("counted", [*lines.ROBOTS, *lines.TWINS], ids=lambda counted: counted.name)
def test_the_readme_states_the_lines_of_a_robot(counted: lines.Robot | lines.Twin):
    assert f"| {lines.of_xacro(counted)} | {lines.of_ours(counted)} |" in README
