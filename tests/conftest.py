"""The shared corpus, the option to renew golden files, and the settings of Hypothesis."""

import os
from pathlib import Path

import hypothesis
import pytest

pytest.register_assert_rewrite("tests.yaml_case")

ROOT = Path(__file__).parents[1]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="write the golden files; read the diff afterwards")


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


# No deadline, so that a busy machine fails no test; 50 examples, so that all property tests take a few minutes in CI.
hypothesis.settings.register_profile("steady", deadline=None, max_examples=50)
hypothesis.settings.load_profile("steady")
# pytest tests/test_any_spec.py --hypothesis-profile long
hypothesis.settings.register_profile("long", deadline=None, max_examples=5000)
