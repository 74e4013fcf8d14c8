"""A key without a value: the editor underlines what the language requires, and nothing that `check` accepts."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import reduce
from operator import getitem
from typing import Any

import jsonschema_rs
import pytest

from linkforge_compile import Severity, compile_text
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.editor.bundle import bundle
from linkforge_compile.schema.registry import plain
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import read
from tests.conftest import ROOT
from tests.core.test_schemas import CLASSES, REQUIRED_OF_SOME, specs_at

BUNDLE = bundle()
EDITOR = jsonschema_rs.Draft7Validator(BUNDLE)
SPECS = sorted([*(ROOT / "examples").rglob("*.robot.yaml"), *(ROOT / "tests/cases/good").rglob("*.robot.yaml")])


def underlined(spec: object) -> list[str]:
    return [error.message for error in EDITOR.iter_errors(spec)]


def errors_of_check(text: str, folder: object = None) -> list[str]:
    found = compile_text(text, folder=folder).diagnostics
    return [one.message for one in found if one.severity is Severity.ERROR]


def keys_in(node: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the path of each key but of those in an object with `when`, which may be left out as a whole."""
    if isinstance(node, list):
        for position, item in enumerate(node):
            yield from keys_in(item, (*path, position))
    if isinstance(node, dict) and (not path or "when" not in node):
        for key, value in node.items():
            yield (*path, key)
            yield from keys_in(value, (*path, key))


@contextmanager
def emptied(spec: dict[str, Any], path: tuple[str | int, ...]) -> Iterator[dict[str, Any]]:
    """Leave the key at a path without a value for a while."""
    *way, key = path
    inner: Any = reduce(getitem, way, spec)
    value, inner[key] = inner[key], None
    yield spec
    inner[key] = value


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_value_that_the_editor_misses_is_one_that_check_misses(path: Any):
    tree = read(SourceFile(path.name, path.read_text("utf-8")), Diagnostics())
    assert tree is not None
    spec: Any = plain(tree)
    assert underlined(spec) == []
    # An empty key takes the value of `defaults`, and is worth a look of its author all the same.
    by_default = {key for given in spec.get("defaults", {}).values() for key in given}
    # One of the keys of all links, or of all joints, that are at the same place in it.
    keys = [key for key in keys_in(spec) if key[-1] not in by_default]
    places = {key[:1] + key[2:] if len(key) > 2 else key: key for key in keys}
    only_in_editor = []
    for key in places.values():
        with emptied(spec, key) as changed:
            if not EDITOR.is_valid(changed) and not errors_of_check(json.dumps(changed), path.parent):
                only_in_editor.append(key)
    assert only_in_editor == []


HEAD = "linkforge: 1\nname: arm\n"
ROBOT = f"{HEAD}links: {{base: , tip: }}\njoints: {{turn: {{type: continuous, axis: z, parent: base, child: tip}}}}\n"
ACCEPTED = {
    # What the robots above do not have.
    "a robot's texts": f"{ROBOT}description:\nversion:\nmetadata:\n",
    "a parameter": f"{ROBOT}parameters: {{x: {{type: , default: 3, enum: , minimum: , pattern: , description: }}}}\n",
    "a package": f"{ROBOT}packages: {{x: }}\n",
    "a variant's value": f"{ROBOT}parameters: {{x: 3}}\nvariants: {{fast: {{x: }}}}\n",
    "a variable": f"{ROBOT}variables: {{x: }}\n",
    "a joint's fields": f"{HEAD}links: {{base: , tip: }}\njoints:\n  weld:\n    type: fixed\n"
    "    parent: base\n    child: tip\n    axis:\n    origin:\n    when:\n    limits:\n    mimic:\n",
    "a position": f"{ROBOT}semantic: {{groups: {{g: {{joints: [turn]}}}}, group_states: {{g: {{up: {{turn: }}}}}}}}\n",
    "a reason": f"{ROBOT}semantic: {{disabled_collisions: {{base: {{tip: {{reason: }}}}}}}}\n",
    "a plugin's parameter": f"{ROBOT}gazebo: {{plugins: {{p: {{filename: f, parameters: {{a: }}}}}}}}\n",
    "an interface": f"{ROBOT}ros2_control:\n  arm:\n    hardware_plugin: p\n    parameters: {{a: }}\n"
    "    joints: {turn: {state_interfaces: , command_interfaces: {position: {min: , initial_value: }}}}\n",
}


@pytest.mark.parametrize("spec", ACCEPTED.values(), ids=ACCEPTED)
def test_what_check_accepts_is_not_underlined(spec: str):
    assert errors_of_check(spec) == []
    tree = read(SourceFile("arm.robot.yaml", spec), Diagnostics())
    assert tree is not None
    assert underlined(plain(tree)) == []


FIELDS = [
    (place, spec.key, bool(spec.example))
    for place in CLASSES
    for spec in specs_at(place)
    if spec.key not in REQUIRED_OF_SOME.get(place, set()) and (place, spec.key) != ("gazebo", "reference")
]


@pytest.mark.parametrize(("place", "key", "is_required"), FIELDS, ids=str)
def test_the_fields_that_a_class_requires_may_not_be_empty(place: str, key: str, is_required: bool):
    file, _, name = place.partition("#")
    definition = BUNDLE["definitions"][name or file]
    forms = [form for form in (definition, *definition.get("anyOf", ())) if "properties" in form]
    field = {**forms[0]["properties"][key], "definitions": BUNDLE["definitions"]}
    assert jsonschema_rs.Draft7Validator(field).is_valid(None) is not is_required
