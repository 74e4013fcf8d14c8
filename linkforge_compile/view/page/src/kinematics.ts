/** Where the links are in the world, from joint positions. */
import { Matrix4, Quaternion, Vector3 } from "three";
import type { Joint, Pose, Scene } from "./scene";

export type Positions = Readonly<Record<string, number>>;

const ONE = new Vector3(1, 1, 1);
const MOVABLE: ReadonlySet<Joint["type"]> = new Set(["revolute", "continuous", "prismatic"]);

/** Whether one number places the joint; a planar or floating joint stays at its origin. */
export function isMovable(joint: Joint): boolean {
  return MOVABLE.has(joint.type);
}

/** Whether a user moves the joint, rather than the joint that it mimics. */
export function isFree(joint: Joint): boolean {
  return isMovable(joint) && joint.mimic === null;
}

/** Return the nearest position within the limits of a joint. */
export function withinLimits(joint: Joint, position: number): number {
  if (joint.type === "continuous") return position;
  return Math.min(Math.max(position, joint.lower ?? -Infinity), joint.upper ?? Infinity);
}

/** Return the position of each movable joint: that of a free one as given, else its start; mimic joints follow. */
export function jointPositions(joints: readonly Joint[], positions: Positions): Record<string, number> {
  const byName = new Map(joints.map((joint) => [joint.name, joint]));
  const found: Record<string, number> = {};
  const find = (joint: Joint, followed: number): number => {
    const leader = joint.mimic && byName.get(joint.mimic.joint);
    if (!joint.mimic || !leader || followed > joints.length) return positions[joint.name] ?? joint.value;
    return joint.mimic.multiplier * find(leader, followed + 1) + joint.mimic.offset;
  };
  for (const joint of joints) if (isMovable(joint)) found[joint.name] = find(joint, 0);
  return found;
}

/** Return the transform of each link in the world, by name; the root is at the origin. */
export function linkTransforms(scene: Scene, positions: Positions): Map<string, Matrix4> {
  const all = jointPositions(scene.joints, positions);
  const found = new Map<string, Matrix4>();
  for (const link of scene.links) if (link.parent === null) found.set(link.name, new Matrix4());
  for (const joint of scene.joints) {
    const above = found.get(joint.parent) ?? new Matrix4();
    const here = above.clone().multiply(poseMatrix(joint.origin));
    found.set(joint.child, here.multiply(motion(joint, all[joint.name] ?? 0)));
  }
  return found;
}

export function poseMatrix(pose: Pose): Matrix4 {
  const turn = new Quaternion(...pose.quaternion).normalize();
  return new Matrix4().compose(new Vector3(...pose.xyz), turn, ONE);
}

function motion(joint: Joint, position: number): Matrix4 {
  const matrix = new Matrix4();
  if (!joint.axis || !isMovable(joint)) return matrix;
  const axis = new Vector3(...joint.axis).normalize();
  return joint.type === "prismatic"
    ? matrix.setPosition(axis.multiplyScalar(position))
    : matrix.makeRotationAxis(axis, position);
}
