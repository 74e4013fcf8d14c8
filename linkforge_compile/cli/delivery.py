"""Reports on builds and writes their outputs, all after the last one is rendered."""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Sequence
from pathlib import Path

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.build import Build, Output
from linkforge_compile.cli.reports import errors_of, format_diagnostics, print_status, select, write_to_stderr
from linkforge_compile.cli.specs import count
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.diagnostics import Diagnostic

_LISTED = 3
"""The most files up to date of which each has a line."""


def deliver(builds: Sequence[Build], arguments: argparse.Namespace, faults: tuple[Diagnostic, ...] = ()) -> int:
    """Report on builds, write the outputs of those without errors, and return the exit code.

    `faults` are those of the search for specs. Nothing is written if an output would replace a source of any build.
    """
    if any(build.outputs for build in builds):
        from linkforge_compile.cli.output import refuse_to_replace

        outputs = [output.path for build in builds for output in build.outputs]
        sources = dict.fromkeys(source for build in builds for source in build.sources)
        refuse_to_replace(sources, (*outputs, file_to_write(arguments.depfile)))
    chosen = select(_diagnostics_of(builds, faults), arguments)
    runs = [select(build.diagnostics, arguments) for build in builds]
    write_to_stderr(format_diagnostics(chosen, arguments, runs))
    right = [build for build, run in zip(builds, runs, strict=True) if build.outputs and not errors_of(run)]
    is_whole = len(right) == len(builds) and not faults
    if arguments.depfile is not None:
        # A build system prints its own status, and colcon shows any output on standard error as a warning.
        _write(right, _depfile(right, arguments.depfile) if is_whole else ())
    elif right or len(builds) != 1:
        written = frozenset() if arguments.check else _write(right)
        _print_status(builds, right, written, chosen, arguments)
    return OK if is_whole else FAULTY_SPEC


def _diagnostics_of(builds: Sequence[Build], faults: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of all builds, each once; those of some variants of a spec say of which."""
    if len(builds) == 1:
        return (*faults, *builds[0].diagnostics)
    from linkforge_compile.diagnostics.reports import merge_reports, without_repeats

    runs = defaultdict[str, dict[str, tuple[Diagnostic, ...]]](dict)
    for build in builds:
        runs[build.spec][f"variant '{build.variant}'"] = build.diagnostics
    of_specs = (one for of_variants in runs.values() for one in merge_reports(of_variants))
    return without_repeats((*faults, *of_specs))


def _print_status(
    builds: Sequence[Build],
    right: Sequence[Build],
    written: frozenset[Path],
    diagnostics: tuple[Diagnostic, ...],
    arguments: argparse.Namespace,
) -> None:
    """Print a line for each file of a single build, one summary of several builds or of many files up to date."""
    paths = [output.path for build in right for output in build.outputs if output.path is not None]
    if len(builds) == 1:
        unchanged = [path for path in paths if path not in written]
        is_short = len(unchanged) <= _LISTED
        for path in paths:
            if path in written:
                print_status(f"wrote {path}", arguments)
            elif is_short:
                print_status(f"{path} is up to date", arguments)
        if not is_short:
            print_status(f"{count(len(unchanged), 'file')} are up to date", arguments)
        return
    from linkforge_compile.diagnostics.render_text import summary

    states = Counter("written" if path in written else "up to date" for path in paths)
    files = "".join(f", {count(number, 'file')} {state}" for state, number in states.items())
    print_status(f"{_verb(arguments)} {_right_specs(builds, right)}{files}: {summary(diagnostics)}", arguments)


def _verb(arguments: argparse.Namespace) -> str:
    return "checked" if arguments.check else "compiled"


def _right_specs(builds: Sequence[Build], right: Sequence[Build]) -> str:
    """Return such as "3 specs", or "1 of 3 specs" where others have errors in a variant."""
    specs = {build.spec for build in builds}
    faulty = {build.spec for build in builds if build not in right}
    if not faulty:
        return count(len(specs), "spec")
    return f"{len(specs) - len(faulty) or 'none'} of {count(len(specs), 'spec')}"


def _write(builds: Sequence[Build], further: Sequence[Output] = ()) -> frozenset[Path]:
    """Write all outputs; return the files that were written, without those that are up to date."""
    from linkforge_compile.cli.output import write_changed

    outputs = (*(output for build in builds for output in build.outputs), *further)
    texts = {output.path: output.text for output in outputs if output.path is not None}
    return write_changed(texts, next((output.text for output in outputs if output.path is None), None))


def _depfile(builds: Sequence[Build], name: str) -> tuple[Output, ...]:
    """Return the depfile, with a rule for the outputs of each spec."""
    from linkforge_compile.cli.output import inputs_of, make_rules

    def rule(build: Build) -> str:
        paths = [output.path for output in build.outputs if output.path is not None]
        return make_rules(paths, inputs_of(build.sources, build.template_folders))

    return (Output(file_to_write(name), "".join(map(rule, builds))),)
