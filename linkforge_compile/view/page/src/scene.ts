/** The scene that Python makes of a robot. All numbers are SI; frames and angles are those of URDF. */

type Vector = [number, number, number];
export type Quaternion = [x: number, y: number, z: number, w: number];

export interface Pose {
  xyz: Vector;
  quaternion: Quaternion;
}

/** Where in the spec something was written, as diagnostics show it. */
export interface Place {
  file: string;
  line: number;
  column: number;
}

export interface Shape {
  origin: Pose;
  type: "box" | "sphere" | "cylinder" | "capsule" | "mesh";
  size?: Vector;
  radius?: number;
  length?: number;
  /** The digest of a mesh; null: the file is missing. */
  file?: string | null;
  scale?: Vector;
  /** Red, green, blue and alpha in sRGB, 0 to 1, as in URDF's `rgba`. */
  color?: [number, number, number, number];
  texture?: string;
  name?: string;
}

export interface Inertia {
  origin: Pose;
  /** ixx, iyy, izz, ixy, ixz, iyz. */
  moments: [number, number, number, number, number, number];
}

export interface Link {
  name: string;
  /** The joint above. */
  parent: string | null;
  mass: number | null;
  center: Vector | null;
  inertia: Inertia | null;
  visuals: Shape[];
  collisions: Shape[];
  source: Place | null;
  /** "" for the robot's own, "left/arm" for a nested module. */
  module: string;
}

interface Mimic {
  joint: string;
  multiplier: number;
  offset: number;
}

export interface Joint {
  name: string;
  type: "fixed" | "revolute" | "continuous" | "prismatic" | "planar" | "floating";
  parent: string;
  child: string;
  origin: Pose;
  axis: Vector | null;
  lower: number | null;
  upper: number | null;
  velocity: number | null;
  effort: number | null;
  mimic: Mimic | null;
  /** Where it starts: 0, or the middle of limits that exclude 0. */
  value: number;
  source: Place | null;
  module: string;
}

export interface GroupState {
  name: string;
  group: string;
  positions: Record<string, number[]>;
}

export interface SceneFile {
  name: string;
  /** The ending in lower case: stl, obj, mtl, dae, glb, gltf, ply, png, jpg. */
  kind: string;
  size: number;
  /** The links whose shapes name it, and the first place that does. */
  links?: string[];
  source?: Place | null;
  /** Base64; absent: at files/DIGEST of the server. */
  data?: string;
  /** Digests of the files it refers to, by the name that it calls them. */
  uses?: Record<string, string>;
}

export interface MissingFile {
  file: string;
  reason: string;
  links: string[];
  source: Place | null;
}

export interface Camera {
  /** Degrees about z from +x, of the place of the camera. */
  azimuth: number;
  /** Degrees over the ground. */
  elevation: number;
  /** Metres; absent: all of the robot is in the picture. */
  distance?: number;
  target?: Vector;
}

export interface View {
  pose?: Record<string, number>;
  camera?: Camera;
  layers?: string[];
  panels: boolean;
}

export type DifferenceKind = "added" | "removed" | "renamed" | "moved" | "changed";

/** A difference from the robot before, and the link at which it is shown. */
export interface Difference {
  kind: DifferenceKind;
  path: string;
  text: string;
  link: string | null;
  is_whole: boolean;
}

/** The robot before, over which another one is shown; its files are with those of the scene. */
export interface Comparison {
  before: Scene;
  labels: [before: string, after: string];
  differences: Difference[];
  /** Names that are gone, on which others may rely. */
  removed: { kind: string; text: string }[];
  /** What happened to a link, by its name in the robot after, or before for one that is gone. */
  kinds: Record<string, DifferenceKind>;
  /** New names by old ones. */
  links: Record<string, string>;
  joints: Record<string, string>;
}

/** A joint comes after the joint above its parent. */
export interface Scene {
  name: string;
  links: Link[];
  joints: Joint[];
  states: GroupState[];
  files: Record<string, SceneFile>;
  missing: MissingFile[];
  view: View;
  live: boolean;
  comparison?: Comparison;
  /** That of the live viewer in which the scene was new. */
  version?: number;
}
