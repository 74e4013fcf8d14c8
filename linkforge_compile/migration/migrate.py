"""Migrate a xacro: expand it twice, to learn what its macros are and to write them as modules."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain, count
from pathlib import Path
from typing import TypedDict

from linkforge_compile.diagnostics import Note
from linkforge_compile.migration.attachment import (
    find_attachment,
    outer_parts,
    repeated_parts,
    settings_outside,
)
from linkforge_compile.migration.blocks import form_of
from linkforge_compile.migration.calls import Calls, Plan, no_module
from linkforge_compile.migration.combinations import Arguments, combinations_of, domain_of
from linkforge_compile.migration.constants import constant_of, example_of
from linkforge_compile.migration.deadline import Deadline
from linkforge_compile.migration.evaluate import Called
from linkforge_compile.migration.expand import Expander
from linkforge_compile.migration.files import FileMaker
from linkforge_compile.migration.heads import as_comment, comments_above
from linkforge_compile.migration.inertia import Place
from linkforge_compile.migration.materials import materials_in
from linkforge_compile.migration.shared import with_shared
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import (
    MAP,
    UNKNOWN,
    UNSET,
    CannotTranslateError,
    NoModuleError,
    NotConstantError,
    Parts,
    Symbol,
    constant,
    is_literal,
    kind_of,
    literal_of,
    same_text,
    sources_of,
    symbols_of,
    value_of,
)
from linkforge_compile.migration.template import FileDraft, Spec, split
from linkforge_compile.source.xml_tree import XmlElement

_MOST_ROUNDS = 20


@dataclass
class Migration:
    """The specs of a xacro by their file names, the robot first, and what is known of how they were made."""

    main: str
    files: dict[str, str]
    expander: Expander
    calls: Calls
    specs: Mapping[FileDraft, Spec]
    constraints: Constraints
    """Those with which another attempt has the same result."""

    @property
    def modules(self) -> dict[XmlElement, FileDraft]:
        """The modules that something uses, by the bodies of their macros."""
        return {body: module.file for body, module in self.calls.modules.items() if module.file in self.specs}

    @property
    def names(self) -> dict[str, str]:
        """The parameters of the robot by the arguments that they were."""
        robot = self.specs[self.expander.robot]
        return {name: robot.names[symbol] for name, symbol in self.expander.arguments.items()}

    @property
    def domains(self) -> dict[str, tuple[str, ...]]:
        """The values of each argument for which the specs are proved, the given one first."""
        given, symbols = self.expander.given, self.expander.arguments
        return {name: domain_of(symbol, given.get(name), _default(symbol)) for name, symbol in symbols.items()}

    @property
    def combinations(self) -> list[Arguments]:
        """The arguments for which the specs are proved, the given ones first; defaults are omitted."""
        given, symbols = self.expander.given, self.expander.arguments
        return [
            {name: value for name, value in one.items() if name in given or value != _default(symbols[name])}
            for one in combinations_of(self.domains)
        ]


def _default(symbol: Symbol) -> str | None:
    """Return the default of an argument as its text; None if there is none, or it depends on others."""
    if symbol.value is None or not is_literal(symbol.value):
        literal = literal_of(value_of(symbol.value)) if symbol.value else UNSET
        return None if literal is UNSET else str(literal)
    return "".join(map(str, symbol.value))


class Options(TypedDict):
    """The options of FileMaker."""

    keeps_raw: bool
    computed: frozenset[Place]
    packages: Mapping[str, str]
    folder: Path


@dataclass(frozen=True)
class Constraints:
    """What an attempt starts with: macros that are no modules, and arguments that have one value.

    `plan` is that of an attempt with the same arguments, so that this one need not find it again.
    """

    inline: Mapping[XmlElement, str] = field(default_factory=dict)
    """Why macros are no modules, by their bodies."""
    pinned: frozenset[str] = frozenset()
    needed: Mapping[str, Note] = field(default_factory=dict)
    """Where the values of these arguments are needed."""
    keeps_raw: bool = False
    """Whether parts that are valid for some outcomes of conditions only are kept for others, as raw XML."""
    computed: frozenset[Place] = frozenset()
    """The links whose inertia is computed of their shapes."""
    plan: Plan | None = None


class Translator:
    """Translates one xacro, in several attempts; `head` gives what begins the spec of the robot."""

    def __init__(
        self, given: Mapping[str, str], sources: Sources, deadline: Deadline, head: Callable[[], str] = str
    ) -> None:
        self._given, self._sources, self._deadline, self._head = given, sources, deadline, head
        self._called: dict[frozenset[str], list[Called]] = {}
        """The calls of macros where none is a module, by the arguments that have one value."""

    def migrate(self, constraints: Constraints) -> Migration:
        """Return the specs that the xacro becomes.

        Raises:
            CannotTranslateError: if it cannot be translated at all.
            OutOfTimeError: if the time is over.

        """
        for _ in range(_MOST_ROUNDS):
            inline = dict(constraints.inline)
            try:
                return self._attempt(constraints, inline)
            except NotConstantError as error:
                names = {symbol.wish for symbol in sources_of(error.symbols) if symbol.is_argument}
                if names <= constraints.pinned:
                    raise CannotTranslateError(f"a value that depends on {error}") from None
                note = Note(f"its value is needed here{f': {error.reason}' if error.reason else ''}", error.where)
                needed = {**constraints.needed, **dict.fromkeys(names, note)}
                constraints = replace(constraints, inline=inline, pinned=constraints.pinned | names, needed=needed)
        raise CannotTranslateError("it has no equivalent in the language")

    def _attempt(self, constraints: Constraints, inline: dict[XmlElement, str]) -> Migration:
        """Return the specs, and add to `inline` the macros that cannot be modules."""
        called_by_body = self._called_by_body(constraints.pinned)
        plan = Plan()
        _extend(plan, called_by_body, inline, constraints.plan)
        while True:
            calls = Calls(plan)
            expander = self._expander(constraints.pinned, calls)
            try:
                robot = expander.expand()
                # A module may call a macro that the robot does not, because its condition is false there.
                if others := _by_body(one for one in calls.called if one.macro.body not in called_by_body):
                    called_by_body |= others
                    _extend(plan, others, inline, constraints.plan)
                    continue
                found = replace(constraints, inline=inline, plan=plan)
                return _write_specs(robot, expander, calls, found, self._head)
            except NoModuleError as error:
                body = error.body
                called = called_by_body.get(body, [])
                known = plan.fixed.get(body, frozenset())
                if same := _constant(error.fixed - known, called):
                    plan.fixed[body] = known | same
                elif not error.outer <= plan.outer[body]:
                    plan.outer[body] |= error.outer
                    for one in called:  # what is about these
                        plan.outer[body] |= settings_outside(split(one.content, plan.outer[body])[0])
                    _settle(plan, body, called, inline)
                elif same := _constant(error.named - known, called) or _constant(_parameters(called) - known, called):
                    plan.fixed[body] = known | same
                else:
                    inline[body] = error.reason
                    del plan.modules[body]

    def _called_by_body(self, pinned: frozenset[str]) -> dict[XmlElement, list[Called]]:
        if pinned not in self._called:
            calls = Calls(Plan())
            self._expander(pinned, calls).expand()
            self._called[pinned] = calls.called
        return _by_body(self._called[pinned])

    def _expander(self, pinned: frozenset[str], calls: Calls) -> Expander:
        return Expander(self._sources, self._given, pinned, calls, deadline=self._deadline)


def _by_body(called: Iterable[Called]) -> dict[XmlElement, list[Called]]:
    found: dict[XmlElement, list[Called]] = {}
    for one in called:
        found.setdefault(one.macro.body, []).append(one)
    return found


def _constant(names: Iterable[str], calls: list[Called]) -> frozenset[str]:
    """Return the names that have one value in all calls of a macro, which depends on no name but one of data.

    They are parameters of the macro, or names around its definition.
    """
    values = {name: [one.arguments.get(name) for one in calls] for name in names}
    return frozenset(
        name
        for name, found in values.items()
        if all(one is not None and _is_constant(one) and same_text(one, found[0] or ()) for one in found)
        or not any(name in one.macro.parameters for one in calls)
    )


def _is_constant(parts: Parts) -> bool:
    return all(symbol.constant is not UNSET and not symbols_of(symbol.value or ()) for symbol in symbols_of(parts))


def _parameters(calls: list[Called]) -> frozenset[str]:
    return frozenset(name for one in calls for name in one.arguments)


def _body_of(module: FileDraft) -> XmlElement:
    assert module.root is not None, "a module is a macro"
    return module.root


def _extend(
    plan: Plan, by_body: dict[XmlElement, list[Called]], inline: dict[XmlElement, str], known: Plan | None
) -> None:
    """Plan which macros become modules: those of which each call is one tree of links."""
    plan.single |= {body for body, calls in by_body.items() if len(calls) == 1}
    for body, calls in by_body.items():
        if body in inline:
            continue
        plan.outer[body] = frozenset().union(*(outer_parts(one.content) for one in calls))
        plan.outer[body] |= repeated_parts([one.content for one in calls])
        if known:
            plan.outer[body] |= known.outer.get(body, frozenset())
            plan.fixed[body] = known.fixed.get(body, frozenset())
        plan.modules[body] = _kinds(calls)
        blocks = {name: [one.blocks.get(name, []) for one in calls] for name in calls[0].blocks}
        forms = {name: form_of(found, is_list=name.startswith("**")) for name, found in blocks.items()}
        plan.blocks[body] = {name: form for name, form in forms.items() if form}
        _settle(plan, body, calls, inline)


def _settle(plan: Plan, body: XmlElement, calls: list[Called], inline: dict[XmlElement, str]) -> None:
    """Find the mount of a module in its calls, or write its macro in place."""
    try:
        if any(one.context.is_inside for one in calls):
            raise CannotTranslateError("it makes a part of an element")
        joints = [find_attachment(split(one.content, plan.outer[body])[0]) for one in calls]
        if None in joints:  # for some calls no joint is left that could be the mount
            plan.outer[body] |= {joint.origin for joint in joints if joint and joint.origin}
        return
    except CannotTranslateError as error:
        inline[body] = error.reason
    except NotConstantError as error:
        inline[body] = f"its joints depend on {error}"
    del plan.modules[body]


def _kinds(calls: list[Called]) -> dict[str, str]:
    """Return the kinds of the parameters of a macro by their values."""
    kinds: dict[str, set[str]] = {}
    for one in calls:
        for name, parts in one.arguments.items():
            kinds.setdefault(name, set()).add(_kind(value_of(parts)))
    return {name: next(iter(found)) for name, found in kinds.items() if len(found) == 1}


def _kind(node: ast.expr) -> str:
    """Return the kind of a value, which for a part of data is that of what the file has."""
    kind = kind_of(node)
    if kind != UNKNOWN:
        return kind
    try:
        value = constant_of(node)
    except NotConstantError:
        return MAP if isinstance(example_of(node), dict) else UNKNOWN
    return MAP if isinstance(value, dict) else kind_of(constant(value))


def _write_specs(
    robot: FileDraft, expander: Expander, calls: Calls, constraints: Constraints, head: Callable[[], str]
) -> Migration:
    robot.stem = expander.sources.spec_stem
    specs: dict[FileDraft, Spec] = {}
    stems = {robot.stem}
    for file in (module.file for module in calls.modules.values()):
        endings = chain(("", "_macro"), (f"_{number}" for number in count(2)))
        file.stem = next(stem for ending in endings if (stem := f"{file.name}{ending}") not in stems)
        stems.add(file.stem)
    options: Options = {
        "keeps_raw": constraints.keeps_raw,
        "computed": constraints.computed,
        "packages": expander.sources.packages,
        "folder": expander.sources.spec_folder,
    }
    materials = materials_in(robot.content)
    # Modules that others use come first: what they need decides what these give.
    for module in _inner_first(expander):
        try:
            specs[module] = FileMaker(module, specs, materials, **options).spec(as_comment(module.comment))
        except CannotTranslateError as error:
            raise NoModuleError(_body_of(module), error.reason) from None
        except NotConstantError as error:
            raise no_module(module, error) from None
    above = as_comment("\n".join(comments_above(robot.root)))
    specs[robot] = FileMaker(robot, specs, {}, **options).spec(above + head())
    name = f"{robot.stem}_shared.yaml"
    made, shared = with_shared(specs, name)
    files = {f"{draft.stem}.robot.yaml": made[draft].text for draft in reversed([*made])}
    if shared:
        files[name] = shared.text
    return Migration(f"{robot.stem}.robot.yaml", files, expander, calls, made, constraints)


def _inner_first(expander: Expander) -> list[FileDraft]:
    made: list[FileDraft] = []

    def add(file: FileDraft) -> None:
        for use in file.uses():
            if use.module not in made:
                add(use.module)
                made.append(use.module)

    add(expander.robot)
    return made
