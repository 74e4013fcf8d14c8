"""pyarrow, which the extra `sweep` brings."""

from __future__ import annotations

from typing import Any

from linkforge_compile.sweep.errors import SweepError

_MISSING = "a sweep needs the Python package {name}; run \"pip install 'linkforge-compile[sweep]'\""


def arrow() -> Any:
    """Return the module pyarrow; SweepError if it is not installed."""
    try:
        import pyarrow
    except ImportError as error:
        raise SweepError(_MISSING.format(name="pyarrow")) from error
    return pyarrow


def parquet() -> Any:
    """Return the module pyarrow.parquet; SweepError if it is not installed."""
    arrow()
    import pyarrow.parquet

    return pyarrow.parquet


def distributed(instead: str = "") -> Any:
    """Return the module distributed; SweepError, with what to do instead, if it is not installed."""
    try:
        import distributed as module
    except ImportError as error:
        raise SweepError(f"{_MISSING.format(name='distributed')}{instead}") from error
    return module
