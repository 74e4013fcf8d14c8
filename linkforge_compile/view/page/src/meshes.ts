/** Files of meshes as objects of three.js, in metres, in the axes of the file. */
import * as THREE from "three";
import { ColladaLoader } from "three/examples/jsm/loaders/ColladaLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { MTLLoader } from "three/examples/jsm/loaders/MTLLoader.js";
import { OBJLoader } from "three/examples/jsm/loaders/OBJLoader.js";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { STLLoader } from "three/examples/jsm/loaders/STLLoader.js";
import type { Files } from "./files";

/** The material of what has none in its file; it is never drawn. */
export const NO_MATERIAL = new THREE.MeshStandardMaterial({ name: "none" });

type Read = (files: Files, digest: string, manager: THREE.LoadingManager) => Promise<THREE.Object3D>;

const READERS: Readonly<Record<string, Read>> = {
  stl: async (files, digest) => readStl(await files.bytes(digest)),
  ply: async (files, digest) => readPly(await files.bytes(digest)),
  obj: readObj,
  dae: readCollada,
  gltf: readGltf,
  glb: readGltf,
};

/** Read a mesh: a group of meshes, each at its place in the axes of the file. */
export async function readMesh(files: Files, digest: string): Promise<THREE.Group> {
  const read = READERS[files.kind(digest)];
  if (!read) throw new Error(`.${files.kind(digest)} files are not supported`);
  return flat(await files.lend(files.uses(digest), (manager) => read(files, digest, manager)));
}

/** Release what a mesh has on the graphics card. */
export function disposeMesh(mesh: THREE.Group): void {
  for (const part of mesh.children as THREE.Mesh<THREE.BufferGeometry, THREE.Material | THREE.Material[]>[]) {
    part.geometry.dispose();
    for (const material of [part.material].flat()) {
      if (material === NO_MATERIAL) continue;
      for (const value of Object.values(material)) if (value instanceof THREE.Texture) value.dispose();
      material.dispose();
    }
  }
}

function readStl(bytes: ArrayBuffer): THREE.Mesh {
  const geometry = new STLLoader().parse(bytes);
  geometry.computeVertexNormals(); // Many files have normals of length 0.
  geometry.deleteAttribute("color");
  return new THREE.Mesh(geometry, NO_MATERIAL);
}

function readPly(bytes: ArrayBuffer): THREE.Mesh {
  const geometry = new PLYLoader().parse(bytes);
  const colored = () => new THREE.MeshStandardMaterial({ name: "colors", vertexColors: true, ...FINISH });
  return new THREE.Mesh(geometry, geometry.hasAttribute("color") ? colored() : NO_MATERIAL);
}

async function readObj(files: Files, digest: string, manager: THREE.LoadingManager): Promise<THREE.Object3D> {
  const loader = new OBJLoader(manager);
  const libraries = [...files.uses(digest).values()].filter((used) => files.kind(used) === "mtl");
  const texts = await Promise.all(libraries.map((library) => files.text(library)));
  const materials = texts.length ? new MTLLoader(manager).parse(texts.join("\n"), "") : null;
  if (materials) loader.setMaterials(materials);
  const object = loader.parse(await files.text(digest));
  for (const part of meshesIn(object)) {
    const kept = [part.material].flat().map((own) => (materials && own.name in materials.materialsInfo ? own : NO_MATERIAL));
    part.material = Array.isArray(part.material) ? kept : kept[0]!;
  }
  return object;
}

/** Read COLLADA as RViz does: the unit scales it, `up_axis` turns nothing, and blanks may be before its declaration. */
async function readCollada(files: Files, digest: string, manager: THREE.LoadingManager): Promise<THREE.Object3D> {
  const collada = new ColladaLoader(manager).parse((await files.text(digest)).trimStart(), "");
  if (!collada?.scene) throw new Error("it is not a COLLADA document with a scene");
  collada.scene.rotation.set(0, 0, 0);
  for (const part of meshesIn(collada.scene)) {
    const kept = [part.material].flat().map((own) => (isFallback(own) ? NO_MATERIAL : own));
    part.material = Array.isArray(part.material) ? kept : kept[0]!;
  }
  return collada.scene;
}

/** Whether the loader made a material for a mesh without one. */
function isFallback(material: THREE.Material): boolean {
  if (material.name) return false;
  const isMagenta = material instanceof THREE.MeshBasicMaterial && material.color.getHex() === 0xff00ff;
  const isWhite = material instanceof THREE.MeshPhongMaterial && material.color.getHex() === 0xffffff && !material.map;
  return isMagenta || isWhite;
}

async function readGltf(files: Files, digest: string, manager: THREE.LoadingManager): Promise<THREE.Object3D> {
  const { scene, parser } = await new GLTFLoader(manager).parseAsync(await files.bytes(digest), "");
  for (const part of meshesIn(scene)) {
    if (!Array.isArray(part.material) && !parser.associations.has(part.material)) part.material = NO_MATERIAL;
  }
  return scene;
}

type AnyMesh = THREE.Mesh<THREE.BufferGeometry, THREE.Material | THREE.Material[]>;

function meshesIn(object: THREE.Object3D): AnyMesh[] {
  const found: AnyMesh[] = [];
  object.traverse((part) => part instanceof THREE.Mesh && found.push(part as AnyMesh));
  return found;
}

/** Return the meshes alone, without lights, cameras and nodes. */
function flat(object: THREE.Object3D): THREE.Group {
  object.updateMatrixWorld(true);
  const group = new THREE.Group();
  const changed = new Map<THREE.Material, THREE.Material>();
  for (const { geometry, material, matrixWorld } of meshesIn(object)) {
    if (!geometry.getAttribute("position")?.count) continue;
    if (!geometry.hasAttribute("normal")) geometry.computeVertexNormals();
    const made = Array.isArray(material) ? material.map((one) => matt(one, changed)) : matt(material, changed);
    const mesh = new THREE.Mesh(geometry, made);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(matrixWorld);
    group.add(mesh);
  }
  return group;
}

/** How surfaces look; both sides, since files often have triangles of the wrong winding. */
export const FINISH = { roughness: 0.75, metalness: 0.05, side: THREE.DoubleSide } as const;

/** Return a material under the same light as all others: shininess of CAD programs says little. */
function matt(material: THREE.Material, changed: Map<THREE.Material, THREE.Material>): THREE.Material {
  if (material === NO_MATERIAL || material instanceof THREE.MeshStandardMaterial) return material;
  const known = changed.get(material);
  if (known) return known;
  const { color, map, emissive, name, opacity, transparent, vertexColors } = material as THREE.MeshPhongMaterial;
  // Nobody draws what cannot be seen: MeshLab writes `Tr 1` for opaque, which says the opposite.
  const isClear = transparent && 0 < opacity && opacity < 1;
  const seen = { opacity: isClear ? opacity : 1, transparent: isClear };
  const made = new THREE.MeshStandardMaterial({ name, color, ...seen, vertexColors, ...FINISH });
  if (map) made.map = map;
  if (emissive) made.emissive.copy(emissive);
  changed.set(material, made);
  material.dispose();
  return made;
}
