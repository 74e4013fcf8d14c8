"""The schema files: documented, closed, sound, and saying the shapes that editors complete well."""

import re
from collections.abc import Iterator

import pytest
import yaml
from jsonschema import Draft7Validator

from linkforge_compile.schema.json_schema import RAW, WORDS
from linkforge_compile.schema.registry import Schema, definitions, load_files
from linkforge_compile.units import Dimension, parse_quantity, units_of

WHOLE = definitions()


def schemas_in(node: object, path: str = "") -> Iterator[tuple[str, Schema]]:
    """Yield every object of a schema that holds keywords, with a path to find it by."""
    if isinstance(node, list):
        for position, item in enumerate(node):
            yield from schemas_in(item, f"{path}/{position}")
    if isinstance(node, dict):
        yield path, node
        for key, value in node.items():
            if key in {"properties", "patternProperties"}:
                for name, part in value.items():
                    yield from schemas_in(part, f"{path}/{name}")
            elif key in {"anyOf", "items", "additionalProperties"}:
                yield from schemas_in(value, f"{path}/{key}")


EVERY = [(f"{name}{path}", schema) for name, whole in WHOLE.items() for path, schema in schemas_in(whole)]
OBJECTS = [(path, schema) for path, schema in EVERY if "object" in str(schema.get("type"))]
PROPERTIES = [
    (f"{path}/{name}", part if "$ref" not in part else WHOLE[part["$ref"].rpartition("/")[2]] | part)
    for path, schema in OBJECTS
    for name, part in {**schema.get("properties", {}), **schema.get("patternProperties", {})}.items()
]
QUANTITIES = {
    "length": [Dimension.LENGTH],
    "angle": [Dimension.ANGLE],
    "mass": [Dimension.MASS],
    "density": [Dimension.DENSITY],
    "moment": [Dimension.INERTIA],
    "position": [Dimension.ANGLE, Dimension.LENGTH],
    "effort": [Dimension.TORQUE, Dimension.FORCE],
    "velocity": [Dimension.ANGULAR_VELOCITY, Dimension.VELOCITY],
    "acceleration": [Dimension.ANGULAR_ACCELERATION, Dimension.ACCELERATION],
    "jerk": [Dimension.ANGULAR_JERK, Dimension.JERK],
    "frequency": [Dimension.FREQUENCY],
    "speed": [Dimension.VELOCITY],
}


@pytest.mark.parametrize("concept", load_files())
def test_a_file_is_a_schema_of_draft_07(concept: str):
    schema = load_files()[concept]
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    Draft7Validator.check_schema(schema)


def test_a_property_is_described_with_an_example():
    for path, part in PROPERTIES:
        assert part.get("description", "").endswith("."), path
        assert part["markdownDescription"].replace("`", "'").startswith(part["description"]), path
        # The language server shows and inserts `examples`: right for a scalar; a map or list is shown as YAML.
        assert part.get("examples") or "```yaml" in part["markdownDescription"], path


def test_an_example_meets_its_own_schema():
    for path, part in PROPERTIES:
        validator = Draft7Validator({**part, "definitions": WHOLE})
        assert [example for example in part.get("examples", ()) if not validator.is_valid(example)] == [], path


def test_an_object_is_titled_and_closed():
    for path, schema in OBJECTS:
        assert schema.get("title"), path
        is_map_of_names = set(schema.get("properties", ())) <= {*WORDS, *RAW}
        is_open = is_map_of_names or schema["title"] == "an interface's parameters"
        assert is_open or schema["additionalProperties"] is False, path


def test_nothing_is_required_but_the_header():
    assert {schema["title"]: schema["required"] for _, schema in OBJECTS if schema.get("required")} == {
        "a robot": ["linkforge"]
    }


def test_a_pattern_comes_with_its_sentence_and_admits_expressions():
    for path, schema in EVERY:
        if "pattern" in schema:
            assert schema["patternErrorMessage"].startswith("expected "), path
            assert re.search(schema["pattern"], "$(reach / 2)"), path


def test_every_word_of_an_enum_is_explained():
    for path, schema in EVERY:
        if "enum" in schema:
            count = len(schema["enum"])
            assert count == len(schema["enumDescriptions"]) == len(schema["markdownEnumDescriptions"]), path


@pytest.mark.parametrize(("name", "dimensions"), QUANTITIES.items(), ids=QUANTITIES)
def test_a_quantity_accepts_all_units_of_its_dimension_and_suggests_valid_ones(name: str, dimensions: list[Dimension]):
    schema = WHOLE[name]
    for dimension in dimensions:
        for unit in units_of(dimension):
            assert re.search(schema["pattern"], f"-2.5e-3 {unit}")
    offered = [parse_quantity(text) for text in re.findall(r"'([^']+)'", schema["patternErrorMessage"])]
    assert [quantity.dimension for quantity in offered if quantity] == dimensions


@pytest.mark.parametrize("text", ["", "mm", "3", "3 mm 4", "three mm", "1,5 mm"])
def test_what_is_no_number_with_a_unit_is_no_quantity(text: str):
    assert not re.search(WHOLE["length"]["pattern"], text)


def test_owners_are_reported_apart_by_their_titles():
    keys = {(schema["title"], *schema.get("properties", ())) for _, schema in OBJECTS}
    titles = [title for title, *known in keys if not set(known) <= set(WORDS)]
    assert len(titles) == len(set(titles))


SNIPPETS = [
    (f"{path}/{snippet['label']}", schema, snippet)
    for path, schema in EVERY
    for snippet in schema.get("defaultSnippets", ())
]


def filled(body: object) -> object:
    """Return what a snippet writes where every placeholder keeps its text."""
    if isinstance(body, dict):
        return {filled(key): filled(value) for key, value in body.items()}
    text = re.sub(r"\$\{\d+:([^}]*)\}", r"\1", re.sub(r"\$\{\d+\|([^,|]*)[^|]*\|\}", r"\1", str(body)))
    return yaml.safe_load(text.replace("\\$", "$"))


@pytest.mark.parametrize(("schema", "snippet"), [pytest.param(*found, id=path) for path, *found in SNIPPETS])
def test_a_snippet_is_valid_in_its_schema(schema: Schema, snippet: Schema):
    Draft7Validator({**schema, "definitions": WHOLE}).validate(filled(snippet["body"]))


@pytest.mark.parametrize(("schema", "snippet"), [pytest.param(*found, id=path) for path, *found in SNIPPETS])
def test_a_snippet_hides_no_key(schema: Schema, snippet: Schema):
    """Of a snippet and a key with one label, the language server shows one."""
    assert snippet["label"] not in schema.get("properties", ())
