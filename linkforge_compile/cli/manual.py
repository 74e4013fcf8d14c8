"""The manual: a page for each diagnostic code, as `linkforge explain LF4102` prints it."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkforge_compile.diagnostics import Code
from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.resources import manual_folder

_BOLD, _CYAN, _RESET = "\033[1m", "\033[36m", "\033[0m"


class UnknownCodeError(Exception):
    """No diagnostic has this code; the message suggests a similar one."""


def is_code(word: str) -> bool:
    """Whether a word has the form of a code, LF and digits in either case; the code may be unknown."""
    return re.fullmatch(r"LF\d+", word, re.IGNORECASE) is not None


def page(word: str, *, styled: bool) -> str:
    """Return the manual page of a code as Markdown, or styled for a terminal."""
    name = word.upper()
    if name not in REGISTER:
        raise UnknownCodeError(f"no diagnostic has the code '{name}'{did_you_mean(name, REGISTER)}")
    file = manual_folder() / f"{name}.md"
    text = file.read_text("utf-8") if file.is_file() else f"# {heading(REGISTER[name])}\n"
    return "".join(f"{line}\n" for line in _styled(text)) if styled else text


def heading(code: Code) -> str:
    """Return the first line of a code's page, without the `# `."""
    return f"{code.id}: {code.title}"


def register_table() -> str:
    """Return a line for each code, with its severity and title."""
    width = max(len(code.severity) for code in REGISTER.values())
    codes = sorted(REGISTER.values(), key=lambda code: code.id)
    return "".join(f"{code.id}  {code.severity:{width}}  {code.title}\n" for code in codes)


def _styled(text: str) -> Iterator[str]:
    """Yield lines of Markdown with headings in bold, code in color and examples indented."""
    is_example = False
    for line in text.splitlines():
        if line.startswith("```"):
            is_example = not is_example
            # A fence may name the example's file.
            _, _, file = line.partition(" file=")
            if file:
                yield f"{file}:"
        elif is_example:
            yield f"    {_CYAN}{line}{_RESET}" if line else ""
        elif line.startswith("#"):
            yield f"{_BOLD}{line.lstrip('#').lstrip()}{_RESET}"
        else:
            yield re.sub(r"`([^`]+)`", rf"{_CYAN}\1{_RESET}", line)
