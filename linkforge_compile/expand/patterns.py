"""Regular expressions of a spec, which may be a stranger's: those of RE2, whose time grows with the text only."""

from __future__ import annotations

MAX_PATTERN = 500
MAX_TEXT = 1_000
REFUSED_STEPS = 20_000
"""What it takes at most to refuse a pattern, in steps of expressions."""

_MEMORY = 256 * 1024
"""What RE2 may use for one pattern [byte]: a program of some thousand instructions fits, which takes 0.2 s at most."""

_CHARACTERS_A_STEP = 25
"""How many characters each instruction of a pattern may be held against while an expression takes one of its steps."""


class PatternError(Exception):
    """A text that is no pattern; says why."""


class Pattern:
    """A regular expression of the language of specs."""

    def __init__(self, text: str) -> None:
        """Compile it; raise PatternError for a text that is no pattern."""
        self.text = text
        if len(text) > MAX_PATTERN:
            raise PatternError(f"it is longer than {MAX_PATTERN} characters")
        try:
            import re2
        except ImportError as missing:
            raise PatternError("patterns need the package google-re2, which is not installed") from missing
        options = re2.Options()
        options.max_mem, options.log_errors, options.never_capture = _MEMORY, False, True
        try:
            self._compiled = re2.compile(_encoded(text), options)
        except re2.error as error:
            reason, _, part = error.args[0].decode(errors="replace").partition(": ")
            raise PatternError(f"{reason} at '{part}'" if part else reason) from error

    def steps(self, text: str) -> int:
        """Return how many steps of expressions it may take to look through a text, at most."""
        instructions: int = self._compiled.programsize
        return instructions * (1 + min(len(text), MAX_TEXT) // _CHARACTERS_A_STEP)

    def is_in(self, text: str) -> bool:
        """Return whether the pattern matches anywhere in the text; never in one of more than MAX_TEXT characters."""
        return len(text) <= MAX_TEXT and self._compiled.search(_encoded(text)) is not None


def _encoded(text: str) -> bytes:
    """Return the bytes for RE2, also those of a surrogate, which Python makes of a byte that is no text."""
    return text.encode(errors="surrogatepass")
