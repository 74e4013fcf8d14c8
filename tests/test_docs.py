"""The reference page: written from the schemas, so that the two cannot part; every key, no dead link."""

import importlib.util
import re
from types import ModuleType

import pytest
import yaml

from linkforge_compile import compile_text
from tests.conftest import ROOT


def load_generator() -> ModuleType:
    spec = importlib.util.spec_from_file_location("generate", ROOT / "docs" / "generate.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GENERATE = load_generator()
PAGE = GENERATE.PAGE.read_text("utf-8")
BLOCKS = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)


def test_the_page_is_what_the_schemas_and_the_prose_make():
    assert GENERATE.page() == PAGE, "run `python docs/generate.py` and look at the difference"


@pytest.mark.parametrize(("title", "schema"), GENERATE.objects().items(), ids=GENERATE.objects())
def test_every_key_of_an_object_has_a_line(title: str, schema: dict[str, dict[str, object]]):
    for key in schema["properties"]:
        assert key == "value" or f"\n| `{key}` | " in PAGE, f"no line about '{key}' of {title}"


def test_every_object_has_a_table():
    listed = re.findall(r"<!-- keys of: (.+?)(?:, besides .+)? -->", GENERATE.SOURCE.read_text("utf-8"))
    assert sorted({*listed} - {"every object"}) == sorted(GENERATE.objects())


def test_every_link_within_the_page_leads_to_a_heading():
    headings = re.findall(r"^#+ (.+)$", PAGE, re.MULTILINE)
    anchors = [heading.lower().replace(" ", "-") for heading in headings]
    assert len(anchors) == len(set(anchors))
    assert {*re.findall(r"\]\(#([^)]+)\)", PAGE)} <= {*anchors}


@pytest.mark.parametrize("block", BLOCKS, ids=[block.partition("\n")[0] for block in BLOCKS])
def test_every_example_is_yaml_and_every_whole_spec_compiles(block: str):
    assert isinstance(yaml.load(block, yaml.BaseLoader), dict)
    if block.startswith("linkforge:"):
        assert compile_text(block).result().links


def test_a_default_and_a_unit_have_cells_of_their_own():
    for line in (
        "| `offset` | Added to the product. | a joint position | rad or m | 0 | `offset: 5 deg` |",
        "| `prefix` | Put before every name in the module: links, joints, materials, groups and all the rest. | text | "
        '| the entry\'s own name and `_`; `""` for none | `prefix: left_` |',
    ):
        assert line in re.sub(r"\|  \|", "| |", PAGE)
