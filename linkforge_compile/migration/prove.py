"""Migrate a xacro and prove it; where the proof fails, macros are written in place, and then the xacro is kept."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Severity
from linkforge_compile.diagnostics.codes.importing import PARAMETER_GONE, SPEC_NEEDS_OUTSIDE, XACRO_KEPT
from linkforge_compile.listing import Listing
from linkforge_compile.load import Loader
from linkforge_compile.migration.combinations import Arguments
from linkforge_compile.migration.inertia import computed_inertias
from linkforge_compile.migration.kept import kept_spec, parameter_names
from linkforge_compile.migration.migrate import Migration, Settled, migrate, stem_of
from linkforge_compile.migration.proof import Comparison, Prover, Specs
from linkforge_compile.migration.report import Figures, faults_of, figures_of, notes_of
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import CannotTranslateError
from linkforge_compile.pipeline import parameters_of
from linkforge_compile.source.characters import on_one_line
from linkforge_compile.source.xml_tree import XmlElement

_MOST_COMPILED = 8
"""For how many combinations of arguments an inertia is compared with that of the shapes."""


@dataclass
class Proved:
    """The specs of a xacro by their file names, with their proof; no `figures` if the xacro is used as it is."""

    main: str
    files: Mapping[str, str]
    comparisons: Sequence[Comparison]
    diagnostics: Sequence[Diagnostic]
    figures: Figures | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    """The parameters of the robot by the arguments that they were."""

    @property
    def is_equal(self) -> bool:
        """Whether what was compared is equal, and something was."""
        equal = [one for one in self.comparisons if one.is_equal]
        has_errors = any(one.severity is Severity.ERROR for one in self.diagnostics)
        return bool(equal) and not has_errors and all(one.is_equal or one.refused for one in self.comparisons)


@dataclass
class Migrator:
    """Migrates one xacro into a folder, in which relative paths of the specs start."""

    main: Path
    given: Mapping[str, str]
    folder: Path
    loader: Loader
    sink: Diagnostics

    def __post_init__(self) -> None:
        self.sources = Sources(self.main, self.loader, self.sink, self.folder)

    def run(self) -> Proved:
        """Return the specs with the fewest macros in place that are proved."""
        prover = Prover(self.main, self.loader)
        settled = Settled()
        migration = self._migrated(settled)
        if isinstance(migration, CannotTranslateError):
            return self._kept(migration, prover)
        comparisons = self.prove(migration, prover)
        if _failures(comparisons):
            other = self._migrated(Settled(keeps_raw=True))
            if isinstance(other, Migration):
                found = self.prove(other, prover)
                if _failures(found) < _failures(comparisons):
                    settled, migration, comparisons = Settled(keeps_raw=True), other, found
        for body in _suspects(migration, comparisons):
            if _failures(comparisons) == 0:
                break
            reason = f"as a module it is another robot, {_first_failure(comparisons)}"
            tried = replace(settled, inline={**settled.inline, body: reason})
            other = self._migrated(tried)
            if isinstance(other, CannotTranslateError):
                continue
            # Most attempts mend nothing, which one of the failures tells.
            failed = next(one.arguments for one in comparisons if not (one.is_equal or one.refused))
            if _failures(self.prove(other, prover, [failed])):
                continue
            found = self.prove(other, prover)
            if _failures(found) < _failures(comparisons):
                settled, migration, comparisons = tried, other, found
        if _failures(comparisons) and migration.calls.kept:
            reason = next(iter(migration.calls.kept.values()))
            return self._kept(CannotTranslateError(reason), prover)
        migration, comparisons = self._with_computed_inertia(migration, comparisons, settled, prover)
        diagnostics = [*notes_of(migration), *faults_of(comparisons), *self._outside(migration, prover)]
        figures = figures_of(migration, comparisons)
        return Proved(migration.main, migration.files, comparisons, diagnostics, figures, migration.names)

    def _with_computed_inertia(
        self, migration: Migration, comparisons: list[Comparison], settled: Settled, prover: Prover
    ) -> tuple[Migration, list[Comparison]]:
        """Return the specs without the inertias that are those of the shapes."""
        if _failures(comparisons):
            return migration, comparisons
        computed = computed_inertias(prover.compiled(self._specs(migration), migration.combinations[:_MOST_COMPILED]))
        if not computed:
            return migration, comparisons
        other = self._migrated(replace(settled, computed=computed))
        found = self.prove(other, prover) if isinstance(other, Migration) else []
        if isinstance(other, Migration) and not _failures(found):
            return other, found
        return migration, comparisons

    def _specs(self, migration: Migration) -> Specs:
        return Specs(self.folder / migration.main, migration.names, migration.files)

    def _outside(self, migration: Migration, prover: Prover) -> Iterator[Diagnostic]:
        """Yield a warning if the specs need a file that only the migration may read."""
        specs = self._specs(migration)
        if found := prover.outside_of(specs, self.given):
            yield SPEC_NEEDS_OUTSIDE.at(found.span, spec=str(specs.path), reason=found.message)

    def verify(self) -> Proved:
        """Compare the specs in the folder, which may have been changed since, with the xacro."""
        prover = Prover(self.main, self.loader)
        migration = self._migrated(Settled())
        if isinstance(migration, CannotTranslateError):
            return self._kept(migration, prover)
        path, names = self.folder / migration.main, migration.names
        listing, _ = self._parameters_of(path)
        known = names.values() if listing is None else {one.name for one in listing.parameters}
        missing = [name for name in names if names[name] not in known]
        specs = Specs(path, {argument: name for argument, name in names.items() if name in known})
        comparisons = prover.compare(specs, migration.combinations)
        gone = [PARAMETER_GONE.at(None, spec=str(path), name=names[one], argument=one) for one in missing]
        figures = figures_of(migration, comparisons)
        faults = [*gone, *faults_of(comparisons)]
        return Proved(migration.main, migration.files, comparisons, faults, figures, names)

    def _parameters_of(self, path: Path) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
        return parameters_of(path, packages=self.loader.packages, allow_outside=self.loader.roots.is_anywhere)

    def _migrated(self, settled: Settled) -> Migration | CannotTranslateError:
        try:
            return migrate(self.given, self.sources, settled, self._head)
        except CannotTranslateError as error:
            return error

    def _head(self) -> str:
        """Return the command that makes the specs, with the packages that it needs, as a comment."""
        from linkforge_compile.importers.origin import relative_path

        options = [f"{name}:={value}" for name, value in self.given.items()]
        needed = {name: place for name, place in self.loader.packages.items() if name in self.sources.found}
        for name, place in needed.items():
            options += ("--package", f"{name}={relative_path(self.folder, place)}")
        command = ("linkforge", "migrate", relative_path(self.folder, self.main), *options, "-o", ".")
        return f"# {on_one_line(shlex.join(command))}\n\n"

    def prove(
        self, migration: Migration, prover: Prover, combinations: Sequence[Arguments] | None = None
    ) -> list[Comparison]:
        """Compare the specs for all combinations or some."""
        if combinations is None:
            combinations = migration.combinations
        return prover.compare(self._specs(migration), combinations)

    def _kept(self, error: CannotTranslateError, prover: Prover) -> Proved:
        """Return a spec that uses the xacro as it is, with the arguments as parameters."""
        report = XACRO_KEPT.at(error.where, reason=error.reason)
        faults = [one for one in self.sink.sorted() if one.severity is Severity.ERROR and error.where is None]
        listing, _ = self._parameters_of(self.main)
        known = {one.name: one.default or "" for one in listing.parameters} if listing else {}
        document = self.sources.documents.get(self.main.absolute())
        robot = (document.root.get("name") if document else None) or ""
        text = kept_spec(self.main, self.folder, {**known, **self.given}, self._head(), robot)
        name = f"{stem_of(self.main)}.robot.yaml"
        specs = Specs(self.folder / name, parameter_names(known), {name: text})
        comparisons = prover.compare(specs, [dict(self.given)])
        diagnostics = [*faults, report, *faults_of(comparisons)]
        return Proved(name, {name: text}, comparisons, diagnostics, names=specs.names)


def _first_failure(comparisons: Sequence[Comparison]) -> str:
    failed = next(one for one in comparisons if not (one.is_equal or one.refused))
    return failed.fault or failed.differences[0]


def _suspects(migration: Migration, comparisons: Sequence[Comparison]) -> list[XmlElement]:
    """Return the modules, those first whose files or names the failures are about."""
    texts = "\n".join(text for one in comparisons for text in (one.fault or "", *one.differences))
    files = migration.modules
    return sorted(files, key=lambda body: files[body].stem not in texts)


def _failures(comparisons: Sequence[Comparison]) -> int:
    return sum(not (one.is_equal or one.refused) for one in comparisons)
