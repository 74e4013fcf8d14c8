/** The robot before, drawn through the one after: what differs is coloured, and what is the same is grey. */
import * as THREE from "three";
import type { Shapes } from "./geometry";
import { type Positions } from "./kinematics";
import { FINISH } from "./meshes";
import { Robot } from "./robot";
import type { Comparison, DifferenceKind, Scene } from "./scene";
import type { State } from "./state";
import type { Theme } from "./theme";

/** The kinds of differences with their colours, as in style.css. */
export const COLORS: Readonly<Record<DifferenceKind, number>> = {
  added: 0x2f9e44,
  removed: 0xe03131,
  changed: 0xf08c00,
  moved: 0x1c7ed6,
  renamed: 0x7048e8,
};
const SAME = 0xb9bec7;
/** How much farther apart than this two places of a link differ, as numbers of their transforms. */
const NEAR = 1e-9;

export class Compared {
  private constructor(
    private readonly comparison: Comparison,
    private readonly after: Robot,
    private readonly before: Robot,
    private readonly ghost: THREE.MeshStandardMaterial,
  ) {}

  /** Make the robot before that of a scene, and colour both. */
  static async make(scene: Scene, comparison: Comparison, after: Robot, shapes: Shapes): Promise<Compared> {
    const before = await Robot.make({ ...comparison.before, files: scene.files }, shapes);
    const made = new Compared(comparison, after, before, makeGhost());
    const solid = new Map(Object.entries(COLORS).map(([kind, color]) => [kind, new THREE.MeshStandardMaterial({ ...FINISH, color })]));
    const same = new THREE.MeshStandardMaterial({ ...FINISH, color: SAME });
    after.paint((link) => solid.get(comparison.kinds[link] ?? "") ?? same);
    const gone = makeGhost();
    gone.color.set(COLORS.removed);
    before.paint((link) => (made.kind(link) === "removed" ? gone : made.ghost));
    return made;
  }

  /** Take the colour of the robot before. */
  useTheme({ before }: Theme): void {
    this.ghost.color.set(before);
  }

  /** The links of the robot before that are drawn, with their places in the world. */
  get drawn(): [name: string, place: THREE.Matrix4][] {
    const names = this.before.scene.links.map(({ name }) => name);
    const drawn = this.root.visible ? names.filter((name) => this.before.isShown(name)) : [];
    return drawn.map((name) => [name, this.before.transform(name)]);
  }

  get root(): THREE.Object3D {
    return this.before.root;
  }

  /** Move the robot before; its joints are those of the other one that have the same or the new name. */
  move(positions: Positions): void {
    const own = this.before.scene.joints.map(({ name }) => [name, positions[this.comparison.joints[name] ?? name]] as const);
    const known = own.filter((entry): entry is readonly [string, number] => entry[1] !== undefined);
    this.before.move(Object.fromEntries(known));
  }

  /** Show the robot before where it is another one, or all of it while it is alone. */
  show({ layers, hidden, sides }: Pick<State, "layers" | "hidden" | "sides">): void {
    this.before.root.visible = sides.has("before");
    this.after.root.visible = sides.has("after");
    const same = this.before.scene.links.filter(({ name }) => sides.has("after") && this.isSame(name));
    const ofShapes = new Set([...layers].filter((layer) => layer === "visuals" || layer === "collisions"));
    this.before.show(ofShapes, new Set([...same.map(({ name }) => name), ...hidden]));
  }

  /** Return what happened to a link of the robot before. */
  private kind(link: string): DifferenceKind | undefined {
    return this.comparison.kinds[this.comparison.links[link] ?? link];
  }

  private isSame(link: string): boolean {
    const name = this.comparison.links[link] ?? link;
    if (this.kind(link) || !this.after.has(name)) return false;
    const here = this.after.transform(name).elements;
    return this.before.transform(link).elements.every((number, index) => Math.abs(number - here[index]!) <= NEAR);
  }
}

/** Make a material that is seen through what is before it. */
function makeGhost(): THREE.MeshStandardMaterial {
  const through = { opacity: 0.3, transparent: true, depthTest: false, depthWrite: false };
  return new THREE.MeshStandardMaterial({ ...FINISH, ...through });
}
