"""The launch arguments of a spec, and what they and the launch file set in a launch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from launch.actions import DeclareLaunchArgument
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from linkforge_compile.expand.arguments import names_in_variant
from linkforge_compile.load import is_xacro
from linkforge_compile.pipeline import CliArgument

if TYPE_CHECKING:
    from launch import LaunchContext

    from linkforge_compile.listing import ListedParameter, Listing


Words: TypeAlias = str | Substitution | Sequence[str | Substitution]
"""A text, a substitution that gives one, or the parts of a text."""

Given: TypeAlias = Mapping[str, bool | int | float | Words | Sequence[float | str | Substitution]]
"""The values that a launch file gives parameters, by name."""


def substitutions_of(name: str, value: object) -> list[Substitution]:
    """Return the substitutions that give a value as text; TypeError, with the name, for a value of another type."""
    if isinstance(value, bool):
        value = "true" if value else "false"
    elif isinstance(value, int | float):
        value = _number(value)
    elif isinstance(value, list | tuple) and any(isinstance(item, int | float) for item in value):
        value = _vector(value)
    try:
        if isinstance(value, Mapping):
            raise TypeError  # launch would take its keys
        normal: list[Substitution] = normalize_to_list_of_substitutions(value)
    except TypeError:
        raise TypeError(
            f"'{name}' takes text, a number, true or false, a list of numbers, or substitutions; found {value!r}"
        ) from None
    return normal


def _number(value: float) -> str:
    # The numbers of numpy are floats whose repr is not that of a float.
    return repr(int(value)) if isinstance(value, int) else repr(float(value))


def _vector(items: Sequence[object]) -> list[object]:
    """Return the parts of the text `[1, 2, 3]`, in which an item may be a substitution."""
    parts: list[object] = []
    for item in items:
        parts += [", " if parts else "[", _number(item) if isinstance(item, int | float) else item]
    return [*parts, "]"]


class LaunchArguments:
    """The launch arguments of the parameters of a spec that the launch file does not give itself.

    `parameters` and `variant` are those that the launch file gives. `prefix` precedes the names of the arguments.

    Raises:
        TypeError: A launch file cannot give a value of this type, or the parameters are not a map.
        ValueError: The spec has no such variant or parameter.

    """

    def __init__(
        self, spec: Path, listing: Listing, parameters: Given | None, *, variant: Words | None, prefix: str
    ) -> None:
        if not isinstance(parameters, Mapping | None):
            raise TypeError(f"the parameters are values by name, {{'NAME': VALUE}}; found {parameters!r}")
        self._spec, self._listing, self._prefix = spec, listing, prefix
        self._given = {name: substitutions_of(name, value) for name, value in (parameters or {}).items()}
        self._variant = substitutions_of("variant", variant) if variant else None
        self._refuse_unknown()
        # If the variant is known only at launch, the defaults shown are those of the spec.
        sets = self._sets_of(variant) if variant and isinstance(variant, str) else {}
        self._defaults = {one.name: sets.get(one.name, one.default) for one in listing.parameters}

    def declarations(self) -> list[DeclareLaunchArgument]:
        """Return the actions that declare the arguments."""
        return [self._declaration(one) for one in self._listing.parameters if one.name not in self._given]

    def _declaration(self, parameter: ListedParameter) -> DeclareLaunchArgument:
        default = self._defaults[parameter.name]
        choices = None
        # launch compares texts; a quantity or a flag can be written in many ways, so the compiler checks those.
        if parameter.choices and parameter.type in {"string", "integer"}:
            texts = list(map(str, parameter.choices))
            choices = texts if default is None or default in texts else None
        about = ", ".join(filter(None, (parameter.type, "" if choices else parameter.limits)))
        description = f"{' '.join(parameter.description.split())} {f'({about})' if about else ''}".strip()
        return DeclareLaunchArgument(
            self._prefix + parameter.name, default_value=default, description=description, choices=choices
        )

    def _refuse_unknown(self) -> None:
        # The files that a xacro includes may depend on its arguments and declare further ones.
        if is_xacro(self._spec):
            return
        declared = [one.name for one in self._listing.parameters]
        for name in self._given:
            if name not in declared:
                hint = _did_you_mean(name, declared, "parameters")
                raise ValueError(f"{self._spec} has no parameter named '{name}'{hint}")

    def values(self, context: LaunchContext) -> tuple[str | None, dict[str, CliArgument]]:
        """Return the variant and the values of parameters in a launch.

        Raises:
            SubstitutionFailure: A parameter has no value, or the spec has no such variant.

        """
        variant = None if self._variant is None else str(perform_substitutions(context, self._variant)) or None
        values = self._assignments(context)
        self._require_values(variant, values)
        return variant, values

    def _assignments(self, context: LaunchContext) -> dict[str, CliArgument]:
        """Return the values of parameters; one at its default is omitted, since the spec may compute the default."""
        values = {
            name: CliArgument("<launch file>", name, perform_substitutions(context, value))
            for name, value in self._given.items()
        }
        for name, default in self._defaults.items():
            argument = self._prefix + name
            value = context.launch_configurations.get(argument)
            if name not in values and value is not None and value != default:
                values[name] = CliArgument("<launch argument>", argument, value)
        return values

    def _require_values(self, variant: str | None, values: Mapping[str, CliArgument]) -> None:
        """Refuse missing values with a message for launch files; that of the compiler names command-line options."""
        try:
            sets = self._sets_of(variant)
        except ValueError as error:
            raise SubstitutionFailure(str(error)) from None
        set_ = values.keys() | sets.keys()
        missing = [one.name for one in self._listing.parameters if one.is_required and one.name not in set_]
        if missing:
            names = ", ".join(f"'{self._prefix}{name}'" for name in missing)
            raise SubstitutionFailure(
                f"{self._spec} needs launch arguments that have no value: {names}; "
                "the 'arguments' of RobotDescription, put into the launch description, declare them"
            )

    def _sets_of(self, variant: str | None) -> Mapping[str, str]:
        """Return the values that a variant, or several (`a+b`), sets; ValueError for an unknown variant."""
        variants = self._listing.variants
        sets: dict[str, str] = {}
        for name in names_in_variant(variant, variants):
            if name not in variants:
                hint = _did_you_mean(name, [*variants], "variants")
                raise ValueError(f"{self._spec} has no variant named '{name}'{hint}")
            sets |= variants[name]
        return sets


def _did_you_mean(name: str, declared: Sequence[str], things: str) -> str:
    """Return a hint with the declared name that resembles an unknown one, else with all declared names."""
    from linkforge_compile.diagnostics.suggest import did_you_mean

    there_are = f"; its {things} are {', '.join(declared)}" if declared else f"; it declares no {things}"
    return did_you_mean(name, declared) or there_are
