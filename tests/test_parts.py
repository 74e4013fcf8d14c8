"""The catalogue of parts: complete, with sources, with frames as REP 103 has them, and as its README says."""

import re
import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from linkforge_compile import Robot, compile_file, render_urdf
from tests.conftest import ROOT
from tests.consumers import pinocchio_model

PARTS = ROOT / "examples" / "parts"
CATALOGUE: dict[str, str] = yaml.safe_load((PARTS / "catalogue.yaml").read_text("utf-8"))
README = (PARTS / "README.md").read_text("utf-8")
GRAMS = {"g": 1e-3, "kg": 1.0}


def spec_of(part: str) -> Path:
    return PARTS / f"{part}.robot.yaml"


@cache
def compiled(part: str) -> Robot:
    return compile_file(spec_of(part)).result()


def test_the_catalogue_has_every_part_under_its_name():
    assert {spec.name.removesuffix(".robot.yaml") for spec in PARTS.glob("*.robot.yaml")} == set(CATALOGUE)
    for part, file in CATALOGUE.items():
        assert file == f"package://linkforge_examples/parts/{part}.robot.yaml"
        assert compiled(part).name == part


@pytest.mark.parametrize("part", CATALOGUE)
def test_a_part_names_its_sources(part: str):
    text = spec_of(part).read_text("utf-8")
    head, _, body = text.partition("linkforge: 1\n")
    sources = set(re.findall(r"^# (\[\d\]) \w", head, re.MULTILINE))
    assert sources
    assert sources == set(re.findall(r"\[\d\](?=[^\n]*$)", "\n".join(re.findall("#.*", body)), re.MULTILINE))
    for line in body.splitlines():
        if re.search(r"\b(mass|range_max|horizontal_fov|origin: \[\d|default): ?[{\d]", line):
            assert re.search(r"# .*(\[\d\]|derived|estimated|chosen)", line), line


@pytest.mark.parametrize("part", CATALOGUE)
def test_the_readme_has_the_mass_and_the_frames_of_a_part(part: str):
    robot = compiled(part)
    row = re.search(rf"^\| `{part}` \|.*$", README, re.MULTILINE)
    assert row
    number, unit = re.findall(r"\| ([\d.]+) (k?g) \|", row[0])[0]
    assert float(number) * GRAMS[unit] == pytest.approx(robot.total_mass)
    frames = [link.name for link in robot.links if not link.visuals and link.name != "world"]
    assert re.findall(r"`(\w+)`", row[0]) == [part, *frames]


@pytest.mark.parametrize("has_clone_inside", [True, False])
def test_the_snippet_of_the_readme_works_outside_of_the_examples(has_clone_inside: bool, tmp_path: Path):
    snippet = re.findall(r"^```yaml\n(.*?)^```", README, re.MULTILINE | re.DOTALL)[0]
    declared = re.findall(r"^packages: .*\n", snippet)[0]
    clone = (tmp_path / "robot" if has_clone_inside else tmp_path) / "linkforge" / "examples"
    shutil.copytree(PARTS, clone / "parts")
    shutil.copy(PARTS.parent / "package.xml", clone)
    spec = tmp_path / "robot" / "mine.robot.yaml"
    spec.parent.mkdir(exist_ok=True)
    text = snippet if has_clone_inside else snippet.replace(declared, "")
    spec.write_text(f"linkforge: 1\nname: mine\nlinks: {{base_link: {{}}}}\n{text}", "utf-8")
    robot = compile_file(spec, packages={} if has_clone_inside else {"linkforge_examples": clone}).result()
    assert {"front_lidar_link", "head_camera_link"} <= {link.name for link in robot.links}


@pytest.mark.parametrize("part", ["realsense_d435", "orbbec_femto_bolt"])
def test_a_camera_has_optical_frames_with_z_forward_and_x_right(part: str):
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio_model(render_urdf(compiled(part)))
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    for sensor in compiled(part).sensors:
        body, optical = (
            data.oMf[model.getFrameId(name)].rotation for name in (sensor.link_name, f"{sensor.name}_optical_frame")
        )
        assert optical @ [0, 0, 1] == pytest.approx(body @ [1, 0, 0])  # along which Gazebo's camera looks
        assert optical @ [1, 0, 0] == pytest.approx(body @ [0, -1, 0])
        assert np.degrees(np.arccos((body @ [1, 0, 0])[0])) < 7  # forward, but for the Femto Bolt's 6 deg


@pytest.mark.parametrize(("part", "mass"), [("extrusion_2020", 0.2), ("extrusion_4040", 0.692)])
def test_an_extrusion_has_the_mass_of_its_length(part: str, mass: float):
    robot = compile_file(spec_of(part), parameters={"length": 0.4}).result()
    assert robot.total_mass == pytest.approx(mass)
    assert next(joint for joint in robot.joints if joint.child == "end").origin.xyz.z == pytest.approx(0.4)
