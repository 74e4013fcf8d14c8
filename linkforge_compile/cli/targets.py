"""Chooses the file of each output from `-o` and `--format`."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile import formats
from linkforge_compile.cli import UsageError
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.file_names import stem_of

_SPEC_ENDINGS = (".yaml", ".yml")
_STANDARD_OUTPUT = ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")
"""Names of standard output; as a file it could not be resolved if it is a pipe, and would be replaced if it is one."""


class Targets(NamedTuple):
    """The target of each format, by the format's name; None for standard output.

    Formats that the robot has nothing for are omitted unless `is_requested`, by `--format` or by name of a file. With
    `are_documents`, the targets are those of the documents of a folder of templates, by the document's name.
    """

    paths: Mapping[str, Path | None]
    is_requested: bool = True
    are_documents: bool = False

    @property
    def formats(self) -> tuple[str, ...]:
        """The names of the formats."""
        return () if self.are_documents else tuple(self.paths)

    @property
    def template_folders(self) -> frozenset[str]:
        """The folders of the templates that linkforge has for the formats."""
        return frozenset(folder for name in self.formats for folder in formats.format_named(name).template_folders)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that rendering to the targets writes, without source maps."""
        written = {name: path for name, path in self.paths.items() if path is not None}
        if self.are_documents:
            return tuple(written.values())
        return tuple(
            path / file for name, path in written.items() for file in formats.format_named(name).files or ("",)
        )

    def folders(self, installed_in: Sequence[str]) -> Mapping[str, Path]:
        """Return the folders where relative paths in the documents start, by format, as far as they are known.

        `installed_in` has the final folder of all of them, or `FORMAT=FOLDER`; UsageError for an unknown format.
        """
        finals: dict[str, Path] = {}
        for word in installed_in:
            name, folder = _format_and_folder(word)
            every = dict.fromkeys((one.name for one in formats.FORMATS), folder)
            finals = finals | {name: folder} if name else every | finals
        folders = {}
        for one in map(formats.format_named, self.formats):
            path = Path(finals[one.name], "" if one.files else "NAME") if one.name in finals else self.paths[one.name]
            if path and one.has_relative_paths:
                folders[one.name] = one.folder_of_documents(path)
        return folders

    def without(self, names: Collection[str]) -> Targets:
        paths = {name: path for name, path in self.paths.items() if name not in names}
        return self._replace(paths=MappingProxyType(paths))

    def require_files(self, option: str, why: str) -> None:
        """Refuse an option that needs files as outputs, not standard output, a device or a pipe."""
        if any(
            path is None or (path.exists() and not (path.is_file() or path.is_dir())) for path in self.paths.values()
        ):
            raise UsageError(f"{option} {why}, so it takes -o with a folder or a file")


def _format_and_folder(word: str) -> tuple[str | None, Path]:
    """Return the format, None for all of them, and the folder of `--installed-in`; UsageError for an unknown format.

    A folder with a `=` in its name has a `/` before it: `./a=b`.
    """
    name, equals, folder = word.partition("=")
    if not equals or "/" in name or "\\" in name:
        return None, Path(word)
    try:
        return formats.format_named(name).name, Path(folder)
    except ValueError as error:
        raise UsageError(f"--installed-in: {error}; for a folder of that name, write './{word}'") from None


def add_target_options(parser: argparse.ArgumentParser) -> None:
    add_output_option(parser)
    about = "; ".join(f"{one.name}: {one.description}" for one in formats.FORMATS)
    default = default_format().name
    _add_formats(
        parser,
        "--format",
        f"the format to write; repeat it for others (default on standard output: {default}); {about}",
    )
    parser.add_argument("--name", help="the name of the outputs in the folder of -o (default: the name of the spec)")


def add_for_option(parser: argparse.ArgumentParser, about: str) -> None:
    """Add `--for`, the formats of a command whose `--format` is the form of what it prints."""
    _add_formats(parser, "--for", about)


def _add_formats(parser: argparse.ArgumentParser, option: str, about: str) -> None:
    # With `choices`, the message for any other name would have no suggestion.
    names = f"{{{','.join(one.name for one in formats.FORMATS)}}}"
    parser.add_argument(
        option, type=_name_of_format, metavar=names, dest="formats", action="append", default=[], help=about
    )


def _name_of_format(word: str) -> str:
    try:
        return formats.format_named(word).name
    except ValueError as error:
        from argparse import ArgumentTypeError

        raise ArgumentTypeError(str(error)) from None


def refuse_formats_as_specs(words: Iterable[str], option: str) -> None:
    """Refuse the name of a format among the specs, as `--format urdf srdf` gives it; a file may have such a name."""
    names = {one.name for one in formats.FORMATS}
    if word := next((word for word in words if word in names and not Path(word).exists()), None):
        raise UsageError(f"{option} takes one format; repeat it for others: write '{option} {word}'")


def add_output_option(parser: argparse.ArgumentParser) -> None:
    written = " and ".join(f"NAME{one.suffix}" for one in formats.FORMATS if one.is_default)
    parser.add_argument(
        "-o",
        "--output",
        metavar="PATH",
        dest="outputs",
        action="append",
        default=[],
        help=f"a folder for {written}, or a file that ends in {alternatives(_file_endings())}; repeat it for the "
        f"file of another format",
    )


def targets_of(name: str, outputs: Sequence[str], chosen: Sequence[str] = ()) -> Targets:
    """Return the target of each format of a spec; UsageError for outputs that contradict each other.

    `chosen` are the formats of `--format`; without it, the outputs decide. `name` is that of the files in a folder.
    """
    if "" in outputs:
        raise UsageError("-o takes a file or a folder, found '': is a variable of the shell empty?")
    if not outputs or (len(outputs) == 1 and file_to_write(outputs[0]) is None):
        return Targets({_only(chosen) or default_format().name: None})
    if len(outputs) > 1 and len(outputs) == len(set(chosen)):
        return Targets({name: _several([output], name)[name] for name, output in zip(chosen, outputs, strict=True)})
    if len(outputs) > 1:
        return Targets(_several(outputs, _only(chosen)))
    (output,) = outputs
    if not is_folder_of_outputs(output, chosen):
        return Targets({_format_of_file(output, _only(chosen)): Path(output)})
    written = [one for one in formats.FORMATS if (one.name in chosen if chosen else one.is_default)]
    if chosen and len(written) == 1 and written[0].files and output.endswith(written[0].suffix):
        return Targets({written[0].name: Path(output)})  # such as arm_moveit_config, not arm_moveit_config/
    paths = {one.name: Path(output, f"{name}{one.suffix}") for one in written}
    return Targets(paths, is_requested=bool(chosen))


def is_folder_of_outputs(output: str, chosen: Sequence[str] = ()) -> bool:
    """Whether `-o` names a folder; UsageError for a file of another kind than outputs of the chosen formats are."""
    return file_to_write(output) is not None and not _is_file(output, _file_endings(chosen))


def _only(chosen: Sequence[str]) -> str | None:
    """Return the one format of `--format`, None for none; UsageError for several."""
    if len(set(chosen)) > 1:
        raise UsageError(f"several --format go with -o FOLDER/, or with -o FILE for each; found {' and '.join(chosen)}")
    return chosen[0] if chosen else None


def default_format() -> formats.Format:
    """Return the format on standard output unless another is requested."""
    return formats.FORMATS[0]


def targets_of_documents(names: Sequence[str], outputs: Sequence[str]) -> Targets | None:
    """Return the targets of a folder of templates' documents; None if `outputs` name files of formats.

    Raises:
        UsageError: Several documents would go to standard output.

    """
    if not outputs or (len(outputs) == 1 and file_to_write(outputs[0]) is None):
        if len(names) > 1:
            found = f"found {len(names)}: {', '.join(names)}"
            raise UsageError(f"standard output takes one document of --template, {found}; write -o FOLDER/")
        return Targets({names[0]: None}, are_documents=True)
    if len(outputs) == len(names) == 1 and _is_document(outputs[0], names[0]):
        return Targets({names[0]: Path(outputs[0])}, are_documents=True)
    if len(outputs) > 1 or not outputs[0] or _is_file(outputs[0], _file_endings()):
        return None
    return Targets({name: Path(outputs[0], name) for name in names}, are_documents=True)


def _is_document(output: str, name: str) -> bool:
    """Whether `-o` names a document's file: one with a suffix, but not of a format that the document has not."""
    path = Path(output)
    is_folder = output.endswith(("/", "\\")) or path.is_dir()
    is_of_format = format_by_suffix(output) is not None and path.suffix != Path(name).suffix
    return not is_folder and bool(path.suffix) and not is_of_format


def file_to_write(output: str | None) -> Path | None:
    """Return the output file that an option names, None for standard output: no option, or one of its names."""
    return None if output is None or output in _STANDARD_OUTPUT else Path(output)


def imported_spec(robot: str, output: str | None) -> Path | None:
    """Return the file of an imported spec, which is NAME.robot.yaml in a folder; None for standard output."""
    path = file_to_write(output)
    if output is None or path is None:
        return None
    return path if _is_file(output, _SPEC_ENDINGS) else path / f"{name_of(robot)}.robot.yaml"


def name_of(spec: str) -> str:
    """Return the name of a spec's outputs: arm for arm.robot.yaml, arm.xml and arm.urdf.xacro."""
    if spec == "-":
        return "robot"
    return stem_of(spec)


def _several(outputs: Sequence[str], chosen: str | None) -> dict[str, Path | None]:
    paths: dict[str, Path | None] = {}
    for output in outputs:
        if file_to_write(output) is None:
            raise UsageError(f"-o {output} is standard output, which takes one format; leave the other -o out")
        if not _is_file(output, _file_endings([chosen] if chosen else [])):
            raise UsageError(f"-o takes several files, one a format, or one folder; found the folder '{output}'")
        format_ = _format_of_file(output, chosen)
        if format_ in paths:
            raise UsageError(f"'{paths[format_]}' and '{output}' would be the same {format_}; name one of them")
        paths[format_] = Path(output)
    return paths


def _suffixes() -> dict[str, str]:
    """Return the names of the formats of one file by suffix, such as `.urdf` or `_controllers.yaml`."""
    return {one.suffix: one.name for one in formats.FORMATS if not one.files}


def _file_endings(chosen: Sequence[str] = ()) -> tuple[str, ...]:
    """Return how the names of outputs may end; with `--format`, a file may have any name, as `joint_limits.yaml`."""
    of_chosen = (Path(f"NAME{suffix}").suffix for suffix, name in _suffixes().items() if name in chosen)
    return tuple(dict.fromkeys((*_suffixes(), *of_chosen, ".xml")))


def format_by_suffix(output: str) -> str | None:
    """Return the name of the format of one file whose suffix ends the name of an output, None for no such format.

    The suffix alone names a file too: `joint_limits.yaml` is that of `_joint_limits.yaml`.
    """
    found = [suffix for suffix in _suffixes() if output.endswith(suffix) or Path(output).name == suffix.lstrip("_")]
    return _suffixes()[max(found, key=len)] if found else None


def _format_of_file(output: str, chosen: str | None) -> str:
    """Return the format of a file by its suffix; a file with any other suffix may have any format."""
    of_suffix = format_by_suffix(output)
    if chosen and of_suffix not in (None, chosen):
        raise UsageError(f"--format {chosen} does not go into '{output}'")
    return chosen or of_suffix or default_format().name


def _is_file(output: str, endings: tuple[str, ...]) -> bool:
    """Whether `-o` names a file: one with one of the endings, a device or a pipe. Other words name folders.

    UsageError for any other suffix: `-o arm.robot.yaml` would replace the spec, or create a folder of that name.
    """
    path = Path(output)
    if output.endswith(("/", "\\")) or path.is_dir():
        return False
    if path.suffix and not path.name.endswith(endings) and format_by_suffix(output) is None:
        raise UsageError(
            f"-o takes a folder, or a file that ends in {alternatives(endings)}; found '{output}'"
            f" (for a folder of that name, write '{output}/')"
        )
    return bool(path.suffix) or (path.exists() and not path.is_file())
