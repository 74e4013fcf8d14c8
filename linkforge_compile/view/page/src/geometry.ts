/** Shapes of the scene as objects of three.js, which share geometries and materials. */
import * as THREE from "three";
import { Cache } from "./cache";
import { Files } from "./files";
import { poseMatrix } from "./kinematics";
import { disposeMesh, FINISH, NO_MATERIAL, readMesh } from "./meshes";
import type { Shape } from "./scene";

type Role = "visual" | "collision";

const PLAIN = [0.72, 0.74, 0.77, 1] as const;
const COLLISION = [0.1, 0.62, 0.55] as const;
const MISSING = 0xd6336c;
/** The edge of the box of a missing mesh where nothing else states one [m]. */
const MISSING_SIZE = 0.1;

/** Makes shapes, and keeps what several of them share as long as a robot uses it. */
export class Shapes {
  /** The files of the scene that is being made. */
  files = new Files({});
  /** The reasons why files are not shown, by digest. */
  readonly faults = new Map<string, string>();
  private readonly geometries = new Cache<THREE.BufferGeometry>((geometry) => geometry.dispose());
  private readonly materials = new Cache<Promise<THREE.Material>>((made) => void made.then(disposeMaterial));
  private readonly meshes = new Cache<Promise<THREE.Group | null>>((read) => void read.then((mesh) => mesh && disposeMesh(mesh)));

  /** Return a shape at its place in the frame of its link; null: its mesh is missing. */
  async make(shape: Shape, role: Role): Promise<THREE.Object3D | null> {
    const made = shape.type === "mesh" ? await this.mesh(shape, role) : await this.primitive(shape, role);
    if (!made) return null;
    made.matrixAutoUpdate = false;
    made.matrix.premultiply(poseMatrix(shape.origin));
    return made;
  }

  /** Return the edges of a box that a missing mesh may fill, in the frame of the link. */
  missing(extent: THREE.Box3, shape: Shape): THREE.Object3D {
    const edges = this.geometries.get("edges", () => new THREE.EdgesGeometry(new THREE.BoxGeometry()));
    const box = new THREE.LineSegments(edges, MISSING_LINES);
    box.matrixAutoUpdate = false;
    const size = extent.isEmpty() ? new THREE.Vector3().setScalar(MISSING_SIZE) : extent.getSize(new THREE.Vector3());
    box.matrix.makeScale(size.x, size.y, size.z);
    if (extent.isEmpty()) box.matrix.premultiply(poseMatrix(shape.origin));
    else box.matrix.setPosition(extent.getCenter(new THREE.Vector3()));
    return box;
  }

  /** Release what no shape made since the last call uses. */
  sweep(): void {
    this.meshes.sweep();
    this.materials.sweep();
    this.geometries.sweep();
  }

  private async primitive(shape: Shape, role: Role): Promise<THREE.Mesh> {
    const { radius = 0, length = 0, size = [0, 0, 0] } = shape;
    const material = await this.material(shape, role);
    const geometry = this.geometries.get(geometryKey(shape), () => makeGeometry(shape));
    const mesh = new THREE.Mesh(geometry, material);
    if (shape.type === "box") mesh.matrix.makeScale(...size);
    if (shape.type === "sphere") mesh.matrix.makeScale(radius, radius, radius);
    if (shape.type === "cylinder") mesh.matrix.makeScale(radius, radius, length);
    return mesh;
  }

  private async mesh(shape: Shape, role: Role): Promise<THREE.Group | null> {
    const read = shape.file ? await this.meshes.get(shape.file, () => this.read(shape.file!)) : null;
    if (!read) return null;
    const own = await this.material(shape, role);
    const group = new THREE.Group();
    for (const part of read.children as THREE.Mesh[]) {
      const material = withOwn(part.material, own, role);
      const copy = new THREE.Mesh(part.geometry, material);
      copy.matrixAutoUpdate = false;
      copy.matrix.copy(part.matrix);
      group.add(copy);
    }
    group.matrix.makeScale(...(shape.scale ?? [1, 1, 1]));
    return group;
  }

  private async read(digest: string): Promise<THREE.Group | null> {
    try {
      return await readMesh(this.files, digest);
    } catch (error) {
      console.info(error); // in the words of its reader
      // Readers of binary files know of an end only by the range of their view.
      const kind = this.files.kind(digest);
      const isCutOff = error instanceof RangeError && kind !== "gltf";
      this.note(digest, isCutOff ? "the file ends before its data does" : `it cannot be read as .${kind}`);
      return null;
    }
  }

  private note(digest: string, reason: string): void {
    this.faults.set(digest, reason);
    console.warn(`linkforge: not shown: ${digest} ${reason}`); // for the program that draws a picture
  }

  private material({ color, texture }: Shape, role: Role): Promise<THREE.Material> {
    if (role === "collision") return this.materials.get(role, async () => collisionMaterial());
    const [red, green, blue, alpha] = color ?? (texture ? [1, 1, 1, 1] : PLAIN);
    const key = [red, green, blue, alpha, texture].join();
    return this.materials.get(key, async () => {
      const made = new THREE.MeshStandardMaterial({ ...FINISH, opacity: alpha, transparent: alpha < 1 });
      made.color.setRGB(red, green, blue, THREE.SRGBColorSpace);
      if (texture) made.map = await this.texture(texture);
      return made;
    });
  }

  private async texture(digest: string): Promise<THREE.Texture | null> {
    try {
      return await this.readTexture(digest);
    } catch {
      this.note(digest, "it cannot be read");
      return null;
    }
  }

  private readTexture(digest: string): Promise<THREE.Texture> {
    const name = `texture.${this.files.kind(digest)}`;
    return this.files.lend(new Map([[name, digest]]), async (manager) => {
      const loader = (manager.getHandler(name) ?? new THREE.TextureLoader(manager)) as THREE.TextureLoader;
      const texture = await loader.loadAsync(name);
      texture.colorSpace = THREE.SRGBColorSpace;
      return texture;
    });
  }
}

const MISSING_LINES = new THREE.LineBasicMaterial({ color: MISSING });

/** RViz as well lets the materials of a mesh win, and gives the rest that of the URDF. */
function withOwn(
  material: THREE.Material | THREE.Material[],
  own: THREE.Material,
  role: Role,
): THREE.Material | THREE.Material[] {
  if (role === "collision") return own;
  if (Array.isArray(material)) return material.map((one) => (one === NO_MATERIAL ? own : one));
  return material === NO_MATERIAL ? own : material;
}

function collisionMaterial(): THREE.Material {
  const look = { ...FINISH, opacity: 0.35, transparent: true, depthWrite: false, polygonOffset: true } as const;
  const made = new THREE.MeshStandardMaterial({ ...look, polygonOffsetFactor: -1, polygonOffsetUnits: -1 });
  made.color.setRGB(...COLLISION, THREE.SRGBColorSpace);
  return made;
}

function disposeMaterial(material: THREE.Material): void {
  (material as THREE.MeshStandardMaterial).map?.dispose();
  material.dispose();
}

/** All boxes, spheres and cylinders are one that is scaled. */
function geometryKey({ type, radius, length }: Shape): string {
  return type === "capsule" ? `capsule ${radius} ${length}` : type;
}

/** Make a shape of unit size; `length` of a capsule is that between its half spheres. */
function makeGeometry({ type, radius = 0, length = 0 }: Shape): THREE.BufferGeometry {
  switch (type) {
    case "sphere":
      return new THREE.SphereGeometry(1, 32, 16).rotateX(Math.PI / 2);
    case "cylinder":
      return new THREE.CylinderGeometry(1, 1, 1, 48).rotateX(Math.PI / 2);
    case "capsule":
      return new THREE.CapsuleGeometry(radius, length, 8, 32).rotateX(Math.PI / 2);
    default:
      return new THREE.BoxGeometry();
  }
}
