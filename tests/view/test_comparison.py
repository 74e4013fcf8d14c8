"""Two robots over each other: what is coloured, and what the page of `linkforge diff --html` shows."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from linkforge_compile import compile_text
from linkforge_compile.compare import compare
from linkforge_compile.view.comparison import make_comparison
from linkforge_compile.view.scene import SceneComparison
from tests.cli.in_process import linkforge

OLD = """\
linkforge: 1
name: r
links:
  base: {visual: {box: [0.4, 0.4, 0.4]}, inertial: {mass: 1}}
  arm: {visual: {sphere: 0.1}}
  tip: {visual: {box: [0.1, 0.1, 0.1]}}
  lamp: {visual: {sphere: 0.05}}
joints:
  lift: {type: prismatic, parent: base, child: arm, axis: z, limits: {lower: 0, upper: 1, effort: 1, velocity: 1}}
  weld: {type: fixed, parent: arm, child: tip, origin: [0, 0, 0.3]}
  hook: {type: fixed, parent: base, child: lamp, origin: [0, 0.4, 0]}
"""
NEW = (
    OLD.replace("sphere: 0.1}", "sphere: 0.12}")
    .replace("  lamp: {visual: {sphere: 0.05}}\n", "  rack: {visual: {sphere: 0.06}}\n")
    .replace("  hook: {type: fixed, parent: base, child: lamp, origin: [0, 0.4, 0]}\n", "")
    + "  shelf: {type: fixed, parent: base, child: rack, origin: [0, -0.4, 0]}\n"
)


def comparison_of(old: str, new: str) -> SceneComparison:
    before, after = (compile_text(text).result() for text in (old, new))
    scene, _ = make_comparison(before, after, ("old", "new"), compare(before, after))
    return scene["comparison"]


def test_each_link_that_differs_has_a_kind():
    assert comparison_of(OLD, NEW)["kinds"] == {"arm": "changed", "rack": "added", "lamp": "removed"}


def test_a_joint_is_shown_at_its_child_link():
    found = comparison_of(OLD, OLD.replace("upper: 1,", "upper: 2,"))
    assert found["kinds"] == {"arm": "changed"}
    (difference,) = found["differences"]
    assert (difference["link"], difference["path"], difference["text"]) == (
        "arm",
        "joints/lift/limits/upper",
        "1 m → 2 m (+1 m)",
    )


def test_what_belongs_to_no_link_has_none():
    found = comparison_of(OLD, OLD + "semantic: {groups: {arm: {joints: [lift]}}}\n")
    assert (found["kinds"], {one["link"] for one in found["differences"]}) == ({}, {None})


def test_renamed_links_and_joints_are_the_same_ones():
    found = comparison_of(OLD, OLD.replace("tip", "flange").replace("lift", "raise"))
    assert (found["links"], found["joints"]) == ({"tip": "flange"}, {"lift": "raise"})
    assert found["kinds"]["flange"] == "renamed"


@pytest.mark.usefixtures("page")
def test_names_on_which_others_may_rely_are_those_of_the_text(robots: Path, show: Callable[[str], Any]):
    text = linkforge("diff", "old.robot.yaml", "new.robot.yaml", cwd=robots).stdout
    head, *lines = text.split("\n\n")[1].splitlines()
    linkforge("diff", "old.robot.yaml", "new.robot.yaml", "--html", "-o", "diff.html", cwd=robots)
    shown = show((robots / "diff.html").read_text("utf-8")).locator(".removed-names")
    assert shown.inner_text().splitlines() == [head, *(" ".join(line.split()) for line in lines)]
    assert lines == ["  link   lamp", "  joint  hook"]


@pytest.fixture
def robots(tmp_path: Path) -> Path:
    (tmp_path / "old.robot.yaml").write_text(OLD)
    (tmp_path / "new.robot.yaml").write_text(NEW)
    return tmp_path


@pytest.mark.usefixtures("page")
def test_the_page_has_both_robots_and_what_differs(robots: Path):
    run = linkforge("diff", "old.robot.yaml", "new.robot.yaml", "--html", "-o", "diff.html", cwd=robots)
    assert (run.returncode, run.stdout, run.stderr) == (1, "", "wrote diff.html\n")
    html = (robots / "diff.html").read_text("utf-8")
    text = re.search(r'<script id="scene" type="application/json">(.*?)</script>', html, re.DOTALL)
    assert text
    scene = json.loads(text[1])
    assert {link["name"] for link in scene["links"]} == {"base", "arm", "tip", "rack"}
    assert {link["name"] for link in scene["comparison"]["before"]["links"]} == {"base", "arm", "tip", "lamp"}
    assert scene["comparison"]["labels"] == ["old.robot.yaml", "new.robot.yaml"]


@pytest.mark.usefixtures("page")
def test_robots_are_shown_one_by_one_and_move_together(robots: Path, show: Callable[[str], Any]):
    linkforge("diff", "old.robot.yaml", "new.robot.yaml", "--html", "-o", "diff.html", cwd=robots)
    tab = show((robots / "diff.html").read_text("utf-8"))
    before, after = tab.get_by_label("before:"), tab.get_by_label("after:")
    tab.evaluate("linkforge.set({lift: 0.5})")
    places = tab.evaluate("linkforge.before()")
    assert list(places) == ["arm", "lamp"]
    assert (places["arm"][11], places["lamp"][7]) == (0.5, 0.4)
    before.uncheck()
    assert tab.evaluate("linkforge.before()") == {}
    before.check()
    after.uncheck()
    assert list(tab.evaluate("linkforge.before()")) == ["base", "arm", "tip", "lamp"]
    tab.get_by_role("button", name="links/rack").click()
    assert tab.locator(".details h2").inner_text() == "rack"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "diff.html"), "-o is for --html; the text and --json are written to standard output"),
        (("--html", "-o", "diff.png"), "-o takes a file that ends in .html, found 'diff.png'"),
        (("--html", "--json"), "argument --json: not allowed with argument --html"),
    ],
)
def test_options_that_fit_no_page_are_refused(robots: Path, options: tuple[str, ...], message: str):
    run = linkforge("diff", "old.robot.yaml", "new.robot.yaml", *options, cwd=robots)
    assert (run.returncode, message in run.stderr) == (2, True), run.stderr
