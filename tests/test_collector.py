"""Python's collector of cycles rests while a robot is compiled, joined or rendered, and is as it was afterwards."""

import gc
from collections.abc import Iterator

import pytest

from linkforge_compile import compile_text, pipeline, render_srdf, render_urdf
from linkforge_compile.backends import srdf_view, urdf
from linkforge_compile.core import Link, Robot
from linkforge_compile.core.models import merging
from linkforge_compile.lowering import lower

BALL = "linkforge: 1\nname: ball\nlinks: {base: }\n"


@pytest.fixture(autouse=True)
def _restored() -> Iterator[None]:
    was_enabled = gc.isenabled()
    yield
    (gc.enable if was_enabled else gc.disable)()


@pytest.fixture
def states(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether the collector was at work, each time that something was lowered."""
    seen = []

    def watched(*arguments: object) -> object:
        seen.append(gc.isenabled())
        return lower(*arguments)

    monkeypatch.setattr(pipeline, "lower", watched)
    return seen


def test_it_rests_during_a_compile_and_works_afterwards(states: list[bool]):
    gc.enable()
    compile_text(BALL)
    assert states == [False]
    assert gc.isenabled()


def test_a_caller_who_has_switched_it_off_finds_it_so(states: list[bool]):
    gc.disable()
    compile_text(BALL)
    assert states == [False]
    assert not gc.isenabled()


def test_it_works_again_after_a_compile_that_failed(monkeypatch: pytest.MonkeyPatch):
    def failing(*_: object) -> None:
        raise OSError("the disk is gone")

    gc.enable()
    monkeypatch.setattr(pipeline, "lower", failing)
    with pytest.raises(OSError, match="the disk is gone"):
        compile_text(BALL)
    assert gc.isenabled()


@pytest.mark.parametrize(
    ("render", "room", "view"), [(render_urdf, urdf, "_robot_view"), (render_srdf, srdf_view, "semantic_view")]
)
def test_it_rests_while_a_document_is_rendered(render, room, view: str, monkeypatch: pytest.MonkeyPatch):
    make, seen = getattr(room, view), []

    def watched(*arguments: object) -> object:
        seen.append(gc.isenabled())
        return make(*arguments)

    monkeypatch.setattr(room, view, watched)
    gc.enable()
    render(compile_text(BALL).result())
    assert seen == [False]
    assert gc.isenabled()


def test_it_rests_while_robots_are_joined(monkeypatch: pytest.MonkeyPatch):
    joined, seen = merging.PrefixedParts.of, []

    def watched(robot: Robot, prefix: str) -> merging.PrefixedParts:
        seen.append(gc.isenabled())
        return joined(robot, prefix)

    monkeypatch.setattr(merging.PrefixedParts, "of", watched)
    gc.enable()
    Robot("station", links=[Link("table")]).merge(compile_text(BALL).result(), "table", "mount", "left_")
    assert seen == [False]
    assert gc.isenabled()
