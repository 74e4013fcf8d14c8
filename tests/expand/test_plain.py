"""A file that computes nothing is expanded without what computes: to the same as with it."""

from pathlib import Path

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand import Arguments, Unset, is_plain, plain_instance
from linkforge_compile.expand.expand_uses import expand_uses
from linkforge_compile.limits import Limit
from linkforge_compile.load import Loader, SpecFile
from linkforge_compile.source import Span

ROOT = Path(__file__).parents[2]


def opened(path: Path) -> SpecFile | None:
    try:
        return Loader().open(path, Diagnostics())
    except BeyondLimitError:
        return None


@pytest.mark.parametrize("folder", ["examples", "tests/cases"])
def test_a_plain_file_is_its_own_assembly(folder: str):
    specs = [spec for path in sorted((ROOT / folder).rglob("*.yaml")) if (spec := opened(path)) and is_plain(spec)]
    assert specs
    for spec in specs:
        require_same_assembly(spec)


def require_same_assembly(spec: SpecFile) -> None:
    """Compare what both ways make of a plain file."""
    sink, long_way, short_way = Diagnostics(), Loader(), Loader()
    whole = expand_uses(spec, Arguments(), long_way, sink, unset=Unset.ERROR, variant=None)
    plain = plain_instance(spec, short_way)
    assert not list(sink), spec.file
    assert whole.tree is not None
    assert plain.tree is not None
    assert plain.tree.entries == whole.tree.entries, spec.file
    assert plain.tree.span == whole.tree.span
    others = ("name", "entry", "prefix", "mesh_bases", "include_stack", "modules", "references", "removed", "packages")
    for field in (*others, "defaults"):
        assert getattr(plain, field) == getattr(whole, field), (field, spec.file)
    assert short_way.budget.left(Limit.ENTRIES) == long_way.budget.left(Limit.ENTRIES)
    where = Span(spec.file, 1, 1, 1, 2)
    for path in ("meshes/arm.stl", "/arm.stl"):
        sinks = [Diagnostics(), Diagnostics()]
        assert plain.find_mesh(path, where, sinks[0]) == whole.find_mesh(path, where, sinks[1])
        assert list(map(str, sinks[0])) == list(map(str, sinks[1]))


@pytest.mark.parametrize(
    "text",
    [
        "parameters:",
        "modules: {}",
        "variables: {a: 1}",
        "metadata: {a: [$(1)]}",
        "metadata: {$(1): 2}",
        "metadata: {a: $$(1)}",
        "links: {base: {when: yes}}",
        "metadata: {for}",
        "metadata: {value: 1}",
        r'metadata: {a: "\x24(1)"}',
        r'metadata: {"f\x6fr": 1}',
        "include: [nowhere.yaml]",
    ],
)
def test_a_file_with_anything_to_compute_is_not_plain(text: str):
    spec = Loader().parse(f"linkforge: 1\nname: r\n{text}\n", "r.robot.yaml", Path(), Diagnostics())
    assert spec
    assert not is_plain(spec)


def test_words_of_repetition_that_are_no_keys_compute_nothing():
    text = "linkforge: 1\nname: for\nlinks: {base: }  # a value for when there is effort\n"
    spec = Loader().parse(text, "r.robot.yaml", Path(), Diagnostics())
    assert spec
    assert is_plain(spec)


def test_what_its_author_keeps_for_himself_is_plain():
    spec = Loader().parse("linkforge: 1\nname: r\nx-mine: $(1)\n", "r.robot.yaml", Path(), Diagnostics())
    assert spec
    assert is_plain(spec)
