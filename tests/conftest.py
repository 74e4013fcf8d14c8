"""The shared corpus, the option to renew golden files, and the settings of Hypothesis."""

import gc
import json
import os
import runpy
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import hypothesis
import pytest

pytest.register_assert_rewrite("tests.yaml_case")

ROOT = Path(__file__).parents[1]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="write the golden files; read the diff afterwards")


def pytest_collection_finish() -> None:
    """Exempt the thousands of tests from garbage collection, and collect less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000, 20)


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    return bool(request.config.getoption("--update-golden"))


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder with the corpus of real robots and the tools that compare them.

    Skip the test if it is absent, or fail if LINKFORGE_REQUIRE_SHARED is set, as in CI.
    """
    folder = Path(os.environ.get("LINKFORGE_SHARED", ROOT.parent / "shared"))
    if (folder / "corpus").is_dir() and (folder / "tools" / "urdf_equiv.py").is_file():
        return folder
    if os.environ.get("LINKFORGE_REQUIRE_SHARED"):
        pytest.fail(f"LINKFORGE_REQUIRE_SHARED is set and {folder} holds no corpus and tools")
    pytest.skip(f"no shared corpus at {folder}; LINKFORGE_SHARED says where it is")


Checks = dict[str, dict[str, Any]]
"""What each reader makes of two robots: `{"pin": {"status": "same"}}`."""
Judge = Callable[..., Checks]


@pytest.fixture(scope="session")
def judge(shared: Path) -> Judge:
    """Compare two URDFs in each element, and in what urdfdom, Pinocchio and MuJoCo make of them.

    It is a program of its own, which shares no code with linkforge, and runs in this process to save time.
    """
    main = runpy.run_path(str(shared / "tools" / "urdf_equiv.py"))["main"]

    def compare(*words: str | Path) -> Checks:
        with redirect_stdout(StringIO()) as report:
            main([*map(str, words), "--json"])
        checks: Checks = json.loads(report.getvalue())["checks"]
        return checks

    return compare


# No deadline, so that a busy machine fails no test; 30 examples, so that all property tests take a minute in CI.
hypothesis.settings.register_profile("steady", deadline=None, max_examples=30)
hypothesis.settings.load_profile("steady")
# pytest tests/test_any_spec.py --hypothesis-profile long
hypothesis.settings.register_profile("long", deadline=None, max_examples=5000)
