"""Reads SDF and URDF with libsdformat, Gazebo's parser, by a small program that is built on first use."""

from __future__ import annotations

import hashlib
import json
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.programs import program

_SOURCES = Path(__file__).parent / "sdf_judge"
_CACHE = Path(__file__).parents[1] / ".pytest_cache"
_MISSING = "libsdformat 12 is not installed; it comes with Debian's package libsdformat-dev"

Part = dict[str, Any]


@dataclass(frozen=True)
class Read:
    """What libsdformat reads in a file: its models, and their parts by name; see sdf_judge/main.cc for units.

    `errors` are those of the parser, `printed` is what it writes to standard error.
    """

    errors: list[str]
    printed: str
    models: dict[str, Part]
    links: dict[str, Part]
    joints: dict[str, Part]
    frames: dict[str, Part]

    @property
    def complaints(self) -> list[str]:
        """Return all errors and warnings."""
        return [*self.errors, *self.printed.splitlines()]


def read_with_libsdformat(text: str, folder: Path, *, is_strict: bool = False, suffix: str = ".sdf") -> Read:
    """Read the text of an SDF or a URDF, which is written to a folder; if strict, warnings are errors."""
    path = folder / f"robot{suffix}"
    path.write_text(text, "utf-8")
    run = _run(str(_judge()), str(path), *(["--strict"] if is_strict else []))
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    parts = {kind: {part["name"]: part for part in found[kind]} for kind in ("models", "links", "joints", "frames")}
    return Read(found["errors"], run.stderr, **parts)


@cache
def _judge() -> Path:
    """Return the program; one process builds it while the others wait. Skip the test where libsdformat is missing."""
    fcntl = pytest.importorskip("fcntl", reason=_MISSING)
    files = sorted(_SOURCES.iterdir())
    key = hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]
    folder = _CACHE / f"sdf_judge-{key}"
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "sdf_judge").exists():
            _build(folder)
    return folder / "sdf_judge"


def _build(folder: Path) -> None:
    cmake = program("cmake")
    configured = _run(cmake, "-S", str(_SOURCES), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release")
    if configured.returncode and "sdformat12" in configured.stderr:
        pytest.skip(_MISSING)
    assert configured.returncode == 0, configured.stderr
    compiled = _run(cmake, "--build", str(folder))
    assert compiled.returncode == 0, compiled.stdout + compiled.stderr


def _run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, encoding="utf-8", check=False, timeout=300)
