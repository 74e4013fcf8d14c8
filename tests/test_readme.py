"""The README's commands are the ones that CI runs, and its robot is the one that it shows."""

import re

from linkforge_compile import compile_text, render_urdf
from linkforge_compile.diagnostics.render_text import render_text
from tests.conftest import ROOT

README = (ROOT / "README.md").read_text("utf-8")


def test_ci_runs_the_test_command_of_the_readme():
    last = (ROOT / ".ci" / "run").read_text("utf-8").strip().splitlines()[-1]
    assert last in README


def test_every_file_that_the_readme_names_exists():
    for target in re.findall(r"\]\((?!http)([^)#]+)", README):
        assert (ROOT / target).exists(), target


def block(language: str) -> str:
    """Return the README's first block of code in a language."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)[0]


def test_the_robot_of_the_readme_compiles_to_what_it_shows():
    urdf = render_urdf(compile_text(block("yaml")).result(), banner="Compiled by linkforge.")
    assert block("xml") in urdf
    assert f"writes {len(urdf.splitlines())} lines of URDF" in README


def test_the_mistakes_of_the_readme_are_reported_as_shown():
    spec = block("yaml")
    for right, wrong in (("collision:", "colision:"), ("parent: base", "parent: bass"), ("5 N*m", "5 kg")):
        assert right in spec
        spec = spec.replace(right, wrong, 1)
    assert render_text(compile_text(spec, name="cart.robot.yaml").diagnostics) == block("text")
