"""`linkforge collisions` for several specs and for folders."""

import json
from pathlib import Path

import pytest
import yaml

from tests.cli.in_process import linkforge
from tests.conftest import ROOT

pytest.importorskip("pinocchio")

FINGER = """\
linkforge: 1
name: finger
links: {near: {collision: {sphere: 0.1}}, far: {collision: {sphere: 0.1}}}
joints: {knuckle: {type: continuous, parent: near, child: far, axis: z, origin: [1, 0, 0]}}
"""
HAND = """\
linkforge: 1
name: hand
links: {palm: {collision: {sphere: 0.1}}}
modules: {finger: {use: finger.robot.yaml, parent: palm}}
"""
SECTION = "semantic:\n  disabled_collisions:\n"
ADJACENT = f"{SECTION}    near: {{far: Adjacent}}\n"


@pytest.fixture
def robots(tmp_path: Path) -> Path:
    """A folder with a hand, its finger, which both have the section, and a lamp, which has none."""
    (tmp_path / "finger.robot.yaml").write_text(FINGER + SECTION, "utf-8")
    # Its name is before that of its module in the alphabet.
    (tmp_path / "a_hand.robot.yaml").write_text(f"{HAND}{SECTION}    palm: {{finger_near: Never}}\n", "utf-8")
    (tmp_path / "lamp.robot.yaml").write_text(FINGER.replace("finger", "lamp"), "utf-8")
    return tmp_path


def test_modules_of_a_folder_are_written_before_the_robots_that_use_them(robots: Path):
    (robots / "finger.robot.yaml").write_text(f"{FINGER}{SECTION}    near: {{far: Never}}\n", "utf-8")
    lamp = (robots / "lamp.robot.yaml").read_text("utf-8")
    done = linkforge("collisions", ".", "--write", cwd=robots)
    assert done.returncode == 0
    assert (robots / "finger.robot.yaml").read_text("utf-8") == FINGER + ADJACENT
    # The pair inside of the finger is the finger's.
    pairs = f"{SECTION}    palm: {{finger_near: Adjacent, finger_far: Never}}\n"
    assert (robots / "a_hand.robot.yaml").read_text("utf-8") == HAND + pairs
    assert (robots / "lamp.robot.yaml").read_text("utf-8") == lamp
    assert linkforge("collisions", ".", "--check", cwd=robots).returncode == 0


def test_a_check_names_each_spec_that_is_out_of_date(robots: Path):
    done = linkforge("collisions", "finger.robot.yaml", "lamp.robot.yaml", "a_hand.robot.yaml", "--check", cwd=robots)
    assert done.returncode == 1
    for name in ("finger", "lamp", "a_hand"):
        assert f"{name}.robot.yaml: " in done.stderr
        assert f"the pairs are out of date; run 'linkforge collisions {name}.robot.yaml --write'" in done.stderr


def test_the_hook_of_pre_commit_is_the_check(robots: Path):
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    (hook,) = [one for one in hooks if one["id"] == "linkforge-collisions"]
    program, *words = hook["entry"].split()
    assert program == "linkforge"
    assert linkforge(*words, ".", cwd=robots).returncode == 1
    assert linkforge("collisions", ".", "--write", cwd=robots).returncode == 0
    assert linkforge(*words, ".", cwd=robots).returncode == 0


def test_several_sections_and_documents_name_their_specs(robots: Path):
    words = ("collisions", "lamp.robot.yaml", "finger.robot.yaml", "--quiet")
    section = "disabled_collisions:\n  near: {far: Adjacent}\n"
    assert linkforge(*words, cwd=robots).stdout == f"# finger.robot.yaml\n{section}# lamp.robot.yaml\n{section}"
    documents = json.loads(linkforge(*words, "--json", cwd=robots).stdout)
    assert [one["spec"] for one in documents] == ["finger.robot.yaml", "lamp.robot.yaml"]
    assert documents[0]["disabled"] == [{"link1": "near", "link2": "far", "reason": "Adjacent"}]


def test_a_faulty_spec_does_not_keep_others_from_their_check(robots: Path):
    (robots / "lamp.robot.yaml").write_text("linkforge: 1\nname: lamp\nlinks: {near: , far: }\n", "utf-8")
    (robots / "finger.robot.yaml").write_text(FINGER + ADJACENT, "utf-8")
    done = linkforge("collisions", "lamp.robot.yaml", "finger.robot.yaml", "--check", cwd=robots)
    assert done.returncode == 1
    assert "2 roots" in done.stderr
    assert "finger.robot.yaml: 1 pairs need no check (1 Adjacent), 0 do\nthe pairs are up to date\n" in done.stderr


def test_a_folder_without_the_section_is_an_error(robots: Path):
    (robots / "finger.robot.yaml").unlink()
    (robots / "a_hand.robot.yaml").unlink()
    done = linkforge("collisions", ".", "--check", cwd=robots)
    assert done.returncode == 2
    assert "no spec below has pairs in `disabled_collisions`; name the specs that need it" in done.stderr
