"""Test the cache of faultless trees."""

import gc
import weakref

import pytest

from linkforge_compile import compile_file, compile_text, render_urdf
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load import spec_tree
from linkforge_compile.source import SourceFile

ARM = "linkforge: 1\nname: arm\nlinks: {base: }\n"
WRIST = "joints: {wrist: {type: fixed, parent: base, child: palm}}"


@pytest.fixture(autouse=True)
def nothing_remembered(monkeypatch):
    monkeypatch.setattr(spec_tree, "_cache", spec_tree._TreeCache())


@pytest.fixture
def texts_read(monkeypatch) -> list[str]:
    """Return the texts that are read while the test runs."""
    texts = []

    def read(source, sink, budget):
        texts.append(source.text)
        return original(source, sink, budget)

    original = spec_tree.read
    monkeypatch.setattr(spec_tree, "read", read)
    return texts


def test_a_robot_is_read_once_and_comes_out_the_same(tmp_path, texts_read):
    (tmp_path / "hand.yaml").write_text("linkforge: 1\nlinks: {palm: }\n")
    spec = tmp_path / "arm.robot.yaml"
    spec.write_text(ARM + "include: [hand.yaml]\njoints: {wrist: {type: fixed, parent: base, child: palm}}\n")
    first, second = compile_file(spec), compile_file(spec)
    assert render_urdf(first.result()) == render_urdf(second.result())
    assert first == second
    assert len(texts_read) == 2


def test_a_module_that_changed_is_read_anew_and_the_others_are_not(tmp_path, texts_read):
    (tmp_path / "hand.robot.yaml").write_text("linkforge: 1\nname: hand\nlinks: {palm: }\n")
    spec = tmp_path / "arm.robot.yaml"
    spec.write_text(ARM + "modules: {hand: {use: hand.robot.yaml, parent: base}}\n")
    compile_file(spec)
    (tmp_path / "hand.robot.yaml").write_text("linkforge: 1\nname: hand\nlinks: {fist: }\n")
    robot = compile_file(spec).result()
    assert "hand_fist" in {link.name for link in robot.links}
    assert [text.partition("name: ")[2][:4] for text in texts_read] == ["arm\n", "hand", "hand"]


def test_faults_are_reported_each_time():
    faulty = ARM.replace("base: ", "base: {visuals: }")
    first, second = compile_text(faulty), compile_text(faulty)
    assert [str(one) for one in first.diagnostics] == [str(one) for one in second.diagnostics] != []


def test_diagnostics_of_later_stages_are_reported_each_time():
    parentless = ARM + "joints: {elbow: {type: fixed, parent: bse, child: base}}\n"
    first, second = compile_text(parentless), compile_text(parentless)
    assert [str(one) for one in first.diagnostics] == [str(one) for one in second.diagnostics] != []


def test_a_text_under_another_name_is_another_file():
    files = {compile_text(ARM, name=name).result().source.span.file.name for name in ("one", "other", "one")}
    assert files == {"one", "other"}


def test_what_is_remembered_is_counted_all_the_same():
    spent = []
    for _ in range(2):
        budget = Budget()
        whole = budget.left(Limit.VALUES)
        assert spec_tree.read_tree(spec_tree.cached_source(SourceFile("arm", ARM)), Diagnostics(), budget)
        spent.append(whole - budget.left(Limit.VALUES))
    assert spent[0] == spent[1] > 0


def test_old_texts_are_forgotten(monkeypatch, texts_read):
    monkeypatch.setattr(spec_tree, "MAX_CACHED_CHARACTERS", 3 * len(ARM))
    for name in ("one", "two", "three", "four", "four", "one"):
        compile_text(ARM, name=name)
    assert len(texts_read) == 5


def test_a_text_that_is_too_large_to_remember_leaves_the_others(monkeypatch, texts_read):
    monkeypatch.setattr(spec_tree, "MAX_CACHED_CHARACTERS", 3 * len(ARM))
    compile_text(ARM, name="one")
    compile_text(ARM + "#" * 3 * len(ARM), name="large")
    compile_text(ARM, name="one")
    assert len(texts_read) == 2


def test_of_an_edited_file_no_old_text_is_kept_even_by_what_it_includes(tmp_path):
    (tmp_path / "hand.yaml").write_text("linkforge: 1\nlinks: {palm: }\n")
    spec = tmp_path / "arm.robot.yaml"
    roots = []
    for edit in range(3):
        spec.write_text(
            f"{ARM}include: [hand.yaml]  # {edit}\njoints: {{w: {{type: fixed, parent: base, child: palm}}}}\n"
        )
        roots.append(weakref.ref(compile_file(spec).result().source.span.file))
    gc.collect()
    assert [root() is None for root in roots] == [True, True, False]


def test_of_a_file_with_a_fault_no_old_text_is_kept_either(tmp_path):
    """Its parts are remembered, and each of them knows the file that included it."""
    (tmp_path / "hand.yaml").write_text("linkforge: 1\nlinks: {palm: }\n")
    spec = tmp_path / "arm.robot.yaml"
    files = []
    for edit in range(3):
        spec.write_text(f"{ARM}include: [hand.yaml]  # {edit}\nlonks: \n")
        files.append(weakref.ref(compile_file(spec).diagnostics[0].span.file))
    gc.collect()
    assert [file() is None for file in files] == [True, True, False]
