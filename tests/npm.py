"""Installs the packages of npm that tests use."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import pytest

from tests.programs import program


def installed_modules(project: Path) -> Path:
    """Return node_modules of a folder's package-lock.json: in the user's cache, once for each version of that file."""
    npm = program("npm")
    digest = hashlib.sha256((project / "package-lock.json").read_bytes()).hexdigest()[:16]
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", "linkforge-compile-tests")
    modules = cache / f"npm-{project.name}-{digest}" / "node_modules"
    if not modules.is_dir():
        _install(npm, project, modules)
    return modules


def _install(npm: str, project: Path, modules: Path) -> None:
    modules.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=modules.parent) as fresh:
        for name in ("package.json", "package-lock.json"):
            shutil.copy(project / name, fresh)
        command = (npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund")
        run = subprocess.run(command, cwd=fresh, capture_output=True, text=True, timeout=300, check=False)
        if run.returncode:
            _cannot(f"npm cannot install the packages of {project.name}: {run.stderr.strip()[-500:]}")
        with suppress(OSError):  # another process of this run was faster
            Path(fresh, "node_modules").rename(modules)


def _cannot(reason: str) -> NoReturn:
    """Skip, or fail where LINKFORGE_REQUIRE_SHARED is set, as in CI."""
    if os.environ.get("LINKFORGE_REQUIRE_SHARED"):
        pytest.fail(reason)
    pytest.skip(reason)
