"""Writes output files, standard output, and the dependencies of an output as a makefile rule.

A reader sees the old file or the new one, never a part of one.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from errno import EBUSY, EISDIR
from itertools import takewhile
from pathlib import Path
from typing import TypeAlias

from linkforge_compile.atomic_file import new_file
from linkforge_compile.cli import UsageError
from linkforge_compile.cli.reports import print_status
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.roots import Roots, exists, identity, real_path

Content: TypeAlias = str | bytes
"""What a file holds; a text is written in UTF-8."""


def write_to_stdout(content: Content) -> None:
    """Write to standard output, with the line ends of a text unchanged; UsageError if that fails."""
    try:
        if sys.stdout is None:
            raise UsageError("cannot write to standard output: it is closed")
        unwritten = memoryview(_encode(content))
        while unwritten:
            # With PYTHONUNBUFFERED the stream has no buffer, and writing to a full disk may write only a part.
            unwritten = unwritten[sys.stdout.buffer.write(unwritten) :]
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise UsageError(f"cannot write to standard output: {error.strerror}") from error


def write_document(content: Content, path: Path | None, arguments: argparse.Namespace) -> None:
    """Write the one output of a command to a file, or to standard output for None, and print what was done."""
    if path is None:
        write_to_stdout(content)
    else:
        print_status(f"wrote {path}" if write_if_changed(path, content) else f"{path} is up to date", arguments)


def json_text(document: object) -> str:
    """Return a document for tools, as all commands print JSON."""
    import json

    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def write_json(text: str, output: str | None, arguments: argparse.Namespace) -> None:
    """Write JSON as `write_document` does; UsageError if the file of `-o` does not end in .json."""
    path = file_to_write(output)
    if path is not None and path.suffix != ".json":
        raise UsageError(f"-o takes a file that ends in .json, found '{output}'")
    write_document(text, path, arguments)


def unified(name: str, before: str, after: str, how: str) -> str:
    """Return the difference between a file as written and after a change, named by `how`, as `diff -u` prints it."""
    from difflib import unified_diff

    old, new = (text.splitlines(keepends=True) for text in (before, after))
    shown = unified_diff(old, new, f"{name} (as written)", f"{name} ({how})")
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in shown)


def write_if_changed(path: Path, content: Content) -> bool:
    """Write one file as `write_changed` does; return whether it was written."""
    return bool(write_changed({path: content}))


def write_changed(contents: Mapping[Path, Content], stdout: Content | None = None) -> frozenset[Path]:
    """Write each content to its file, and `stdout` to standard output; return the files that were written.

    Files that hold their content already are not touched, so that build tools see no change. All others are written to
    temporary files first, which then replace their targets one by one: if one cannot be written, no target is
    replaced. Devices, pipes and standard output come last. UsageError if something cannot be written.
    """
    targets = {path: resolve_output(path) for path in contents}
    with remove_new_folders_on_error(targets.values()), ExitStack() as cleanup:
        temporary: dict[Path, Path] = {}
        devices: list[Path] = []
        for path, target in targets.items():
            with _write_errors(path, target):
                content = _encode(contents[path])
                if target.is_file() and target.read_bytes() == content:
                    continue
                if target.is_dir():
                    raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
                if target.is_file() or not target.exists():
                    temporary[path] = cleanup.enter_context(new_file(target, content))
                else:  # such as /dev/stderr, or a pipe that a shell makes for >(…)
                    devices.append(path)
        for path, new in temporary.items():
            with _write_errors(path, targets[path]):
                new.replace(targets[path])
        for path in devices:
            with _write_errors(path, targets[path]):
                targets[path].write_bytes(_encode(contents[path]))
        if stdout is not None:
            write_to_stdout(stdout)
    return frozenset((*temporary, *devices))


def resolve_output(path: Path) -> Path:
    """Return the file that writing to a path replaces: of a symbolic link, the file it leads to."""
    target = real_path(path)
    if target is not None and not exists(Path(target)) and exists(path):
        return path  # a pipe such as /dev/stderr or >(…), which the system names `pipe:[42]`
    # What is still a link is part of a loop.
    if target is None or os.path.islink(target):  # noqa: PTH114 as in `roots`
        what = f"'{path}' is a link that leads to itself, or that must not be followed"
        raise UsageError(f"{what}; write to another place")
    return Path(target)


def refuse_to_replace(sources: Iterable[Path], outputs: Iterable[Path | None]) -> None:
    """Refuse outputs that are sources of the robot, or two outputs in one file; None is standard output.

    For example, a vendor's URDF beside a spec of the same name, or a depfile with the name of the URDF.
    """
    taken = {identity(file) for file in sources}
    targets: set[Path] = set()
    for path in outputs:
        if path is None:
            continue
        target = resolve_output(path)
        if str(target) in taken:
            raise UsageError(f"'{path}' would be replaced, and the robot is made from it; write to another place")
        # Two outputs may go to one device, such as /dev/null.
        if target in targets and (target.is_file() or not target.exists()):
            raise UsageError(f"'{path}' would be written twice; write each output to its own file")
        targets.add(target)


def refuse_links_out(outputs: Iterable[Path], folders: Iterable[Path], option: str) -> None:
    """Refuse outputs that links of an untrusted repository would redirect outside the folders."""
    roots = Roots(tuple(Path(identity(folder)) for folder in folders))
    for output in outputs:
        if not roots.hold(output):
            what = f"'{output}' is reached by a link that leads out of its folder"
            raise UsageError(f"{what}; remove the link, or write elsewhere with {option}")


@contextmanager
def remove_new_folders_on_error(files: Iterable[Path]) -> Iterator[None]:
    """If the body fails, remove the empty folders that it created for the files."""
    missing = {folder for file in files for folder in takewhile(lambda one: not exists(one), file.parents)}
    try:
        yield
    except BaseException:
        for folder in sorted(missing, reverse=True):
            with suppress(OSError):
                folder.rmdir()
        raise


@contextmanager
def _write_errors(path: Path, target: Path) -> Iterator[None]:
    """Turn an OSError into a UsageError that names the path as the user wrote it."""
    try:
        yield
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {_reason(error, target)}") from error


def _reason(error: OSError, target: Path) -> str:
    if error.errno == EBUSY:
        # Writing into the file in place instead could leave a part of it behind.
        return f"{error.strerror}; if only this file is mounted, mount its folder instead, because files are replaced"
    blocked = next((folder for folder in target.parents if folder.exists() and not folder.is_dir()), None)
    return f"'{blocked.name}' is not a folder" if blocked else str(error.strerror)


def _encode(content: Content) -> bytes:
    """Return text in UTF-8; bytes of file names that are not UTF-8 become escape sequences, as in JSON."""
    return content if isinstance(content, bytes) else content.encode("utf-8", "backslashreplace")


# Make needs a backslash before a blank, and doubled backslashes before that one.
_BLANK = re.compile(r"(\\*)([ \t])")

# Not the colon of a drive of Windows.
_COLON = re.compile(r"(?<!^[A-Za-z]):|:(?![/\\])")

_UNWRITABLE = re.compile(r"[\n\r;|\ud800-\udfff]")

# In a target of Make, `=` assigns a variable and `%` is a pattern; Ninja does not read `%` escaped for Make.
_UNWRITABLE_IN_TARGETS = re.compile(r"[\n\r;|=%\ud800-\udfff]")


def inputs_of(files: Iterable[Path], template_folders: Collection[str]) -> tuple[Path, ...]:
    """Return the files on which an output depends: those that were read, and those of linkforge itself.

    `template_folders` are those of linkforge's templates that are rendered, empty for all.
    """
    from linkforge_compile.resources import compiler_files

    return tuple(dict.fromkeys((*files, *compiler_files(template_folders))))


def make_rules(outputs: Iterable[Path], inputs: Sequence[Path]) -> str:
    """Return `OUTPUTS: INPUTS` and an empty rule `INPUT:` for each; UsageError for a name that Make cannot express.

    With the empty rules, as `gcc -MP` writes them, Make rebuilds the outputs after an input was deleted, instead of
    failing because nothing makes it.
    """
    targets = " ".join(_escape_for_make(output, _UNWRITABLE_IN_TARGETS) for output in outputs)
    rule = " \\\n  ".join((f"{targets}:", *map(_escape_for_make, inputs)))
    # Without the blank, CMake 3.20 reads the colon as part of the name.
    empty = (f"{_escape_for_make(path)}: " for path in inputs if not _UNWRITABLE_IN_TARGETS.search(path.as_posix()))
    return "\n".join((rule, *empty, ""))


def _escape_for_make(path: Path, unwritable: re.Pattern[str] = _UNWRITABLE) -> str:
    name = path.as_posix()
    if found := unwritable.search(name):
        raise UsageError(f"a depfile cannot contain '{name}', because it has {found[0]!r} in it; rename it")
    name = name.replace("$", "$$").replace("#", r"\#")
    return _COLON.sub(r"\\:", _BLANK.sub(r"\1\1\\\2", name))
