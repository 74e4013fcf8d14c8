"""Real robots, where they are installed or at hand: of the shared corpus and example-robot-data, with their SRDFs."""

import os
import sysconfig
from pathlib import Path

from benchmarks.import_table import urdf_of

ROOT = Path(__file__).parents[2]
CORPUS = Path(os.environ.get("LINKFORGE_SHARED", ROOT.parent / "shared")) / "corpus"
EXAMPLES = Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"

# Robots all of whose elements and attributes are in a larger one below. `benchmarks/import_table.py` imports all.
ALIKE = {
    *("TwoDofs", "a1", "alex_nub_hands", "allegro_left_hand", "b1", "double_pendulum", "double_pendulum_simple"),
    *("finger_edu", "g1_29dof_with_hand_rev_1_0", "hextilt_flying_arm_5", "human", "iris_simple", "laikago"),
    *("romeo_small", "simple_humanoid_classical", "so100", "solo", "talos_full_v2_box", "talos_left_arm"),
    *("talos_reduced", "talos_reduced_box", "tiago_no_hand", "ur10_joint_limited_robot", "ur10_robot"),
    *("ur3_gripper", "ur3_joint_limited_robot", "ur3_robot", "ur5_robot"),
}

STEP = 1 if os.environ.get("LINKFORGE_ALL_ROBOTS") else 2
"""Every second robot where each takes long, to save time in CI."""

OF_CORPUS = sorted(CORPUS.glob("*.urdf"))
# One more, `ur3`, is empty and has no name.
OF_EXAMPLES = sorted(path for path in EXAMPLES.rglob("*.urdf") if path.stem not in {*ALIKE, "ur3"})

ALIKE_SRDF = {*ALIKE, "pr2", "romeo", "solo", "ur5"}

# One of them is alone.
PAIRS = [
    (urdf, srdf)
    for srdf in sorted((*CORPUS.glob("*.srdf"), *EXAMPLES.rglob("*.srdf")))
    if (urdf := urdf_of(srdf)) and srdf.stem not in ALIKE_SRDF
]
ALONE = [srdf for srdf in sorted(CORPUS.glob("*.srdf")) if not urdf_of(srdf)]
