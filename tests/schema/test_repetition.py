"""Repetition and patches in the schema that editors get: in every object, although no schema file contains them."""

import pytest
from jsonschema import Draft7Validator

from linkforge_compile.editor.bundle import bundle
from linkforge_compile.schema.json_schema import PLAIN, WORDS
from linkforge_compile.schema.registry import definitions, load_files

EDITOR = Draft7Validator(bundle())
OBJECTS = {
    name: whole
    for name, whole in definitions().items()
    if "properties" in whole and whole.get("$comment") != PLAIN and name != "robot"
}


def faults(spec: dict[str, object]) -> list[str]:
    return [error.message for error in EDITOR.iter_errors({"linkforge": 1, "name": "arm", **spec})]


@pytest.mark.parametrize("name", OBJECTS)
def test_every_object_accepts_when(name: str):
    assert "when" in OBJECTS[name]["properties"]


@pytest.mark.parametrize("concept", load_files())
def test_no_schema_file_writes_the_words_itself(concept: str):
    properties = load_files()[concept].get("properties", {})
    assert not set(WORDS) & set(properties)


@pytest.mark.parametrize(
    "spec",
    [
        {"links": {"a_$(i)": {"for": {"i": 2}, "when": "$(x)", "visual": {"when": True, "box": "$(b)"}}}},
        {"links": {"a": {"visual": [{"for": {"i": [1, 2], "j": "$(n)"}, "sphere": 1}], "inertial": {"when": False}}}},
        {"joints": {"a": {"limits": {"when": "$(real)"}, "origin": {"when": "$(real)", "xyz": [0, 0, 1]}}}},
        {"semantic": {"passive_joints": [{"for": {"i": 2}, "value": "a_$(i)"}, "b"]}},
        {"semantic": {"disabled_collisions": {"a_$(i)": {"for": {"i": 2}, "value": {"b": "Never"}}}}},
        {"semantic": {"group_states": {"a": {"b": {"c": {"when": "$(x)", "value": "90 deg"}}}}}},
        {"defaults": {"when": "$(x)", "joint": {"limits": {"effort": 1}}, "visual": {"material": "steel"}}},
        {"mount": {"hip": {"type": "fixed", "child": "a"}}},
        {"modules": {"a": {"override": {"links": {"b": None, "c": {"visual": {"0": None, "1": {"sphere": 1}}}}}}}},
        {"modules": {"a": {"override": {"joints": {"b": {"limits": {"effort": None}, "axis": None, "origin": None}}}}}},
        {"modules": {"a": {"override": {"semantic": {"groups": {"g": {"joints": {"0": "b", "1": None}}}}}}}},
        {"modules": {"a": {"override": {"modules": {"b": {"override": {"links": {"c": None}}}}}}}},
    ],
    ids=str,
)
def test_the_editor_accepts_what_the_language_accepts(spec: dict[str, object]):
    assert faults(spec) == []


@pytest.mark.parametrize(
    "spec",
    [
        {"links": {"a": {"visual": {"box": {"for": {"i": 2}}}}}},
        {"joints": {"a": {"limits": {"for": {"i": 2}}}}},
        {"semantic": {"passive_joints": [{"for": {"i": 2}, "valeu": "a"}]}},
        {"joints": {"a": {"limits": {"effort": None}}}},
        {"modules": {"a": {"override": {"links": {"c": {"visual": {"first": None}}}}}}},
        {"modules": {"a": {"override": {"parameters": {"c": 1}}}}},
        {"defaults": {"module": {}}},
    ],
    ids=str,
)
def test_the_editor_refuses_what_the_language_has_not(spec: dict[str, object]):
    assert faults(spec)
