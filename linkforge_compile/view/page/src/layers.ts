/** What a robot has and nobody sees: frames, joint axes, centres of mass and inertia ellipsoids. */
import * as THREE from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { ellipsoid } from "./inertia";
import { isMovable, poseMatrix } from "./kinematics";
import type { Joint, Link, Scene } from "./scene";

export const HELPERS = ["frames", "axes", "centers", "inertias"] as const;
export type Helper = (typeof HELPERS)[number];

const AXIS_COLORS: Partial<Record<Joint["type"], number>> = { revolute: 0xf08c00, continuous: 0xe8590c, prismatic: 0x7048e8 };
const CENTER_COLOR = 0xc2255c;
const INERTIA_COLOR = 0x7048e8;
/** Sizes as parts of the robot's. */
const FRAME = 0.06;
const AXIS = 0.11;
const CENTER = 0.008;

// Drawn over the robot, inside of which they are.
const over = (color: number): THREE.MeshBasicMaterial =>
  new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true });

const ARROW = makeArrow();
/** Of the triangles of a sphere's visual, so that an ellipsoid over it does not flicker. */
const SPHERE = new THREE.SphereGeometry(1, 32, 16).rotateX(Math.PI / 2);
const FRAME_GEOMETRY = makeFrame();
const FRAME_MATERIAL = new THREE.MeshBasicMaterial({ vertexColors: true, depthTest: false, transparent: true });
const CENTER_MATERIAL = over(CENTER_COLOR);
const INERTIA_MATERIAL = new THREE.MeshStandardMaterial({
  color: INERTIA_COLOR, opacity: 0.4, transparent: true, depthWrite: false, roughness: 0.8, side: THREE.FrontSide,
  polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2,
});
const AXIS_MATERIALS = new Map(Object.entries(AXIS_COLORS).map(([type, color]) => [type, over(color)]));

/** Return the objects of a layer by link; `size` is that of the robot [m]. */
export function makeHelpers(helper: Helper, scene: Scene, size: number): Map<string, THREE.Object3D> {
  if (helper === "axes") {
    const moving = scene.joints.filter((joint) => isMovable(joint) && joint.axis);
    return new Map(moving.map((joint) => [joint.child, makeAxis(joint, size * AXIS)]));
  }
  const make = { frames: () => makeFrameOf(size * FRAME), centers: (link: Link) => makeCenter(link, size * CENTER), inertias: makeInertia };
  const made = scene.links.map((link) => [link.name, make[helper](link)] as const);
  return new Map(made.filter((entry): entry is readonly [string, THREE.Mesh] => entry[1] !== null));
}

function makeFrameOf(size: number): THREE.Mesh {
  return fixed(FRAME_GEOMETRY, FRAME_MATERIAL, new THREE.Matrix4().makeScale(size, size, size), 3);
}

/** The axis is in the frame of the joint, with which that of its child moves. */
function makeAxis(joint: Joint, size: number): THREE.Mesh {
  const axis = new THREE.Vector3(...joint.axis!).normalize();
  const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
  const place = new THREE.Matrix4().compose(new THREE.Vector3(), turn, new THREE.Vector3().setScalar(size));
  return fixed(ARROW, AXIS_MATERIALS.get(joint.type)!, place, 4);
}

function makeCenter(link: Link, size: number): THREE.Mesh | null {
  if (!link.center || !link.mass) return null;
  const place = new THREE.Matrix4().makeScale(size, size, size).setPosition(...link.center);
  return fixed(SPHERE, CENTER_MATERIAL, place, 5);
}

function makeInertia(link: Link): THREE.Mesh | null {
  const shape = link.inertia && ellipsoid(link.inertia, link.mass ?? 0);
  return shape && link.inertia ? fixed(SPHERE, INERTIA_MATERIAL, shape.premultiply(poseMatrix(link.inertia.origin)), 2) : null;
}

function fixed(geometry: THREE.BufferGeometry, material: THREE.Material, place: THREE.Matrix4, order: number): THREE.Mesh {
  const mesh = new THREE.Mesh(geometry, material);
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(place);
  mesh.renderOrder = order;
  return mesh;
}

/** Make an arrow of length 1 along z. */
function makeArrow(width = 0.022): THREE.BufferGeometry {
  const shaft = new THREE.CylinderGeometry(width, width, 0.78, 12).translate(0, 0.39, 0);
  const head = new THREE.ConeGeometry(width * 3, 0.22, 20).translate(0, 0.89, 0);
  return mergeGeometries([shaft, head]).rotateX(Math.PI / 2);
}

/** Make three arms: x red, y green, z blue. */
function makeFrame(): THREE.BufferGeometry {
  const colors = [0xe03131, 0x2f9e44, 0x1c7ed6];
  const arms = colors.map((hex, axis) => {
    const arm = new THREE.CylinderGeometry(0.045, 0.045, 1, 10).translate(0, 0.5, 0);
    if (axis === 0) arm.rotateZ(-Math.PI / 2);
    if (axis === 2) arm.rotateX(Math.PI / 2);
    const color = new THREE.Color(hex).toArray();
    const colorOfAll = Array.from({ length: arm.getAttribute("position").count }, () => color).flat();
    return arm.setAttribute("color", new THREE.Float32BufferAttribute(colorOfAll, 3));
  });
  return mergeGeometries(arms);
}
