"""What an output is made from, in the syntax of Make: CMake and Ninja read it as well."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.resources import compiler_files

# A blank ends a name unless a backslash stands before it, and backslashes before that one are then doubled.
_BLANK = re.compile(r"(\\*)([ \t])")

# The colon of a drive of Windows stays as it is.
_COLON = re.compile(r"(?<!^[A-Za-z]):|:(?![/\\])")

_UNWRITABLE = re.compile(r"[\n\r;|\ud800-\udfff]")

# Of Make, `=` before the colon assigns a variable, and `%` is a pattern; escaped for Make, `%` is no name to Ninja.
_UNWRITABLE_IN_TARGETS = re.compile(r"[\n\r;|=%\ud800-\udfff]")


def inputs_of(files: Iterable[Path]) -> tuple[Path, ...]:
    """Return every file whose change may change the output: those that were read, then those of linkforge itself."""
    return tuple(dict.fromkeys((*files, *compiler_files())))


def make_rules(outputs: Iterable[Path], inputs: Sequence[Path]) -> str:
    """Return `OUTPUTS: INPUTS` and an `INPUT:` for each; UsageError for a name that no makefile can hold.

    By its empty rule Make takes an input that is gone for one that has changed, as behind `gcc -MP`: who deletes a
    module need not delete the depfile as well.
    """
    targets = " ".join(_escaped(output, _UNWRITABLE_IN_TARGETS) for output in outputs)
    rule = " \\\n  ".join((f"{targets}:", *map(_escaped, inputs)))
    # Without the blank, CMake 3.20 takes the colon for a part of the name.
    empty = (f"{_escaped(path)}: " for path in inputs if not _UNWRITABLE_IN_TARGETS.search(path.as_posix()))
    return "\n".join((rule, *empty, ""))


def _escaped(path: Path, unwritable: re.Pattern[str] = _UNWRITABLE) -> str:
    name = path.as_posix()
    if found := unwritable.search(name):
        raise UsageError(f"a depfile cannot hold '{name}', for it has {found[0]!r} in it; rename it")
    name = name.replace("$", "$$").replace("#", r"\#")
    return _COLON.sub(r"\\:", _BLANK.sub(r"\1\1\\\2", name))
