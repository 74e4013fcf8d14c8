/** The robot as objects of three.js: one group a link, which is moved by its transform in the world. */
import * as THREE from "three";
import { makeShape } from "./geometry";
import { linkTransforms, type Positions } from "./kinematics";
import type { Scene } from "./scene";

export class Robot {
  readonly root = new THREE.Group();
  private readonly links = new Map<string, THREE.Group>();

  constructor(private readonly scene: Scene) {
    for (const link of scene.links) {
      const group = new THREE.Group();
      group.name = link.name;
      group.matrixAutoUpdate = false;
      for (const shape of link.visuals) group.add(makeShape(shape));
      this.links.set(link.name, group);
      this.root.add(group);
    }
  }

  move(positions: Positions): void {
    for (const [name, transform] of linkTransforms(this.scene, positions)) this.links.get(name)?.matrix.copy(transform);
    this.root.updateMatrixWorld(true);
  }

  /** Return where a link is in the world. */
  transform(link: string): THREE.Matrix4 {
    const group = this.links.get(link);
    if (!group) throw new Error(`no link is named ${link}`);
    return group.matrix.clone();
  }

  /** Return the extent of all that is shown. */
  extent(): THREE.Box3 {
    return new THREE.Box3().setFromObject(this.root);
  }
}
