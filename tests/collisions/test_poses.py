"""`linkforge collisions --pose`: what collides in the named states of groups."""

import json
import subprocess
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.collisions.sampled import HEAD
from tests.importers.robots import EXAMPLES

pin = pytest.importorskip("pinocchio")

PANDA = EXAMPLES / "panda_description"

BALLS = """
links:
  base: {collision: {sphere: 0.1}}
  arm: {collision: {sphere: 0.1, origin: [1, 0, 0]}}
  hand: {collision: {sphere: 0.1, origin: [2, 0, 0]}}
joints:
  turn: {type: fixed, parent: base, child: arm}
  slide: {type: prismatic, parent: arm, child: hand, axis: x, limits: {lower: -3, upper: 3, effort: 1, velocity: 1}}
semantic:
  groups: {arm: {joints: [slide]}}
  group_states: {arm: {away: {slide: 0}, near: {slide: -0.85}, home: {slide: -1.99}}}
  disabled_collisions: {arm: {hand: Never}}
"""


def poses(folder: Path, spec: str, *states: str) -> subprocess.CompletedProcess[str]:
    (folder / "robot.robot.yaml").write_text(HEAD + spec, "utf-8")
    options = [word for state in states for word in ("--pose", state)]
    return linkforge("collisions", "robot.robot.yaml", *options, "--quiet", cwd=folder)


def test_a_pair_that_planners_check_fails_and_a_disabled_one_is_listed(tmp_path: Path):
    done = poses(tmp_path, BALLS, "arm/away", "arm/near", "arm/home")
    assert done.returncode == 1
    assert done.stdout == (
        "arm/away: no pairs in collision\n"
        "arm/near: no pairs in collision, and 1 disabled\n"
        "  arm hand 50 mm (disabled: Never)\n"
        "arm/home: 1 pair in collision\n"
        "  base hand 190 mm\n"
    )
    assert poses(tmp_path, BALLS, "arm/away", "arm/near").returncode == 0


def test_a_link_without_default_collisions_is_checked_against_the_enabled_ones(tmp_path: Path):
    off = BALLS + "  no_default_collision_links: [hand]\n"
    done = poses(tmp_path, off, "arm/home")
    assert (done.returncode, done.stdout.splitlines()[1]) == (0, "  base hand 190 mm (disabled: no default collisions)")
    assert poses(tmp_path, off + "  enabled_collisions: {hand: {base: }}\n", "arm/home").returncode == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--pose", "arm/hme"), "the robot has no state 'arm/hme'; did you mean 'arm/home'?"),
        (("--pose", "x"), "has no state 'x'; there are 'arm/away', 'arm/near' and 'arm/home'"),
        (("--pose", "arm/home", "--write"), "so --write is not allowed with it"),
        (("--pose", "arm/home", "--samples", "10000"), "so --samples is not allowed with it"),
        (("--pose", "arm/home", "--seed", "0"), "so --seed is not allowed with it"),
        (("--pose", "arm/home", "--jobs", "1"), "so --jobs is not allowed with it"),
        (("--pose", "arm/home", "--all"), "so --all is not allowed with it"),
        (("robot.robot.yaml", "--pose", "arm/home"), "takes one spec, found 2"),
    ],
)
def test_wrong_usage_is_reported(words: tuple[str, ...], message: str, tmp_path: Path):
    (tmp_path / "robot.robot.yaml").write_text(HEAD + BALLS, "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr


@pytest.mark.parametrize(
    ("joint", "near", "away"),
    [
        ("{type: floating, parent: base, child: ball}", "[0.75, 0, 0, 0, 0, 0, 1]", "[0, 1, 0, 0, 0, 0, 1]"),
        # MoveIt normalizes quaternions; this one is a half turn about z.
        (
            "{type: floating, parent: base, child: ball, origin: {rpy: [0, 0, 90 deg]}}",
            "[0.1, -0.85, 0, 0, 0, 2, 0]",
            "[0.1, 0.85, 0, 0, 0, 2, 0]",
        ),
        ("{type: planar, parent: base, child: ball, axis: z}", "[0.95, 0, 3.14159]", "[0.95, 0.5, 0]"),
    ],
)
def test_links_below_planar_and_floating_joints_are_where_the_state_has_them(
    joint: str, near: str, away: str, tmp_path: Path
):
    spec = (
        "links:\n  base: {collision: {sphere: 0.1, origin: [1, 0, 0]}}\n"
        "  ball: {collision: {sphere: 0.1, origin: [0.1, 0, 0]}}\n"
        f"joints: {{free: {joint}}}\n"
        "semantic: {groups: {g: {joints: [free]}}, "
        f"group_states: {{g: {{near: {{free: {near}}}, away: {{free: {away}}}}}}}}}\n"
    )
    done = poses(tmp_path, spec, "g/near", "g/away")
    assert done.stdout == "g/near: 1 pair in collision\n  base ball 50 mm\ng/away: no pairs in collision\n"
    assert done.returncode == 1


def test_links_that_only_touch_do_not_collide(tmp_path: Path):
    touching = BALLS.replace("near: {slide: -0.85}", "near: {slide: -0.80000000000001}")
    done = poses(tmp_path, touching, "arm/near")
    assert (done.returncode, done.stdout) == (0, "arm/near: no pairs in collision\n")


def test_json_has_the_collisions_of_each_state_and_one_document_of_diagnostics(tmp_path: Path):
    (tmp_path / "robot.robot.yaml").write_text(HEAD + BALLS, "utf-8")
    options = ("--pose", "arm/away", "--pose", "arm/near", "--json", "--diagnostics", "json")
    done = linkforge("collisions", "robot.robot.yaml", *options, cwd=tmp_path)
    away, near = json.loads(done.stdout)
    assert (done.returncode, away) == (0, {"state": "arm/away", "collisions": []})
    assert near["collisions"][0].pop("depth") == pytest.approx(0.05)
    assert near == {"state": "arm/near", "collisions": [{"link1": "arm", "link2": "hand", "disabled": "Never"}]}
    json.loads(done.stderr)


FOLDED = {"panda_joint1": 0.0, "panda_joint2": 1.7, "panda_joint4": -3.0, "panda_joint6": 0.1}


@pytest.mark.skipif(not PANDA.is_dir(), reason="example-robot-data is not installed")
def test_states_of_the_panda_collide_as_pinocchio_finds(tmp_path: Path):
    below = "package://example-robot-data/robots/panda_description"
    values = ", ".join(f"{joint}: {value}" for joint, value in FOLDED.items())
    spec = (
        f"packages: {{example-robot-data: {EXAMPLES.parent}}}\n"
        f"modules: {{panda: {{use: {below}/urdf/panda.urdf, srdf: {below}/srdf/panda.srdf, prefix: ''}}}}\n"
        f"semantic: {{group_states: {{arm: {{folded: {{{values}}}}}}}}}\n"
    )
    (tmp_path / "panda.robot.yaml").write_text(f"linkforge: 1\nname: panda\n{spec}", "utf-8")
    options = ("--package", f"example-robot-data={EXAMPLES.parent}", "--quiet")
    words = ("collisions", "panda.robot.yaml", *options, "--pose")
    ready = linkforge(*words, "arm_and_hand/default", cwd=tmp_path)
    assert (ready.returncode, ready.stdout.partition(",")[0]) == (0, "arm_and_hand/default: no pairs in collision")
    folded = linkforge(*words, "arm/folded", cwd=tmp_path)
    assert folded.returncode == 1
    found = {frozenset(line.split()[:2]) for line in folded.stdout.splitlines()[1:] if "disabled" not in line}
    assert found == colliding_in_pinocchio(FOLDED)


def colliding_in_pinocchio(positions: dict[str, float]) -> set[frozenset[str]]:
    """Return the pairs of links that collide and that the SRDF does not disable."""
    urdf, srdf = str(PANDA / "urdf" / "panda.urdf"), str(PANDA / "srdf" / "panda.srdf")
    model = pin.buildModelFromUrdf(urdf)
    shapes = pin.buildGeomFromUrdf(model, urdf, pin.GeometryType.COLLISION, package_dirs=[str(EXAMPLES.parents[1])])
    shapes.addAllCollisionPairs()
    pin.removeCollisionPairs(model, shapes, srdf)
    q = pin.neutral(model)
    for joint in range(1, model.njoints):
        lower, upper = (limit[model.idx_qs[joint]] for limit in (model.lowerPositionLimit, model.upperPositionLimit))
        default = 0.0 if lower <= 0 <= upper else (lower + upper) / 2
        q[model.idx_qs[joint]] = positions.get(model.names[joint], default)
    data = shapes.createData()
    pin.computeCollisions(model, model.createData(), shapes, data, q, False)
    pairs = zip(shapes.collisionPairs, data.collisionResults, strict=True)

    def link(number: int) -> str:
        return model.frames[shapes.geometryObjects[number].parentFrame].name

    return {frozenset((link(pair.first), link(pair.second))) for pair, result in pairs if result.isCollision()}


def test_a_state_without_its_group_is_that_of_every_group(tmp_path: Path):
    spec = BALLS.replace("groups: {arm: {joints: [slide]}}", "groups: {arm: {joints: [slide]}, all: {joints: [slide]}}")
    spec = spec.replace("group_states: {", "group_states: {all: {away: {slide: 1}}, ")
    done = poses(tmp_path, spec, "away")
    assert (done.returncode, done.stdout) == (
        0,
        "all/away: no pairs in collision\narm/away: no pairs in collision\n",
    ), done.stderr
