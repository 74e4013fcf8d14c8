"""The time that one migration may take, and how far it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic


class OutOfTimeError(Exception):
    """The time of a migration is over."""


@dataclass(frozen=True)
class Deadline:
    """The end of the time for all attempts and proofs of one migration; it begins when this is made.

    `tell` is told what is being done, more often than anyone wants to read it.
    """

    seconds: float = 300
    tell: Callable[[str], None] = lambda _text: None
    begin: float = field(default_factory=monotonic)

    @property
    def is_over(self) -> bool:
        return monotonic() - self.begin > self.seconds

    def check(self) -> None:
        """Raise OutOfTimeError if the time of a translation is over."""
        self.tell("translating")
        if self.is_over:
            raise OutOfTimeError
