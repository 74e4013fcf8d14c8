"""Every schema that is written for an editor is valid: by its metaschema, and each reference leads to a definition."""

import json
from collections.abc import Iterator
from pathlib import Path

import jsonschema_rs
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.editor import Vocabulary, workspace_text
from linkforge_compile.editor.bundle import bundle_text
from linkforge_compile.editor.vocabulary import UsedFile
from linkforge_compile.listing import ListedParameter
from linkforge_compile.schema.registry import IDENTIFIER, linked_schema_text
from tests.cli.in_process import linkforge

DRAFT_07 = "http://json-schema.org/draft-07/schema#"

FOLDERS = st.sampled_from(["", "arms/", "arms/left/", "cells/", "cells/cell 1/", "parts/ä%b/", "../far/"])
FILES = st.builds("{}{}{}".format, FOLDERS, st.sampled_from("abc"), st.sampled_from([".robot.yaml", ".yaml"]))
NAMES = st.one_of(st.sampled_from(["base", "007", "$ref", "a b", "a/b", "allOf"]), st.text(min_size=1, max_size=4))
VALUES = st.one_of(st.none(), st.booleans(), st.integers(), st.text(max_size=4), st.lists(st.integers(), max_size=3))
PARAMETERS = st.lists(
    st.builds(
        ListedParameter,
        name=NAMES,
        type=st.sampled_from([None, "length", "boolean", "string", "vector"]),
        unit=st.sampled_from([None, "m"]),
        default=st.one_of(st.none(), st.text(max_size=4)),
        value=VALUES,
        minimum=st.one_of(st.none(), st.integers()),
        maximum=st.none(),
        pattern=st.none(),
        choices=st.one_of(st.none(), st.lists(st.one_of(st.integers(), st.text(max_size=3)), max_size=2)),
        description=st.text(max_size=4),
    ),
    max_size=2,
).map(tuple)


def named(keys: st.SearchStrategy[str]) -> st.SearchStrategy[dict[str, tuple[str, ...]]]:
    return st.dictionaries(keys, st.lists(NAMES, max_size=2, unique=True).map(tuple), max_size=2)


SECTIONS = named(st.sampled_from(["links", "joints", "materials", "modules"]))
SEMANTIC = named(st.sampled_from(["groups", "end_effectors"]))
ENTRIES = st.builds(lambda own, semantic: {**own, "semantic": semantic}, SECTIONS, SEMANTIC)

VOCABULARIES = st.builds(
    Vocabulary,
    files=st.lists(FILES, min_size=1, max_size=3, unique=True).map(tuple),
    names=named(st.sampled_from(["link", "joint", "material", "group"])),
    parameters=PARAMETERS,
    used=st.dictionaries(
        FILES, st.builds(UsedFile, PARAMETERS, ENTRIES, st.dictionaries(NAMES, PARAMETERS, max_size=2)), max_size=2
    ),
    entries=ENTRIES,
)


def check(text: str) -> None:
    schema = {"$schema": DRAFT_07, **json.loads(text)}
    jsonschema_rs.meta.validate(schema)
    targets = {target.removeprefix(IDENTIFIER) for target in references_in(schema)}
    assert targets <= {f"#/definitions/{name}" for name in schema["definitions"]}


def references_in(node: object) -> Iterator[str]:
    if isinstance(node, list):
        for item in node:
            yield from references_in(item)
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "$ref" and isinstance(value, str):
                yield value
            yield from references_in(value)


def test_the_schema_of_the_language_is_valid():
    check(bundle_text())
    check(linked_schema_text())


@given(st.lists(VOCABULARIES, max_size=4, unique_by=lambda one: one.files[0]))
def test_the_schema_of_any_workspace_is_valid(vocabularies: list[Vocabulary]):
    check(workspace_text(vocabularies))


ROBOT = "linkforge: 1\nname: arm\nlinks: {base: }\n"

LAYOUTS = {
    "a part in a folder without a spec": {
        "arm.robot.yaml": f"{ROBOT}include: [parts/palette.yaml]\n",
        "parts/palette.yaml": "linkforge: 1\n",
    },
    "a part in a folder below one without a spec": {
        "robots/arm.robot.yaml": f"{ROBOT}include: [../parts/colors/palette.yaml]\n",
        "parts/colors/palette.yaml": "linkforge: 1\n",
    },
    "two parts that include each other": {
        "a.robot.yaml": "linkforge: 1\ninclude: [b.robot.yaml]\n",
        "b.robot.yaml": "linkforge: 1\ninclude: [a.robot.yaml]\n",
    },
}


@pytest.mark.parametrize("files", LAYOUTS.values(), ids=LAYOUTS)
def test_the_schema_that_the_command_writes_is_valid(tmp_path: Path, files: dict[str, str]):
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    assert linkforge("schema", "--workspace", cwd=tmp_path).returncode == 0
    check((tmp_path / ".linkforge/robot.schema.json").read_text("utf-8"))


def test_the_schema_of_a_new_robot_is_valid(tmp_path: Path):
    assert linkforge("init", "arm", cwd=tmp_path).returncode == 0
    check((tmp_path / "arm/.linkforge/robot.schema.json").read_text("utf-8"))
