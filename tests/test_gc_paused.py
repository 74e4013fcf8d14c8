"""The garbage collector is paused during a compile, and afterwards as it was before."""

import gc
from collections.abc import Iterator

import pytest

from linkforge_compile import analysis, compile_text
from linkforge_compile.lower import lower

BALL = "linkforge: 1\nname: ball\nlinks: {base: }\n"


@pytest.fixture(autouse=True)
def _restored() -> Iterator[None]:
    was_enabled = gc.isenabled()
    yield
    (gc.enable if was_enabled else gc.disable)()


@pytest.fixture
def states(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether the collector was enabled, each time that something was lowered."""
    seen = []

    def watched(*arguments: object) -> object:
        seen.append(gc.isenabled())
        return lower(*arguments)

    monkeypatch.setattr(analysis, "lower", watched)
    return seen


def test_it_is_paused_during_a_compile_and_resumed_afterwards(states: list[bool]):
    gc.enable()
    compile_text(BALL)
    assert states == [False]
    assert gc.isenabled()


def test_a_caller_who_has_switched_it_off_finds_it_so(states: list[bool]):
    gc.disable()
    compile_text(BALL)
    assert states == [False]
    assert not gc.isenabled()


def test_it_is_resumed_after_a_compile_that_failed(monkeypatch: pytest.MonkeyPatch):
    def failing(*_: object) -> None:
        raise OSError("the disk is gone")

    gc.enable()
    monkeypatch.setattr(analysis, "lower", failing)
    with pytest.raises(OSError, match="the disk is gone"):
        compile_text(BALL)
    assert gc.isenabled()
