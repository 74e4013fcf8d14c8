/** What the user set, and the scene it is about: the one place of mutable state. */
import type { Scene } from "./scene";

export const LAYERS = ["visuals", "collisions", "frames", "axes", "centers", "inertias", "grid"] as const;
export type Layer = (typeof LAYERS)[number];
export type Change = "scene" | "positions" | "layers" | "selection";
type Listener = (change: Change) => void;

const SHOWN_AT_FIRST: readonly Layer[] = ["visuals", "grid"];

export class State {
  /** Of free joints that were moved; any other is where it starts. */
  positions: Record<string, number> = {};
  layers = new Set<Layer>(SHOWN_AT_FIRST);
  /** A link. */
  selected: string | null = null;
  private readonly listeners: Listener[] = [];

  constructor(public scene: Scene) {
    this.positions = { ...scene.view.pose };
    if (scene.view.layers) this.layers = new Set(LAYERS.filter((layer) => scene.view.layers?.includes(layer)));
  }

  listen(listener: Listener): void {
    this.listeners.push(listener);
  }

  setScene(scene: Scene): void {
    this.scene = scene;
    this.tell("scene");
  }

  setPositions(positions: Record<string, number>): void {
    this.positions = { ...this.positions, ...positions };
    this.tell("positions");
  }

  setLayer(layer: Layer, on: boolean): void {
    if (on) this.layers.add(layer);
    else this.layers.delete(layer);
    this.tell("layers");
  }

  select(link: string | null): void {
    this.selected = link;
    this.tell("selection");
  }

  private tell(change: Change): void {
    for (const listener of this.listeners) listener(change);
  }
}
