"""The one schema file for editors."""

import json
import re
import subprocess
import sys

import pytest
from jsonschema import Draft7Validator

from linkforge_compile.editor.bundle import bundle, bundle_text

SPEC = {
    "linkforge": 1,
    "name": "arm",
    "parameters": {"reach": {"type": "length", "default": "0.8 m"}, "payload": 2.5, "sides": ["left", "right"]},
    "variables": {"half": "$(reach / 2)"},
    "links": {
        "base": {"visual": [{"box": [1, "$(half)", "25 mm"], "material": "steel"}], "collision": "visual"},
        "arm": {"visual": {"mesh": "arm.stl", "origin": [0, 0, 1]}, "inertial": {"mass": "$(payload)"}},
        "tool0": None,
    },
    "joints": {"shoulder": {"type": "revolute", "axis": "-y", "limits": "$(limits)", "origin": {"rpy": [0, 1, 2]}}},
    "modules": {"hand": {"use": "hand.robot.yaml", "parent": "tool0", "joint": {"name": "wrist", "type": "fixed"}}},
    "semantic": {
        "groups": {"arm": {"chain": {"base_link": "base", "tip_link": "tool0"}}},
        "group_states": {"arm": {"home": {"shoulder": "90 deg", "free": [0, 1], "hand": "open"}}},
        "disabled_collisions": {"base": {"arm": "Adjacent", "tool0": None}},
    },
    "x-anchors": {"anything": [1, None]},
}


def test_the_bundle_needs_no_other_file():
    references = re.findall(r'"\$ref": "([^"]*)"', bundle_text())
    assert references
    assert {f"#/definitions/{name}" for name in bundle()["definitions"]} >= set(references)


def test_the_bundle_is_a_schema_that_accepts_a_robot_in_any_tool():
    Draft7Validator.check_schema(bundle())
    assert [error.message for error in Draft7Validator(bundle()).iter_errors(SPEC)] == []


def test_the_bundle_refuses_what_the_language_has_not():
    wrong = SPEC | {"links": {"base": {"visuals": {}}}}
    assert [list(error.path) for error in Draft7Validator(bundle()).iter_errors(wrong)] == [["links", "base"]]


def test_the_bundle_names_its_version_and_the_draft():
    assert json.loads(bundle_text()) == bundle()
    assert bundle()["$schema"] == "http://json-schema.org/draft-07/schema#"
    assert "/v1/" in bundle()["$id"]


def test_the_bundle_is_the_same_bytes_in_every_process():
    write = "sys.stdout.buffer.write(bundle_text().encode())"
    command = f"import sys; from linkforge_compile.editor.bundle import bundle_text; {write}"
    for seed in ("1", "2"):
        run = subprocess.run(
            [sys.executable, "-c", command], capture_output=True, check=True, env={"PYTHONHASHSEED": seed}, timeout=60
        )
        assert run.stdout.decode() == bundle_text()


def reported(**sections: object) -> list[list[object]]:
    """Where an editor sees a fault."""
    spec = {"linkforge": 1, "name": "arm", **sections}
    return [list(error.path) for error in Draft7Validator(bundle()).iter_errors(spec)]


SECTIONS = [
    key
    for key, part in bundle()["properties"].items()
    if "object" in str(part.get("type")) or part.get("$ref", "").endswith(("srdf", "defaults", "robot_gazebo_blocks"))
]


@pytest.mark.parametrize("section", SECTIONS)
def test_a_section_may_be_left_empty(section: str):
    assert reported(**{section: None}) == []


def test_what_holds_maps_may_be_left_empty_within_sections_too():
    empty = {"visual": None, "collision": None, "inertial": None, "physics": None}
    joint = {"type": "fixed", "limits": None, "dynamics": None, "origin": None}
    assert reported(parameters={"mode": {"type": "string", "enum": None}}) == []
    assert reported(links={"base": empty}, joints={"weld": joint}, semantic={"groups": None}, include=None) == []


def test_a_required_scalar_and_the_items_of_a_list_may_not_be_left_empty():
    assert reported(linkforge=None) == [["linkforge"]]
    assert reported(joints={"weld": {"parent": None}}) == [["joints", "weld", "parent"]]
    assert reported(include=[None]) == [["include", 0]]


def test_a_file_may_not_be_left_empty():
    assert not Draft7Validator(bundle()).is_valid(None)
