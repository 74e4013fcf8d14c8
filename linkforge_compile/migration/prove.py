"""Migrate a xacro and prove it; where the proof fails, macros are written in place, and then the xacro is kept."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, Severity
from linkforge_compile.diagnostics.codes.importing import (
    MACROS_ONLY,
    MIGRATION_TOO_LONG,
    PARAMETER_GONE,
    SPEC_NEEDS_OUTSIDE,
    XACRO_KEPT,
)
from linkforge_compile.listing import Listing
from linkforge_compile.load import Loader
from linkforge_compile.migration.combinations import Arguments
from linkforge_compile.migration.deadline import Deadline, OutOfTimeError
from linkforge_compile.migration.inertia import computed_inertias
from linkforge_compile.migration.kept import kept_spec, parameter_names
from linkforge_compile.migration.migrate import Constraints, Migration, Translator
from linkforge_compile.migration.proof import Comparison, Prover, Specs
from linkforge_compile.migration.report import (
    Figures,
    Proof,
    errors_of_specs,
    faults_of,
    figures_of,
    notes_of,
    proof_of,
)
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import CannotTranslateError
from linkforge_compile.pipeline import parameters_of
from linkforge_compile.source.characters import on_one_line
from linkforge_compile.source.xml_tree import XmlElement

_MOST_COMPILED = 8
"""For how many combinations of arguments an inertia is compared with that of the shapes."""


_CALLS_THEM = "to migrate them, write a xacro beside it that includes it, with a link and a call of each macro"


@dataclass
class Proved:
    """The specs of a xacro by their file names, with their proof; no `proof` if the xacro is used as it is."""

    main: str
    files: Mapping[str, str]
    comparisons: Sequence[Comparison]
    diagnostics: Sequence[Diagnostic]
    proof: Proof | None = None
    figures: Figures | None = None
    """None if the specs that are there were compared, and not translated."""
    names: Mapping[str, str] = field(default_factory=dict)
    """The parameters of the robot by the arguments that they were."""

    @property
    def is_equal(self) -> bool:
        """Whether what was compared is equal, and something was."""
        equal = [one for one in self.comparisons if one.is_equal]
        has_errors = any(one.severity is Severity.ERROR for one in self.diagnostics)
        return bool(equal) and not has_errors and all(one.is_equal or one.refused for one in self.comparisons)


class _Attempt(NamedTuple):
    """Specs, and their comparison with xacro's robot."""

    migration: Migration
    comparisons: Sequence[Comparison]

    @property
    def is_about_robots(self) -> bool:
        """Whether xacro makes a robot for any of the combinations."""
        return any(one.is_equal or one.is_failure for one in self.comparisons)

    @property
    def failures(self) -> int:
        return sum(not (one.is_equal or one.refused) for one in self.comparisons)


@dataclass
class Migrator:
    """Migrates one xacro into a folder, in which relative paths of the specs start.

    `stem` is the name of the robot's spec, without its ending; empty for that of the xacro.
    """

    main: Path
    given: Mapping[str, str]
    folder: Path
    loader: Loader
    sink: Diagnostics
    deadline: Deadline = field(default_factory=Deadline)
    stem: str = ""

    def __post_init__(self) -> None:
        self.sources = Sources(self.main, self.loader, self.sink, self.folder, self.stem)
        self._translator = Translator(self.given, self.sources, self.deadline, self._head)
        self._prover = Prover(self.main, self.loader, self.deadline)

    def run(self) -> Proved:
        """Return the specs with the fewest macros in place that are proved."""
        attempt = self._attempt(Constraints())
        faults = self._prover.faults_of_xacro(self.given)
        # With other arguments it may make a robot.
        if faults and not (isinstance(attempt, _Attempt) and attempt.is_about_robots):
            return self._without_result(faults)
        if isinstance(attempt, CannotTranslateError):
            return self._kept(attempt)
        if isinstance(attempt, OutOfTimeError):
            return self._without_result([self._too_long()])
        attempt = self._with_computed_inertia(self._mended(attempt))
        migration = attempt.migration
        if attempt.failures and migration.calls.kept:
            reason = next(iter(migration.calls.kept.values()))
            return self._kept(CannotTranslateError(reason))
        diagnostics = [*notes_of(migration), *self._faults_of(attempt.comparisons), *self._outside(migration)]
        return self._proved(attempt, diagnostics, figures_of(migration))

    def _mended(self, attempt: _Attempt) -> _Attempt:
        """Return an attempt with fewer failures, if there is one with raw XML or with macros in place."""
        if attempt.failures:
            attempt = self._better(attempt, replace(attempt.migration.constraints, keeps_raw=True))
        for body in _suspects(attempt):
            if not attempt.failures or self.deadline.is_over:
                break
            reason = f"as a module it is another robot, {_first_failure(attempt.comparisons)}"
            known = attempt.migration.constraints
            attempt = self._better(attempt, replace(known, inline={**known.inline, body: reason}))
        return attempt

    def _better(self, attempt: _Attempt, constraints: Constraints) -> _Attempt:
        """Return another attempt if it has fewer failures, else the one."""
        # Most attempts mend nothing, which the failures tell.
        failed = [one.arguments for one in attempt.comparisons if one.is_failure]
        other = self._attempt(constraints, failed[:1])
        if not isinstance(other, _Attempt) or other.failures:
            return attempt
        whole = self._compared(other.migration)
        return whole if whole.failures < attempt.failures else attempt

    def _with_computed_inertia(self, attempt: _Attempt) -> _Attempt:
        """Return an attempt without the inertias that are those of the shapes."""
        migration = attempt.migration
        if attempt.failures:
            return attempt
        robots = self._prover.compiled(self._specs(migration), migration.combinations[:_MOST_COMPILED])
        computed = computed_inertias(robots)
        other = self._attempt(replace(migration.constraints, computed=computed)) if computed else attempt
        return other if isinstance(other, _Attempt) and not other.failures else attempt

    def _attempt(
        self, constraints: Constraints, combinations: Sequence[Arguments] | None = None
    ) -> _Attempt | CannotTranslateError | OutOfTimeError:
        """Translate the xacro and compare the specs, for all combinations of arguments or some."""
        try:
            return self._compared(self._translator.migrate(constraints), combinations)
        except (CannotTranslateError, OutOfTimeError) as error:
            return error

    def _compared(self, migration: Migration, combinations: Sequence[Arguments] | None = None) -> _Attempt:
        chosen = migration.combinations if combinations is None else combinations
        return _Attempt(migration, self._prover.compare(self._specs(migration), chosen))

    def _proved(self, attempt: _Attempt, diagnostics: Sequence[Diagnostic], figures: Figures | None = None) -> Proved:
        migration, comparisons = attempt
        proof = proof_of(migration, comparisons)
        return Proved(migration.main, migration.files, comparisons, diagnostics, proof, figures, migration.names)

    def _faults_of(self, comparisons: Sequence[Comparison]) -> Iterator[Diagnostic]:
        yield from faults_of(comparisons, self.deadline.seconds)

    def _too_long(self) -> Diagnostic:
        return MIGRATION_TOO_LONG.at(None, what="the translation", seconds=f"{self.deadline.seconds:g}")

    def _without_result(self, faults: Sequence[Diagnostic]) -> Proved:
        return Proved("", {}, [], [_with_way_out(one) for one in faults], names={name: name for name in self.given})

    def _specs(self, migration: Migration) -> Specs:
        return Specs(self.folder / migration.main, migration.names, migration.files)

    def _outside(self, migration: Migration) -> Iterator[Diagnostic]:
        """Yield a warning if the specs need a file that only the migration may read."""
        specs = self._specs(migration)
        if found := self._prover.outside_of(specs, self.given):
            yield SPEC_NEEDS_OUTSIDE.at(found.span, spec=str(specs.path), reason=found.message)

    def verify(self) -> Proved:
        """Compare the specs in the folder, which may have been changed since, with the xacro."""
        faults = self._prover.faults_of_xacro(self.given)
        try:
            migration = self._translator.migrate(Constraints())
        except CannotTranslateError as error:
            return self._without_result(faults) if faults else self._kept(error)
        except OutOfTimeError:
            return self._without_result([self._too_long()])
        path, names = self.folder / migration.main, migration.names
        listing, _ = self._parameters_of(path)
        known = names.values() if listing is None else {one.name for one in listing.parameters}
        specs = Specs(path, {argument: name for argument, name in names.items() if name in known})
        missing = [one for one in names if one not in specs.names]
        gone = [PARAMETER_GONE.at(None, spec=str(path), name=names[one], argument=one) for one in missing]
        attempt = _Attempt(migration, self._prover.compare(specs, migration.combinations))
        if faults and not attempt.is_about_robots:
            return self._without_result(faults)
        errors = errors_of_specs(attempt.comparisons)
        others = [one for one in attempt.comparisons if not one.errors]
        return self._proved(attempt, [*gone, *errors, *self._faults_of(others)])

    def _parameters_of(self, path: Path) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
        return parameters_of(path, packages=self.loader.packages, allow_outside=self.loader.roots.is_anywhere)

    def _head(self) -> str:
        """Return the command that makes the specs, with the packages that it needs, as a comment."""
        from linkforge_compile.importers.origin import relative_path

        options = [f"{name}:={value}" for name, value in self.given.items()]
        needed = {name: place for name, place in self.loader.packages.items() if name in self.sources.found}
        for name, place in needed.items():
            options += ("--package", f"{name}={relative_path(self.folder, place)}")
        output = f"{self.stem}.robot.yaml" if self.stem else "."
        command = ("linkforge", "migrate", relative_path(self.folder, self.main), *options, "-o", output)
        return f"# {on_one_line(shlex.join(command))}\n\n"

    def _kept(self, error: CannotTranslateError) -> Proved:
        """Return a spec that uses the xacro as it is, with the arguments as parameters."""
        report = XACRO_KEPT.at(error.where, reason=error.reason)
        faults = [one for one in self.sink.sorted() if one.severity is Severity.ERROR and error.where is None]
        listing, _ = self._parameters_of(self.main)
        known = {one.name: one.default or "" for one in listing.parameters} if listing else {}
        document = self.sources.documents.get(self.main.absolute())
        robot = (document.root.get("name") if document else None) or ""
        text = kept_spec(self.main, self.folder, {**known, **self.given}, self._head(), robot)
        name = f"{self.sources.spec_stem}.robot.yaml"
        specs = Specs(self.folder / name, parameter_names(known), {name: text})
        comparisons = self._prover.compare(specs, [dict(self.given)])
        diagnostics = [*faults, report, *self._faults_of(comparisons)]
        return Proved(name, {name: text}, comparisons, diagnostics, names=specs.names)


def _with_way_out(fault: Diagnostic) -> Diagnostic:
    """Return what is wrong with a xacro; one that only declares macros comes with what to migrate."""
    if fault.code is not MACROS_ONLY:
        return fault
    return replace(fault, notes=(*fault.notes, Note(_CALLS_THEM)))


def _first_failure(comparisons: Sequence[Comparison]) -> str:
    failed = next(one for one in comparisons if one.is_failure)
    return failed.fault or failed.differences[0]


def _suspects(attempt: _Attempt) -> list[XmlElement]:
    """Return the modules, those first whose files or names the failures are about."""
    texts = (text for one in attempt.comparisons for text in (one.fault or "", *one.differences))
    words = Counter(word for text in texts for word in re.findall(r"\w+", text))
    files = attempt.migration.modules
    return sorted(files, key=lambda body: -words[files[body].stem])
