"""What is offered of a workspace's specs is each of them once, as a file names it, however the offers are shared."""

import posixpath
from collections.abc import Iterator, Mapping

import pytest

from linkforge_compile.editor.completions import SpecPaths
from linkforge_compile.schema.json_schema import Json, mapping

SPECS = [
    *(f"robots/arm{number}.robot.yaml" for number in range(11)),
    *("cell.robot.yaml", "robots.robot.yaml", "robots/parts/hand.robot.yaml", "robots/parts/deep/er/tip.robot.yaml"),
    *(f"vendors/v{number}/robots/arm.robot.yaml" for number in range(7)),
]
FOLDERS = ["", "robots", "robots/parts", "robots/parts/deep/er", "vendors/v3/robots", "somewhere/else"]


def found(offer: Json, made: Mapping[str, Json], key: str) -> Iterator[Json]:
    """Yield the values of a key in all completions."""
    schema = mapping(offer)
    if "$ref" in schema:
        yield from found(made.get(str(schema["$ref"]).removeprefix("#/definitions/"), {}), made, key)
    parts = schema.get("allOf", [])
    for part in parts if isinstance(parts, list) else []:
        yield from found(part, made, key)
    if key in schema:
        yield schema[key]


@pytest.mark.parametrize("folder", FOLDERS)
@pytest.mark.parametrize("left_out", [(), ("robots/arm4.robot.yaml",), ("cell.robot.yaml", "robots/arm0.robot.yaml")])
def test_every_path_is_offered_once_and_no_other(folder: str, left_out: tuple[str, ...]):
    paths = SpecPaths({spec: {} for spec in SPECS})
    for other in FOLDERS:  # whose definitions are shared
        paths.paths_from(other, ())
    offered = [
        mapping(snippet)["label"]
        for snippets in found(paths.paths_from(folder, left_out), paths.definitions, "defaultSnippets")
        for snippet in (snippets if isinstance(snippets, list) else [])
    ]
    wanted = [posixpath.relpath(spec, folder or ".") for spec in SPECS if spec not in left_out]
    assert sorted(map(str, offered)) == sorted(wanted)


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_path_leads_to_the_offer_of_its_spec(folder: str):
    paths = SpecPaths({spec: {"title": spec} for spec in SPECS})
    offers = paths.entries_from(folder)
    leads = {
        str(mapping(mapping(mapping(condition)["properties"])["use"])["const"])
        for condition in found({"allOf": offers}, paths.definitions, "if")
    }
    assert leads >= {posixpath.relpath(spec, folder or ".") for spec in SPECS}


def test_nothing_is_offered_where_there_is_nothing_else():
    assert SpecPaths({"arm.robot.yaml": {}}).paths_from("", ("arm.robot.yaml",)) == {}
