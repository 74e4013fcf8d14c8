"""Compiles a spec, and renders its outputs or compares them with existing files."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.banner import banner_of
from linkforge_compile.cli import UsageError
from linkforge_compile.cli.options import compile_spec, format_options_of
from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.formats import MISSING_OUTPUT, STALE_OUTPUT
from linkforge_compile.formats import Rendering, format_named, render_documents
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Sequence

    from linkforge_compile.cli.targets import Targets
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.user_templates import TemplateFolder
    from linkforge_compile.pipeline import Compilation


_LONGEST_QUOTE = 120
"""The most characters of a line that a message quotes."""


class Output(NamedTuple):
    """A text and its file, None for standard output."""

    path: Path | None
    text: str


class Build(NamedTuple):
    """The outputs of one spec in a variant (None: the defaults), the files that they were made from, and diagnostics.

    There are no outputs if one of them cannot be made.
    """

    spec: str
    variant: str | None
    outputs: tuple[Output, ...]
    sources: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]


class BuildRequest(NamedTuple):
    """What to build: a spec with assignments to its parameters, the targets, and the user's templates if any.

    `variant` is the one of the spec, None for the defaults.
    """

    spec: str
    assignments: list[str]
    targets: Targets
    templates: TemplateFolder | None = None
    variant: str | None = None

    @property
    def template_files(self) -> tuple[Path, ...]:
        """The templates that were read so far."""
        return self.templates.files if self.templates else ()


def targets_for(robot: Robot, targets: Targets) -> tuple[Targets, tuple[Diagnostic, ...]]:
    """Return the targets for which the robot has content, and diagnostics about requested ones without."""
    missing = {name: why for name in targets.formats if (why := format_named(name).missing(robot))}
    return targets.without(missing), tuple(missing.values()) if targets.is_requested else ()


def _place(target: Path, name: str) -> Path:
    """Return the file of a document: the target, or a file below it for a format of several files."""
    return target / name if name else target


def compile_request(request: BuildRequest, arguments: argparse.Namespace) -> Compilation:
    """Compile the spec of a request with the options of `linkforge compile`."""
    folders = request.targets.folders(arguments.installed_in)
    formats, variant = request.targets.formats, request.variant
    spec, assignments = request.spec, request.assignments
    return compile_spec(spec, assignments, arguments, folders=folders, formats=formats, variant=variant)


def render_request(request: BuildRequest, compilation: Compilation, arguments: argparse.Namespace) -> Build:
    """Render the outputs of a compilation, and compare them with files for `--check`."""
    outputs, faults = ((), ()) if compilation.robot is None else _render(compilation.robot, request, arguments)
    diagnostics = compilation.diagnostics
    if faults:
        diagnostics = tuple(sorted((*diagnostics, *faults), key=lambda one: one.order))
    stale = tuple(_find_stale(outputs, request, compilation.robot)) if arguments.check else ()
    sources = (*compilation.files, *request.template_files)
    return Build(request.spec, request.variant, outputs, sources, (*diagnostics, *stale))


def _render(
    robot: Robot, request: BuildRequest, arguments: argparse.Namespace
) -> tuple[tuple[Output, ...], tuple[Diagnostic, ...]]:
    """Return all outputs, or none if one cannot be rendered, and diagnostics about them."""
    targets, faults = targets_for(robot, request.targets)
    if faults:
        return (), faults
    name = Path(request.spec).name
    banner = None if request.spec == "-" else banner_of(on_one_line(name))
    options = format_options_of(arguments)
    if request.templates is None:
        rendering = Rendering(options, banner=banner, has_map=arguments.source_map)
        return tuple(_render_formats(robot, targets, rendering)), ()
    from linkforge_compile.formats.user_templates import TemplateError

    try:
        if targets.are_documents:
            texts = render_documents(robot, request.templates, options, banner or "")
            outputs = tuple(Output(path, texts[name]) for name, path in targets.paths.items())
        else:
            rendering = Rendering(options, banner=banner, templates=request.templates)
            outputs = tuple(_render_formats(robot, targets, rendering))
        return outputs, request.templates.unused
    except TemplateError as error:
        return (), error.diagnostics


def _render_formats(robot: Robot, targets: Targets, rendering: Rendering) -> Iterator[Output]:
    """Yield the documents of each format, each with its source map if that is requested."""
    for format_, target in targets.paths.items():
        documents = format_named(format_).render(robot, rendering)
        if target is None:
            if len(documents) > 1:
                raise UsageError(
                    f"{format_} is {len(documents)} files, and standard output takes one; write -o FOLDER/"
                )
            yield Output(None, documents[0].text)
            continue
        for text, name, map_ in documents:
            path = _place(target, name)
            yield Output(path, text)
            if map_ is not None:
                from linkforge_compile.formats.map_file import ENDING, map_text

                yield Output(path.with_name(path.name + ENDING), map_text(text, map_, path.name, path.parent))


def _find_stale(outputs: Sequence[Output], request: BuildRequest, robot: Robot | None) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each file that is missing or differs from its output."""
    # Tools that collect diagnostics show only those with a place.
    place = Span(robot.source.span.file, 1, 1, 1, 1) if robot and robot.source else None
    for path, text in outputs:
        assert path is not None, "only files are compared"
        try:
            found = path.read_bytes().decode("utf-8", errors="replace")
        except FileNotFoundError:
            yield MISSING_OUTPUT.at(place, path=path, spec=request.spec)
            continue
        except OSError as error:
            raise UsageError(f"cannot read '{path}': {error.strerror}") from error
        # git may have converted line ends to those of the system.
        found = found.replace("\r\n", "\n")
        if found != text:
            yield _first_difference(SourceFile(str(path), found, path), text, request)


def _first_difference(file: SourceFile, text: str, request: BuildRequest) -> Diagnostic:
    """Return the diagnostic for a file that should contain the text, at the first line that differs."""
    pairs = zip_longest(file.text.split("\n"), text.split("\n"))
    number, found, expected = next((at, *pair) for at, pair in enumerate(pairs, 1) if pair[0] != pair[1])
    span = Span(file, number, 1, number, 1 + len(found or ""))
    notes = []
    if request.templates:
        notes = [Note(f"the templates in '{request.templates.folder}' make it of the spec, and may have changed")]
    return STALE_OUTPUT.at(span, spec=request.spec, expected=_quote(expected), notes=notes)


def _quote(line: str | None) -> str:
    line = (line or "").strip()
    if not line:
        return "nothing"
    return f"'{line if len(line) <= _LONGEST_QUOTE else line[:_LONGEST_QUOTE] + '…'}'"
