"""Writes the dependencies of an output as a makefile rule, which CMake and Ninja read as well."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.resources import compiler_files

# Make needs a backslash before a blank, and doubled backslashes before that one.
_BLANK = re.compile(r"(\\*)([ \t])")

# Not the colon of a drive of Windows.
_COLON = re.compile(r"(?<!^[A-Za-z]):|:(?![/\\])")

_UNWRITABLE = re.compile(r"[\n\r;|\ud800-\udfff]")

# In a target of Make, `=` assigns a variable and `%` is a pattern; Ninja does not read `%` escaped for Make.
_UNWRITABLE_IN_TARGETS = re.compile(r"[\n\r;|=%\ud800-\udfff]")


def inputs_of(files: Iterable[Path]) -> tuple[Path, ...]:
    """Return the files on which an output depends: those that were read, and those of linkforge itself."""
    return tuple(dict.fromkeys((*files, *compiler_files())))


def make_rules(outputs: Iterable[Path], inputs: Sequence[Path]) -> str:
    """Return `OUTPUTS: INPUTS` and an empty rule `INPUT:` for each; UsageError for a name that Make cannot express.

    With the empty rules, as `gcc -MP` writes them, Make rebuilds the outputs after an input was deleted, instead of
    failing because nothing makes it.
    """
    targets = " ".join(_escape(output, _UNWRITABLE_IN_TARGETS) for output in outputs)
    rule = " \\\n  ".join((f"{targets}:", *map(_escape, inputs)))
    # Without the blank, CMake 3.20 reads the colon as part of the name.
    empty = (f"{_escape(path)}: " for path in inputs if not _UNWRITABLE_IN_TARGETS.search(path.as_posix()))
    return "\n".join((rule, *empty, ""))


def _escape(path: Path, unwritable: re.Pattern[str] = _UNWRITABLE) -> str:
    name = path.as_posix()
    if found := unwritable.search(name):
        raise UsageError(f"a depfile cannot hold '{name}', for it has {found[0]!r} in it; rename it")
    name = name.replace("$", "$$").replace("#", r"\#")
    return _COLON.sub(r"\\:", _BLANK.sub(r"\1\1\\\2", name))
