"""docs/templates.md, the example that it shows and what that makes are the same."""

import re
from contextlib import chdir
from pathlib import Path

import pytest
import yaml

from linkforge_compile import compile_file, render_templates, render_urdf
from linkforge_compile.cli.main import main
from tests.conftest import ROOT
from tests.consumers import check_urdf

PAGE = (ROOT / "docs" / "templates.md").read_text("utf-8")
EXAMPLE = ROOT / "examples" / "12_own_templates"
SPEC = ROOT / "examples" / "01_two_link_arm" / "two_link_arm.robot.yaml"
SHOWN = dict(re.findall(r"```\w+ file=(\S+)\n(.*?)```", PAGE, re.DOTALL))


def test_the_page_shows_the_files_of_the_example():
    assert {"templates/joints.md.j2", "joints.md", "joint_limits.yaml", "collisions/urdf/link.xml.j2"} <= set(SHOWN)
    for name, text in SHOWN.items():
        assert (EXAMPLE / name).read_text("utf-8") == text, name


@pytest.mark.parametrize(
    ("templates", "outputs"),
    [("templates", ["joint_limits.yaml", "joints.md"]), ("collisions", ["two_link_arm.urdf"])],
)
def test_the_templates_make_the_committed_files(
    templates: str, outputs: list[str], tmp_path: Path, update_golden: bool
):
    folder = EXAMPLE if update_golden else tmp_path
    with chdir(EXAMPLE):
        assert main(["compile", str(SPEC), "--template", templates, "-o", str(folder)]) == 0
    for name in outputs:
        assert (folder / name).read_bytes() == (EXAMPLE / name).read_bytes()


def test_the_documents_say_what_the_robot_has():
    robot = compile_file(SPEC).result()
    texts = render_templates(robot, EXAMPLE / "templates")
    limits = yaml.safe_load(texts["joint_limits.yaml"])["joint_limits"]
    moving = {joint.name: joint.limits for joint in robot.joints if joint.limits}
    assert {name: entry["max_velocity"] for name, entry in limits.items()} == {
        name: one.velocity for name, one in moving.items()
    }
    assert all(isinstance(entry["max_velocity"], float) for entry in limits.values())
    assert all(f"\n| {name} | " in texts["joints.md"] for name in moving)


def test_readers_take_the_urdf_of_collisions():
    robot = compile_file(SPEC).result()
    urdf = render_urdf(robot, templates=EXAMPLE / "collisions")
    assert check_urdf(urdf) == robot.root_link.name
    assert "<visual" not in urdf


def test_the_names_and_filters_of_the_page_are_those_that_there_are():
    from linkforge_compile.formats import FORMATS
    from linkforge_compile.formats.environment import FILTERS

    named, filters = (
        set(re.findall(r"^\| `(\w+)` \|", PAGE.partition(head)[2].partition("\n\n")[0], re.MULTILINE))
        for head in ("| name |", "| filter |")
    )
    assert named == {"robot", "banner", *(one.name for one in FORMATS)}
    assert filters == set(FILTERS)


def test_the_fields_of_the_page_are_those_that_there_are():
    robot = compile_file(SPEC).result()
    parts = {"`robot`": robot, "a link": robot.links[0], "a joint": robot.joints[0]}
    for kind, part in parts.items():
        table = PAGE.partition(f"| field of {kind} |")[2].partition("\n\n")[0]
        fields = [name for row in table.split("\n")[2:] for name in re.findall(r"`(\w+)`", row.split("|")[1])]
        assert len(fields) > 2
        assert all(hasattr(part, name) for name in fields), kind
    methods = re.findall(r"`((?:get|has)_\w+)`", PAGE.partition("Methods of the robot")[2].partition("\n\n")[0])
    assert all(hasattr(robot, name) or hasattr(robot.graph, name) for name in methods)
