/** The robot as objects of three.js: one group a link, which is moved by its transform in the world. */
import * as THREE from "three";
import { Files } from "./files";
import type { Shapes } from "./geometry";
import { linkTransforms, type Positions } from "./kinematics";
import { HELPERS, makeHelpers, type Helper } from "./layers";
import type { Link, Scene, Shape } from "./scene";
import type { Layer } from "./state";

const HIGHLIGHT = new THREE.Color(0x1c7ed6);

interface LinkObjects {
  group: THREE.Group;
  visuals: THREE.Group;
  collisions: THREE.Group;
}

export class Robot {
  readonly root = new THREE.Group();
  /** The diagonal of its extent where the joints start [m]. */
  size = 1;
  private readonly links = new Map<string, LinkObjects>();
  private readonly helpers = new Map<Helper, Map<string, THREE.Object3D>>();
  private readonly plain = new Map<THREE.Mesh, THREE.Material | THREE.Material[]>();

  private constructor(readonly scene: Scene) {}

  /** Make the robot of a scene, once all of its files are loaded. */
  static async make(scene: Scene, shapes: Shapes): Promise<Robot> {
    shapes.files = new Files(scene.files);
    const robot = new Robot(scene);
    const made = await Promise.all(scene.links.map((link) => makeLink(link, shapes)));
    for (const objects of made) {
      robot.links.set(objects.group.name, objects);
      robot.root.add(objects.group);
    }
    robot.move({});
    robot.size = robot.extent().getSize(new THREE.Vector3()).length() || 1;
    return robot;
  }

  move(positions: Positions): void {
    for (const [name, transform] of linkTransforms(this.scene, positions)) this.group(name).matrix.copy(transform);
    this.root.updateMatrixWorld(true);
  }

  /** Show the layers that are on, of links that are not hidden. */
  show(layers: ReadonlySet<Layer>, hidden: ReadonlySet<string>): void {
    for (const [name, { group, visuals, collisions }] of this.links) {
      group.visible = !hidden.has(name);
      visuals.visible = layers.has("visuals");
      collisions.visible = layers.has("collisions");
    }
    for (const helper of HELPERS) {
      if (layers.has(helper)) this.addHelpers(helper);
      for (const object of this.helpers.get(helper)?.values() ?? []) object.visible = layers.has(helper);
    }
  }

  /** Draw all shapes of a link in one material. */
  paint(materialOf: (link: string) => THREE.Material): void {
    for (const [name, { visuals, collisions }] of this.links) {
      const material = materialOf(name);
      for (const shapes of [visuals, collisions]) {
        shapes.traverse((part) => part instanceof THREE.Mesh && (part.material = material));
      }
    }
  }

  isShown(link: string): boolean {
    return this.group(link).visible;
  }

  has(link: string): boolean {
    return this.links.has(link);
  }

  /** Highlight one link, or none. */
  select(link: string | null): void {
    for (const [mesh, material] of this.plain) {
      for (const lit of [mesh.material].flat()) lit.dispose();
      mesh.material = material;
    }
    this.plain.clear();
    const objects = link === null ? undefined : this.links.get(link);
    for (const group of objects ? [objects.visuals, objects.collisions] : []) {
      group.traverse((part) => part instanceof THREE.Mesh && this.light(part));
    }
  }

  /** Return the name of the link that a ray hits first. */
  hit(ray: THREE.Raycaster): string | null {
    const shown = [...this.links.values()].filter(({ group }) => group.visible);
    const groups = shown.flatMap(({ visuals, collisions }) => [visuals, collisions].filter(({ visible }) => visible));
    return ray.intersectObjects(groups)[0]?.object.userData.link ?? null;
  }

  /** Return the place of a link in the world. */
  transform(link: string): THREE.Matrix4 {
    return this.group(link).matrix.clone();
  }

  /** Return the extent of all shapes, those of layers that are off too, and of the frames of links. */
  extent(): THREE.Box3 {
    const box = new THREE.Box3();
    for (const { group, visuals, collisions } of this.links.values()) {
      const shapes = visuals.children.length ? visuals : collisions;
      box.union(new THREE.Box3().setFromObject(shapes));
      if (!shapes.children.length) box.expandByPoint(new THREE.Vector3().setFromMatrixPosition(group.matrix));
    }
    return box;
  }

  /** Return the extent of the shapes of a link, vertex by vertex, in the world. */
  extentOf(link: string): THREE.Box3 {
    return new THREE.Box3().setFromObject(this.objects(link).visuals, true);
  }

  /** Return the middle of the shapes of a link in the world, that of its frame if it has none. */
  placeOf(link: string): THREE.Vector3 {
    const { group, visuals, collisions } = this.objects(link);
    const box = new THREE.Box3().setFromObject(visuals.children.length ? visuals : collisions);
    return box.isEmpty() ? new THREE.Vector3().setFromMatrixPosition(group.matrix) : box.getCenter(new THREE.Vector3());
  }

  private objects(link: string): LinkObjects {
    const objects = this.links.get(link);
    if (!objects) throw new Error(`no link named ${link}`);
    return objects;
  }

  private group(link: string): THREE.Group {
    return this.objects(link).group;
  }

  private addHelpers(helper: Helper): void {
    if (this.helpers.has(helper)) return;
    const made = makeHelpers(helper, this.scene, this.size);
    this.helpers.set(helper, made);
    for (const [link, object] of made) this.group(link).add(object);
    this.root.updateMatrixWorld(true);
  }

  private light(mesh: THREE.Mesh): void {
    this.plain.set(mesh, mesh.material);
    const lit = [mesh.material].flat().map((material) => {
      const copy = material.clone() as THREE.MeshStandardMaterial;
      copy.emissive?.copy(HIGHLIGHT);
      copy.emissiveIntensity = 0.4;
      return copy;
    });
    mesh.material = Array.isArray(mesh.material) ? lit : lit[0]!;
  }
}

async function makeLink(link: Link, shapes: Shapes): Promise<LinkObjects> {
  const [group, visuals, collisions] = [new THREE.Group(), new THREE.Group(), new THREE.Group()];
  group.name = link.name;
  group.matrixAutoUpdate = visuals.matrixAutoUpdate = collisions.matrixAutoUpdate = false;
  group.add(visuals, collisions);
  const solid = await Promise.all(link.collisions.map((shape) => shapes.make(shape, "collision")));
  for (const object of solid) if (object) collisions.add(object);
  collisions.updateMatrixWorld(true);
  const extent = new THREE.Box3().setFromObject(collisions);
  const shown = await Promise.all(link.visuals.map((shape: Shape) => shapes.make(shape, "visual")));
  shown.forEach((object, index) => visuals.add(object ?? shapes.missing(extent, link.visuals[index]!)));
  group.traverse((part) => (part.userData.link = link.name));
  return { group, visuals, collisions };
}
