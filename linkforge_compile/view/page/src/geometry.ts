/** Shapes of the scene as objects of three.js. */
import * as THREE from "three";
import { poseMatrix } from "./kinematics";
import type { Shape } from "./scene";

/** Return a shape at its place in the frame of its link. */
export function makeShape(shape: Shape): THREE.Object3D {
  const color = new THREE.Color(0.6, 0.6, 0.6);
  if (shape.color) color.setRGB(shape.color[0], shape.color[1], shape.color[2], THREE.SRGBColorSpace);
  const mesh = new THREE.Mesh(makeGeometry(shape), new THREE.MeshStandardMaterial({ color }));
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(poseMatrix(shape.origin));
  return mesh;
}

function makeGeometry(shape: Shape): THREE.BufferGeometry {
  const { radius = 0.05, length = 0.1 } = shape;
  switch (shape.type) {
    case "sphere":
      return new THREE.SphereGeometry(radius, 32, 16);
    case "cylinder":
      return new THREE.CylinderGeometry(radius, radius, length, 48).rotateX(Math.PI / 2);
    case "capsule":
      return new THREE.CapsuleGeometry(radius, length, 8, 32).rotateX(Math.PI / 2);
    default:
      return new THREE.BoxGeometry(...(shape.size ?? [0.1, 0.1, 0.1]));
  }
}
