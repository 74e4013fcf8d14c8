"""Real robots, where they are installed or at hand: of the shared corpus and example-robot-data, with their SRDFs."""

import os
import sysconfig
from pathlib import Path

from benchmarks.import_table import urdf_of

ROOT = Path(__file__).parents[2]
CORPUS = Path(os.environ.get("LINKFORGE_SHARED", ROOT.parent / "shared")) / "corpus"
EXAMPLES = Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"

OF_CORPUS = sorted(CORPUS.glob("*.urdf"))
# One of them is empty and has no name.
OF_EXAMPLES = sorted(path for path in EXAMPLES.rglob("*.urdf") if path.name != "ur3.urdf")

# One of them is alone.
PAIRS = [
    (urdf, srdf) for srdf in sorted((*CORPUS.glob("*.srdf"), *EXAMPLES.rglob("*.srdf"))) if (urdf := urdf_of(srdf))
]
ALONE = [srdf for srdf in sorted(CORPUS.glob("*.srdf")) if not urdf_of(srdf)]
