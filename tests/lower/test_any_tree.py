"""Whatever tree arrives, every key of the language is read, and nothing ends in a traceback."""

import ast
import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import linkforge_compile.lower
from linkforge_compile.core import models
from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.part import Part
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.instance import Instance
from linkforge_compile.lower import lower
from linkforge_compile.resources import schemas_folder
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, Quantity

ELSEWHERE = {"macro", "linkforge", "description", "parameters", "variables", "data", "variants", "packages", "defaults"}
ELSEWHERE |= {"modules", "use", "srdf", "prefix", "with", "override"}
"""Keys that the stages before lowering read, or that only people do."""


def keys_of(schema: object) -> Iterator[str]:
    if isinstance(schema, dict):
        properties = schema.get("properties", {})
        yield from properties
        for inner in (*properties.values(), *(value for key, value in schema.items() if key != "properties")):
            yield from keys_of(inner)
    elif isinstance(schema, list):
        for inner in schema:
            yield from keys_of(inner)


SCHEMAS = {
    path.name.removesuffix(".schema.json"): json.loads(path.read_text("utf-8"))
    for path in schemas_folder().glob("*.schema.json")
}
SPOKEN = {key for name, schema in SCHEMAS.items() if name != "parameter" for key in keys_of(schema)}


def test_lowering_reads_every_key_that_the_schema_knows():
    folder = Path(linkforge_compile.lower.__file__).parent
    read = {
        node.value
        for path in folder.glob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    named = (getattr(models, name) for name in models.__all__)
    kinds = [kind for kind in named if isinstance(kind, type) and issubclass(kind, Part)]
    described = {spec.key or name for kind in kinds for name, spec in field_specs(kind).items()}
    assert not SPOKEN - ELSEWHERE - read - described


SPAN = SourceFile("spec.yaml", "").whole


def scalar(value) -> YamlScalar:
    return YamlScalar("null" if value is None else str(value), value, SPAN)


def mapping(nodes: dict[str, YamlNode]) -> YamlMap:
    return YamlMap({key: YamlEntry(scalar(key), node) for key, node in nodes.items()}, SPAN)


def sequence(nodes: list[YamlNode]) -> YamlList:
    return YamlList(tuple(nodes), SPAN)


WORDS = ["a", "b", "c", "d", "a b", "", "visual", "x", "3 mm", "90 deg", "2 kg", "1 furlong"]
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-1, 3),
    st.floats(),
    st.sampled_from(WORDS),
    st.builds(Quantity, st.floats(-9, 9), st.sampled_from(Dimension)),
).map(scalar)
LEAVES = SCALARS | st.just(YamlFault(SPAN)) | st.lists(SCALARS, max_size=4).map(sequence)
NAMES = st.sampled_from(["a", "b", "c", "d", "a b", "$(n)"])


@cache
def near(name: str, pointer: str = "") -> st.SearchStrategy[YamlNode]:
    """Draw trees that have the keys of a schema, and whatever under them."""
    schema = SCHEMAS[name]
    for step in pointer.split("/")[1:]:
        schema = schema[step]
    return st.deferred(lambda: near_schema(schema, name))


def near_schema(schema: dict, name: str) -> st.SearchStrategy[YamlNode]:
    if "$ref" in schema and schema["$ref"].endswith("/extra_inside"):
        # It holds itself; without an end of it, most trees would be too large to draw.
        inside = st.fixed_dictionaries({}, optional={"extra": LEAVES, "extra_attributes": LEAVES}).map(mapping)
        return st.dictionaries(NAMES, inside | SCALARS, max_size=2).map(mapping) | LEAVES
    if "$ref" in schema:
        file, _, pointer = schema["$ref"].partition("#")
        return near(file.removesuffix(".schema.json") or name, pointer)
    choices = [near_schema(choice, name) for choice in schema.get("anyOf", ())]
    if "properties" in schema:
        keys = {key: near_schema(inner, name) for key, inner in schema["properties"].items()}
        choices.append(st.fixed_dictionaries(keys).map(mapping) | st.fixed_dictionaries({}, optional=keys).map(mapping))
    elif isinstance(inner := schema.get("additionalProperties"), dict):
        choices.append(st.dictionaries(NAMES, near_schema(inner, name), max_size=3).map(mapping))
    if "items" in schema:
        choices.append(st.lists(near_schema(schema["items"], name), max_size=3).map(sequence))
    if "enum" in schema:
        choices.append(st.sampled_from(schema["enum"]).map(scalar))
    choices = [choice for choice in choices for _ in range(4)] or [SCALARS]
    odd = st.integers(0, 3).map(lambda dice: dice == 0)
    return odd.flatmap(lambda is_odd: LEAVES if is_odd else st.one_of(choices))


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(near("robot"), near("robot"), near("module"))
def test_no_tree_is_a_traceback(tree, module, entry):
    hand = Instance("hand", module if isinstance(module, YamlMap) else None, SourceRef(entry, YamlFault(SPAN)), "hand_")
    body = tree if isinstance(tree, YamlMap) else mapping({})
    assert lower(Instance("body", body, modules=(hand, hand)), Diagnostics()).robot is not None
