"""Where the robots of a sweep are compiled."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class Place(NamedTuple):
    """So many processes of this machine, or the workers of a scheduler.

    `security` has the files of TLS, by the names that Dask's `Security` has for them.
    """

    jobs: int = 1
    scheduler: str | None = None
    security: Mapping[str, str] = {}

    @property
    def is_here(self) -> bool:
        """Whether this process compiles."""
        return self.scheduler is None and self.jobs == 1
