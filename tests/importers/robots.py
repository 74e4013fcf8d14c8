"""Real robots, where they are installed or at hand: those of the shared corpus and of example-robot-data."""

import os
import sysconfig
from pathlib import Path

ROOT = Path(__file__).parents[2]
CORPUS = Path(os.environ.get("LINKFORGE_SHARED", ROOT.parent / "shared")) / "corpus"
EXAMPLES = Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"

OF_CORPUS = sorted(CORPUS.glob("*.urdf"))
# One of them is empty and has no name.
OF_EXAMPLES = sorted(path for path in EXAMPLES.rglob("*.urdf") if path.name != "ur3.urdf")
