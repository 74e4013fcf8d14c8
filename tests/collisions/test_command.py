"""`linkforge collisions` as a command: its output, options and errors."""

import json
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.collisions.sampled import HEAD
from tests.meshes import block

pytest.importorskip("pinocchio")

ARM = """
links:
  base: {collision: {box: [0.1, 0.1, 0.1]}}
  arm: {collision: {box: [0.1, 0.1, 0.5], origin: [0, 0, 0.3]}}
  hand: {collision: {box: [0.1, 0.1, 0.1], origin: [0, 0, 0.1]}}
  tool0:
joints:
  shoulder: {type: revolute, parent: base, child: arm, axis: y, limits: {lower: -90 deg, upper: 90 deg, effort: 1,
    velocity: 1}}
  wrist: {type: continuous, parent: arm, child: hand, axis: z, origin: [0, 0, 0.55]}
  tool: {type: fixed, parent: hand, child: tool0}
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(HEAD + ARM, "utf-8")
    return path


def test_it_prints_the_section(arm: Path):
    done = linkforge("collisions", arm.name, cwd=arm.parent)
    assert done.returncode == 0
    assert done.stdout == "disabled_collisions:\n  base: {arm: Adjacent, hand: Never}\n  arm: {hand: Adjacent}\n"
    assert done.stderr == "3 pairs need no check (2 Adjacent, 1 Never), 0 do\n"


def test_the_section_can_be_pasted(arm: Path):
    section = linkforge("collisions", arm.name, cwd=arm.parent).stdout
    pasted = "semantic:\n" + "".join(f"  {line}\n" for line in section.splitlines())
    arm.write_text(HEAD + ARM + pasted, "utf-8")
    assert linkforge("check", "--werror", arm.name, cwd=arm.parent).returncode == 0
    assert linkforge("collisions", arm.name, cwd=arm.parent).stdout == section


def test_json_has_the_settings_and_all_pairs(arm: Path):
    words = ("collisions", arm.name, "--json", "--samples", "10", "--seed", "7", "--quiet")
    done = linkforge(*words, cwd=arm.parent)
    assert done.stderr == ""
    assert json.loads(done.stdout) == {
        "samples": 10,
        "seed": 7,
        "disabled": [
            {"link1": "base", "link2": "arm", "reason": "Adjacent"},
            {"link1": "base", "link2": "hand", "reason": "Never"},
            {"link1": "arm", "link2": "hand", "reason": "Adjacent"},
        ],
        "checked": [],
    }


def test_a_robot_without_shapes_has_no_pairs(tmp_path: Path):
    (tmp_path / "robot.robot.yaml").write_text(f"{HEAD}links: {{base: }}\n", "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "disabled_collisions: {}\n")


def test_a_missing_mesh_is_an_error_at_its_place(tmp_path: Path):
    link = "  hand: {collision: {mesh: package://hand_description/hand.stl}}\n"
    (tmp_path / "robot.robot.yaml").write_text(f"{HEAD}links:\n{link}", "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", "--color", "never", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert (
        "robot.robot.yaml:4:28: error: the mesh 'package://hand_description/hand.stl' of a collision cannot be opened, "
        "so its link cannot be sampled: package 'hand_description' is not found; specify its folder with "
        "`--package hand_description=FOLDER` [LF7701]" in done.stderr
    )


def test_missing_meshes_of_a_package_are_one_error(tmp_path: Path):
    meshes = ("arm/base.stl", "arm/upper.stl", "tool/tool.stl", "arm/hand.stl")
    collisions = "".join(f"      - {{mesh: package://{mesh}}}\n" for mesh in meshes)
    (tmp_path / "robot.robot.yaml").write_text(f"{HEAD}links:\n  arm:\n    collision:\n{collisions}", "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.count("LF7701") == 2
    assert (
        "with `--package arm=FOLDER`; the same for 'package://arm/upper.stl' and 'package://arm/hand.stl'"
        in done.stderr
    )
    assert "with `--package tool=FOLDER` [LF7701]" in done.stderr


@pytest.mark.parametrize(
    ("content", "reason"),
    [("version https://git-lfs", "run 'git lfs pull'"), ("", "it is empty"), ("solid x\nendsolid x\n", "")],
)
def test_a_mesh_without_a_shape_is_an_error(content: str, reason: str, tmp_path: Path):
    (tmp_path / "robot.robot.yaml").write_text(f"{HEAD}links: {{hand: {{collision: {{mesh: a.stl}}}}}}\n", "utf-8")
    (tmp_path / "a.stl").write_text(content, "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert "LF7702" in done.stderr
    assert reason in done.stderr


def test_a_mesh_counts_with_its_real_shape_and_scale(tmp_path: Path):
    # A frame around a ball: the convex hull touches the ball, the frame does not.
    sides = [block(2, 0.1, 0.1, at=(0, side, 0)) for side in (-1, 1)]
    import trimesh

    (tmp_path / "frame.stl").write_bytes(trimesh.util.concatenate(sides).export(file_type="stl"))
    spec = """
links:
  base: {collision: {mesh: {file: frame.stl, scale: SCALE}}}
  post: {collision: {box: [0.1, 0.1, 0.1]}}
  ball: {collision: {sphere: 0.2}}
joints:
  post: {type: fixed, parent: base, child: post, origin: [0, 0, 9]}
  ball: {type: fixed, parent: post, child: ball, origin: [0, 0, -9]}
"""
    for scale, reason in (("1", "Never"), ("0.2", "Default")):
        (tmp_path / "robot.robot.yaml").write_text(HEAD + spec.replace("SCALE", scale), "utf-8")
        done = linkforge("collisions", "robot.robot.yaml", cwd=tmp_path)
        assert f"base: {{post: Adjacent, ball: {reason}}}" in done.stdout


FOLDED = """
links:
  base: {collision: {sphere: 0.1}}
  arm: {collision: {sphere: 0.1}}
  hand: {collision: {sphere: 0.1, origin: [0, 0, -1]}}
  thumb: {collision: {sphere: 0.1, origin: [0, 0, -1]}}
joints:
  shoulder: {type: fixed, parent: base, child: arm, origin: [0, 0, 1]}
  elbow: {type: continuous, parent: arm, child: hand, axis: x}
  knuckle: {type: continuous, parent: arm, child: thumb, axis: y}
"""


def test_pairs_that_only_the_default_pose_disables_are_noted_once(tmp_path: Path):
    path = tmp_path / "folded.robot.yaml"
    path.write_text(HEAD + FOLDED, "utf-8")
    done = linkforge("collisions", path.name, cwd=tmp_path)
    assert "base: {arm: Adjacent, hand: Default, thumb: Default}" in done.stdout
    assert (
        "folded.robot.yaml:2:7: note: base and hand collide in the default pose, but rarely in other "
        "poses; list them in 'enabled_collisions' to keep checking them" in done.stderr
    )
    assert done.stderr.count("LF7703") == 1
    assert "inserted here" not in done.stderr


def test_a_declared_pair_that_only_the_default_pose_disables_is_noted_at_its_place(tmp_path: Path):
    path = tmp_path / "folded.robot.yaml"
    pairs = "semantic:\n  disabled_collisions:\n    base: {hand: Default}\n"
    path.write_text(HEAD + FOLDED + pairs, "utf-8")
    done = linkforge("collisions", path.name, cwd=tmp_path)
    line = len((HEAD + FOLDED + pairs).splitlines())
    assert f"folded.robot.yaml:{line}:12: note: base and hand collide in the default pose" in done.stderr


def test_enabled_pairs_are_not_disabled(tmp_path: Path):
    path = tmp_path / "folded.robot.yaml"
    enabled = (
        "semantic: {enabled_collisions: {thumb: {base: User, hand: }}, disabled_collisions: {hand: {base: User}}}\n"
    )
    path.write_text(HEAD + FOLDED + enabled, "utf-8")
    done = linkforge("collisions", path.name, cwd=tmp_path)
    assert done.stdout == (
        "disabled_collisions:\n  base: {arm: Adjacent, hand: User}\n  arm: {hand: Adjacent, thumb: Adjacent}\n"
    )
    assert done.stderr.endswith("4 pairs need no check (3 Adjacent, 1 User), 2 do\n")


@pytest.mark.parametrize("word", ["0", "-1", "1e3"])
def test_samples_are_a_whole_number(word: str, arm: Path):
    done = linkforge("collisions", arm.name, "--samples", word, cwd=arm.parent)
    assert done.returncode == 2
    assert "takes a whole number from 1 to " in done.stderr
    assert f", found '{word}'" in done.stderr


def test_a_seed_is_not_negative(arm: Path):
    done = linkforge("collisions", arm.name, "--seed", "-1", cwd=arm.parent)
    assert done.returncode == 2
    assert "takes a whole number from 0 to 18446744073709551615, found '-1'" in done.stderr


def test_missing_libraries_are_named_with_the_way_to_install_them(arm: Path, monkeypatch: pytest.MonkeyPatch):
    from importlib import util

    find_spec = util.find_spec
    monkeypatch.setattr(util, "find_spec", lambda name: None if name == "coal" else find_spec(name))
    done = linkforge("collisions", arm.name, cwd=arm.parent)
    assert done.returncode == 2
    assert "there is no Python package coal; run: pip install 'linkforge-compile[collisions]'" in done.stderr


@pytest.mark.parametrize("option", ["--samples", "--jobs"])
@pytest.mark.parametrize("zeros", [12, 400, 5000])
def test_a_count_has_a_bound(option: str, zeros: int, tmp_path: Path):
    done = linkforge("collisions", "robot.robot.yaml", option, "1" + "0" * zeros, cwd=tmp_path)
    assert done.returncode == 2
    assert f"argument {option}: takes a whole number from 1 to " in done.stderr
