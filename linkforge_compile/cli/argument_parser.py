"""argparse, for help and for command lines that are not plain or not right."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.cli.parser import Parser


class _Once(argparse.Action):
    """Takes the value of an option that may be given once, as every one is that collects nothing.

    Of two values, none is forgotten in silence.
    """

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        option_string: str | None = None,
    ) -> None:
        given: dict[str, object] = namespace.__dict__.setdefault("given", {})
        if option_string is not None and self.dest in given:
            raise argparse.ArgumentError(self, f"may be given once, found '{given[self.dest]}' and '{values}'")
        given[self.dest] = values
        setattr(namespace, self.dest, values)


def argument_parser(declared: Parser) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=declared.program,
        usage=declared.usage,
        description=f"{declared.summary[0].upper()}{declared.summary[1:]}.",
        epilog=declared.epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.register("action", None, _Once)
    groups = {}
    for names, facts, title in declared.declared:
        if title is not None and title not in groups:
            groups[title] = parser.add_argument_group(title)
        # The types are ignored: argparse says of each fact what it is, and refuses another one.
        (parser if title is None else groups[title]).add_argument(*names, **facts)  # type: ignore[arg-type]
    return parser
