"""Score the legs of a quadruped: simulate how each variant of the walker stands, and print the best.

pip install 'linkforge-compile[sweep]' mujoco      ('.[sweep]' in a clone)
python score_legs.py
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np

from linkforge_compile import render
from linkforge_compile.core import Robot
from linkforge_compile.sweep import run

SPEC = Path(__file__).with_name("walker.robot.yaml")
DURATION = 0.8
"""How long a robot stands [s]; the means are over the second half."""


def score(robot: Robot, values: Mapping[str, object]) -> dict[str, float]:
    """Let a robot stand on the ground; return how far its trunk sinks, and the torques of its drives.

    `sag` [m] is below the height that the drives are told to hold, `knee_torque` [N*m] the mean of the four knees, and
    `tilt` [rad] how far the trunk leans.
    """
    model = _on_the_ground(robot)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("standing").id)
    height = data.qpos[2]
    knees = [i for i in range(model.nu) if "knee" in model.actuator(i).name]
    torques = []
    while data.time < DURATION:
        mujoco.mj_step(model, data)
        if data.time > DURATION / 2:
            torques.append(np.abs(data.actuator_force[knees]).mean())
    up = data.body("trunk").xmat.reshape(3, 3)[2, 2]
    return {
        "sag": height - data.qpos[2],
        "knee_torque": float(np.mean(torques)),
        "tilt": float(np.arccos(np.clip(up, -1, 1))),
    }


def _on_the_ground(robot: Robot) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(render(robot, "mjcf", options={"base": "free"}))
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.05])
    return spec.compile()


def main() -> None:
    """Sweep two lengths, and print the legs that hold the payload with the least torque in their knees."""
    table = run(
        SPEC,
        {"segment": "0.17m:0.26m:4", "stand_height": "0.26m:0.34m:3"},
        score,
        where="$(stand_height < 1.9 * segment)",  # otherwise the legs are fully stretched
        jobs=2,
    )
    print("segment  stand  mass   knee torque  sag")
    for row in table.sort_by("knee_torque").slice(0, 5).to_pylist():
        print(
            f"{row['segment']:.3f} m  {row['stand_height']:.2f} m {row['robot_mass']:6.2f} kg"
            f"  {row['knee_torque']:6.2f} N*m  {1000 * row['sag']:5.1f} mm"
        )


if __name__ == "__main__":
    main()
