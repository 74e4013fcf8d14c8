"""One build: a spec compiled, and what comes out of it told, written or compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.banner import banner_of
from linkforge_compile.cli.exits import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.one_spec import compile_spec
from linkforge_compile.cli.options import format_options_of
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.cli.telling import say, tell
from linkforge_compile.formats import Rendering, format_named, render_documents
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Sequence

    from linkforge_compile.cli.targets import Targets
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.user_templates import TemplateFolder
    from linkforge_compile.pipeline import Compilation


class Output(NamedTuple):
    """A text and where it goes; None is standard output."""

    path: Path | None
    text: str


class Order(NamedTuple):
    """What is to be built: a spec, with its parameters as typed, into targets, by a user's templates if any."""

    spec: str
    assignments: list[str]
    targets: Targets
    templates: TemplateFolder | None = None

    @property
    def template_files(self) -> tuple[Path, ...]:
        """The templates that were read so far."""
        return self.templates.files if self.templates else ()


def targets_for(robot: Robot, targets: Targets) -> tuple[Targets, tuple[Diagnostic, ...]]:
    """Return the targets that a robot has something for, and why it has nothing for a requested one."""
    missing = {name: why for name in targets.formats if (why := format_named(name).missing(robot))}
    return targets.without(missing), tuple(missing.values()) if targets.is_requested else ()


def paths_for(robot: Robot, targets: Targets) -> tuple[Path, ...]:
    """Return the files that the formats of targets make of a robot."""
    return tuple(
        _place(path, name)
        for format_, path in targets.paths.items()
        if path is not None
        for name in format_named(format_).file_names(robot)
    )


def _place(target: Path, name: str) -> Path:
    """Return the file of a document: the target, or a file below it for a format of several files."""
    return target / name if name else target


def compile_order(order: Order, arguments: argparse.Namespace) -> Compilation:
    """Compile the spec, as the options of `linkforge compile` say."""
    folder = order.targets.folder if arguments.installed_in is None else Path(arguments.installed_in)
    return compile_spec(order.spec, order.assignments, arguments, output=folder, formats=order.targets.formats)


def deliver(order: Order, compilation: Compilation, arguments: argparse.Namespace) -> int:
    """Tell of a compilation and write or compare what comes out of it; return the exit code."""
    outputs, faults = ((), ()) if compilation.robot is None else _outputs(compilation.robot, order, arguments)
    if outputs:
        from linkforge_compile.cli.output import refuse_to_replace

        made_from = (*compilation.files, *order.template_files)
        refuse_to_replace(made_from, (*(output.path for output in outputs), file_to_write(arguments.depfile)))
    stale = _stale(outputs, order, compilation.robot) if arguments.check else ()
    report = (
        sorted((*compilation.diagnostics, *faults), key=lambda one: one.order) if faults else compilation.diagnostics
    )
    if tell((*report, *stale), arguments) or not outputs:
        return FAULTY_SPEC
    if arguments.depfile is None:
        _put(outputs, arguments)
    else:
        # Who asks for a depfile is a build, which tells itself what it makes; colcon takes a word on standard error
        # for a warning.
        inputs = (*compilation.files, *order.template_files)
        _write((*outputs, _depfile(outputs, inputs, arguments.depfile)))
    return OK


def _outputs(
    robot: Robot, order: Order, arguments: argparse.Namespace
) -> tuple[tuple[Output, ...], tuple[Diagnostic, ...]]:
    """Return what goes where, all of it rendered before any is written; nothing, and why, where that cannot be."""
    targets, faults = targets_for(robot, order.targets)
    if faults:
        return (), faults
    name = Path(order.spec).name
    banner = None if order.spec == "-" else banner_of(on_one_line(name))
    options = format_options_of(arguments)
    if order.templates is None:
        rendering = Rendering(options, banner=banner, has_map=arguments.source_map)
        return tuple(_rendered(robot, targets, rendering)), ()
    from linkforge_compile.formats.user_templates import TemplateError

    try:
        if targets.are_documents:
            texts = render_documents(robot, order.templates, options, banner or "")
            outputs = tuple(Output(path, texts[name]) for name, path in targets.paths.items())
        else:
            rendering = Rendering(options, banner=banner, templates=order.templates)
            outputs = tuple(_rendered(robot, targets, rendering))
        return outputs, order.templates.unused
    except TemplateError as error:
        return (), error.diagnostics


def _rendered(robot: Robot, targets: Targets, rendering: Rendering) -> Iterator[Output]:
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


def _stale(outputs: Sequence[Output], order: Order, robot: Robot | None) -> Iterator[Diagnostic]:
    from linkforge_compile.cli.uptodate import difference
    from linkforge_compile.source import Span

    # Tools that gather diagnostics show those that have a place only.
    whole = Span(robot.source.span.file, 1, 1, 1, 1) if robot and robot.source else None
    templates = order.templates.folder if order.templates else None
    for path, text in outputs:
        assert path is not None, "only files are compared"
        if found := difference(path, text, order.spec, whole, templates):
            yield found


def _put(outputs: Sequence[Output], arguments: argparse.Namespace) -> None:
    written = frozenset() if arguments.check else _write(outputs)
    for path, _ in outputs:
        if path is not None:
            say(f"wrote {path}" if path in written else f"{path} is up to date", arguments)


def _write(outputs: Sequence[Output]) -> frozenset[Path]:
    """Write all outputs, or none where one cannot be; return the files that had to be written."""
    from linkforge_compile.cli.output import write_changed

    texts = {output.path: output.text for output in outputs if output.path is not None}
    return write_changed(texts, next((output.text for output in outputs if output.path is None), None))


def _depfile(outputs: Sequence[Output], inputs: Sequence[Path], name: str) -> Output:
    from linkforge_compile.cli.depfile import inputs_of, make_rules

    targets = [output.path for output in outputs if output.path is not None]
    return Output(file_to_write(name), make_rules(targets, inputs_of(inputs)))
