"""Loads URDF with other programs: urdfdom, Pinocchio and MuJoCo."""

from __future__ import annotations

import os
import re
import subprocess
import sysconfig
from pathlib import Path

import pytest
from lxml import etree

from linkforge_compile.core import Robot
from linkforge_compile.formats import MJCF, Rendering

PREFIX = Path(sysconfig.get_path("purelib")) / "cmeel.prefix"


def check_urdf(text: str) -> str:
    """Return the root link that urdfdom's `check_urdf` finds; fail with its message if it rejects the text."""
    # Not available on Windows.
    if not (PREFIX / "bin" / "check_urdf").exists():
        pytest.skip("check_urdf is not installed; it comes with cmeel-urdfdom")
    libraries = {name: str(PREFIX / "lib") for name in ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH")}
    run = subprocess.run(
        [PREFIX / "bin" / "check_urdf", "/dev/stdin"],
        input=text,
        capture_output=True,
        encoding="utf-8",
        env=os.environ | libraries,
        timeout=60,
        check=False,
    )
    output = run.stdout + run.stderr
    root = re.search(r"^root Link: (\S+) has ", output, re.MULTILINE)
    assert run.returncode == 0, output
    assert "Error" not in output, output
    assert root, output
    return root[1]


def pinocchio_model(text: str, *, free_flyer: bool = False):
    """Return Pinocchio's model with a fixed base, or with a free-flyer root joint to include the root link's mass."""
    pinocchio = pytest.importorskip("pinocchio")
    if free_flyer:
        return pinocchio.buildModelFromXML(text, pinocchio.JointModelFreeFlyer())
    return pinocchio.buildModelFromXML(text)


def mujoco_model(text: str):
    """Return MuJoCo's model with a body for each link, also static ones, and boxes instead of meshes."""
    mujoco = pytest.importorskip("mujoco")
    robot = _with_boxes_for_meshes(etree.fromstring(text.encode()))
    options = etree.SubElement(robot, "mujoco")
    etree.SubElement(options, "compiler", fusestatic="false", discardvisual="false", strippath="false")
    return mujoco.MjModel.from_xml_string(etree.tostring(robot).decode())


def _with_boxes_for_meshes(robot: etree._Element) -> etree._Element:
    """Replace meshes, whose files the tests do not have; masses and joints do not depend on shapes."""
    for mesh in robot.iter("mesh"):
        mesh.tag = "box"
        mesh.attrib.clear()
        mesh.set("size", "0.01 0.01 0.01")
    for texture in list(robot.iter("texture")):
        texture.getparent().remove(texture)
    return robot


def mjcf_model(robot: Robot, **options: str):
    """Return MuJoCo's model of a robot's MJCF, without the meshes that are not on this machine."""
    mujoco = pytest.importorskip("mujoco")
    return mujoco.MjModel.from_xml_string(MJCF.render(robot, Rendering(options))[0].text)
