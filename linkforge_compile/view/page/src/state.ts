/** What the user set, and what the server reported: the one place of the page that changes. */
import { isFree, jointPositions, withinLimits, type Positions } from "./kinematics";
import type { Joint, Link, Place, Scene } from "./scene";

export const LAYERS = ["visuals", "collisions", "frames", "axes", "centers", "inertias", "grid", "labels"] as const;
export type Layer = (typeof LAYERS)[number];

const FIRST_LAYERS: readonly Layer[] = ["visuals", "grid"];
/** The first ones of a robot that has no visuals. */
const WITHOUT_VISUALS: readonly Layer[] = [...FIRST_LAYERS, "collisions", "frames"];
/** Of more links, frames are slow to draw and hide each other. */
const MOST_FRAMES = 500;

/** The robots of a comparison. */
type Side = "before" | "after";

export type Change = "scene" | "positions" | "layers" | "sides" | "selection" | "hidden" | "search" | "units" | "live";
type Listener = (change: Change) => void;

export interface Problem extends Partial<Omit<Place, "file">> {
  severity: string;
  code: string;
  message: string;
  file?: string | null;
  /** The address of the page that explains the code. */
  page?: string | null;
  hints?: string[];
  /** The line at fault, with a mark under the words. */
  snippet?: string;
}

export interface Parameter {
  name: string;
  /** null: its declaration is faulty. */
  type: string | null;
  /** The SI unit of `minimum`, `maximum` and `choices`. */
  unit: string | null;
  value: string | null;
  /** null: the parameter is required. */
  default: string | null;
  /** What the slider shows, in `unit`; null: no number. */
  number: number | null;
  minimum: number | null;
  maximum: number | null;
  choices: (string | number | boolean)[] | null;
  description: string;
}

interface Settings {
  parameters: Parameter[];
  variants: string[];
  variant: string | null;
}

/** An update of the server; a null scene: the last good one stays. */
export interface Update {
  version: number;
  scene: Scene | null;
  problems: Problem[];
  settings: Settings;
}

export class State {
  /** Why no updates arrive; "" while they do. */
  connection = "";
  problems: readonly Problem[] = [];
  /** Why files of the scene are not shown, by digest. */
  unreadable: ReadonlyMap<string, string> = new Map();
  settings: Settings = { parameters: [], variants: [], variant: null };
  #scene: Scene;
  #start: Record<string, number>;
  #set: Record<string, number>;
  #positions: Positions;
  #layers: ReadonlySet<Layer>;
  #hidden: ReadonlySet<string> = new Set();
  #sides: ReadonlySet<Side> = new Set(["before", "after"]);
  #selected: string | null = null;
  #search = "";
  #isInDegrees = true;
  #joints = new Map<string, Joint>();
  #links = new Map<string, Link>();
  readonly #listeners: Listener[] = [];

  constructor(scene: Scene) {
    this.#scene = scene;
    this.#index();
    this.#start = startPositions(scene);
    this.#set = { ...this.#start };
    this.#positions = jointPositions(scene.joints, this.#set);
    this.#layers = this.firstLayers;
  }

  /** Call the listener after each change. */
  listen(listener: Listener): void {
    this.#listeners.push(listener);
  }

  get scene(): Scene {
    return this.#scene;
  }

  /** The position of each movable joint, those that mimic included [rad, m]. */
  get positions(): Positions {
    return this.#positions;
  }

  get layers(): ReadonlySet<Layer> {
    return this.#layers;
  }

  /** Names of the links that are not drawn. */
  get hidden(): ReadonlySet<string> {
    return this.#hidden;
  }

  /** Which robots of a comparison are drawn. */
  get sides(): ReadonlySet<Side> {
    return this.#sides;
  }

  /** The name of the selected link. */
  get selected(): string | null {
    return this.#selected;
  }

  get search(): string {
    return this.#search;
  }

  get isInDegrees(): boolean {
    return this.#isInDegrees;
  }

  joint(name: string | null): Joint | undefined {
    return name === null ? undefined : this.#joints.get(name);
  }

  link(name: string | null): Link | undefined {
    return name === null ? undefined : this.#links.get(name);
  }

  /** Move joints, each within its limits; other names are ignored. */
  setPositions(positions: Positions): void {
    for (const [name, position] of Object.entries(positions)) {
      const joint = this.#joints.get(name);
      if (joint && isFree(joint) && Number.isFinite(position)) this.#set[name] = withinLimits(joint, position);
    }
    this.#positions = jointPositions(this.#scene.joints, this.#set);
    this.#tell("positions");
  }

  /** Where the joints are when the page opens. */
  get start(): Positions {
    return this.#start;
  }

  /** Which layers are on when the page opens. */
  get firstLayers(): ReadonlySet<Layer> {
    const { links, view } = this.#scene;
    if (view.layers) return new Set(LAYERS.filter((layer) => view.layers!.includes(layer)));
    const isInvisible = links.length > 0 && links.every(({ visuals }) => !visuals.length);
    return new Set(isInvisible && view.panels && links.length <= MOST_FRAMES ? WITHOUT_VISUALS : FIRST_LAYERS);
  }

  setLayer(layer: Layer, isShown: boolean): void {
    this.#layers = changed(this.#layers, layer, isShown);
    this.#tell("layers");
  }

  showSide(side: Side, isShown: boolean): void {
    this.#sides = changed(this.#sides, side, isShown);
    this.#tell("sides");
  }

  hide(links: readonly string[], isHidden: boolean): void {
    for (const link of links) this.#hidden = changed(this.#hidden, link, isHidden);
    this.#tell("hidden");
  }

  /** Select a link; null, and the name of no link, select nothing. */
  select(link: string | null): void {
    const found = this.link(link)?.name ?? null;
    if (found === this.#selected) return;
    this.#selected = found;
    this.#tell("selection");
  }

  searchFor(text: string): void {
    this.#search = text;
    this.#tell("search");
  }

  useDegrees(isInDegrees: boolean): void {
    this.#isInDegrees = isInDegrees;
    this.#tell("units");
  }

  /** Show an update of the server. */
  receive(update: Update): void {
    this.problems = update.problems;
    this.settings = update.settings;
    if (update.scene) this.setScene(update.scene);
    this.#tell("live");
  }

  /** Show why no updates arrive; "": they do again. */
  reportConnection(connection: string): void {
    if (connection === this.connection) return;
    this.connection = connection;
    this.#tell("live");
  }

  reportUnreadable(unreadable: ReadonlyMap<string, string>): void {
    this.unreadable = unreadable;
    this.#tell("live");
  }

  /** Show another robot; positions, layers and the selection stay as far as their names do, or a joint's child link. */
  setScene(scene: Scene): void {
    const before = renamed(this.#set, this.#scene, scene);
    const isAsFirst = isEmpty(this.#scene) && LAYERS.every((layer) => this.layers.has(layer) === this.firstLayers.has(layer));
    this.#scene = scene;
    this.#index();
    this.#start = startPositions(scene);
    this.#set = { ...this.#start };
    for (const name of Object.keys(this.#set)) {
      const joint = this.#joints.get(name);
      const position = before[name];
      if (joint && position !== undefined) this.#set[name] = withinLimits(joint, position);
    }
    this.#positions = jointPositions(scene.joints, this.#set);
    this.#hidden = new Set([...this.#hidden].filter((name) => this.#links.has(name)));
    this.#selected = this.link(this.#selected)?.name ?? null;
    this.#tell("scene");
    if (!isAsFirst) return;
    this.#layers = this.firstLayers;
    this.#tell("layers");
  }

  #index(): void {
    this.#joints = new Map(this.#scene.joints.map((joint) => [joint.name, joint]));
    this.#links = new Map(this.#scene.links.map((link) => [link.name, link]));
  }

  #tell(change: Change): void {
    for (const listener of this.#listeners) listener(change);
  }
}

/** Whether a scene is what a live viewer shows before the first robot. */
export function isEmpty(scene: Scene): boolean {
  return scene.live && !scene.version;
}

/** Return positions under the names of another scene: of a joint that is gone, by the new one of its child link. */
function renamed(positions: Positions, before: Scene, after: Scene): Positions {
  const [old, now] = [before, after].map(({ joints }) => new Map(joints.map(({ name, type }) => [name, type])));
  const byChild = new Map(after.joints.filter(({ name }) => !old!.has(name)).map((joint) => [joint.child, joint]));
  const found: Record<string, number> = { ...positions };
  for (const { name, type, child } of before.joints) {
    const joint = byChild.get(child);
    if (!now!.has(name) && joint?.type === type && positions[name] !== undefined) found[joint.name] = positions[name];
  }
  return found;
}

function startPositions(scene: Scene): Record<string, number> {
  const free = scene.joints.filter(isFree);
  return Object.fromEntries(free.map((joint) => [joint.name, scene.view.pose?.[joint.name] ?? joint.value]));
}

function changed<T>(set: ReadonlySet<T>, member: T, isMember: boolean): ReadonlySet<T> {
  const others = [...set].filter((other) => other !== member);
  return new Set(isMember ? [...others, member] : others);
}
