"""When output is coloured."""

import io

import pytest

from linkforge_compile.cli.reports import is_colored


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _plain_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR", "CLICOLOR_FORCE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")


def test_a_terminal_has_colours_and_a_file_has_none():
    assert is_colored(Terminal())
    assert not is_colored(io.StringIO())
    assert not is_colored(None)


@pytest.mark.parametrize(
    ("settings", "on_terminal", "in_file"),
    [
        ({"NO_COLOR": "1"}, False, False),
        ({"NO_COLOR": ""}, True, False),
        ({"FORCE_COLOR": "1"}, True, True),
        ({"FORCE_COLOR": "0"}, True, False),
        ({"CLICOLOR_FORCE": "1"}, True, True),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, False, False),
        ({"TERM": "dumb"}, False, False),
    ],
)
def test_the_environment_decides(
    monkeypatch: pytest.MonkeyPatch, settings: dict[str, str], on_terminal: bool, in_file: bool
):
    for name, value in settings.items():
        monkeypatch.setenv(name, value)
    assert (is_colored(Terminal()), is_colored(io.StringIO())) == (on_terminal, in_file)
    assert is_colored(io.StringIO(), "always")
    assert not is_colored(Terminal(), "never")
