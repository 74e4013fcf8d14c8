/** The page: it shows the scene that is in it, and what the user does with it. */
import "./style.css";
import "./picture.css";
import { jointPositions } from "./kinematics";
import { mountPanels } from "./panels/index";
import { Picture } from "./picture";
import type { Scene } from "./scene";
import { LAYERS, State } from "./state";

/** For tests, and for people at the browser's console. */
export interface Console {
  /** When the last scene is loaded and drawn. */
  readonly ready: Promise<void>;
  scene(): Scene;
  /** Of all movable joints, mimic joints too. */
  positions(): Readonly<Record<string, number>>;
  set(positions: Record<string, number>): void;
  /** The place of a link in the world: 16 numbers, row by row. */
  transform(link: string): number[];
  /** The least and the largest corner of the visuals of a link in the world. */
  extent(link: string): [number[], number[]];
  /** The places of the links of the robot before, of a comparison, as far as they are drawn. */
  before(): Record<string, number[]>;
  select(link: string | null): void;
  layer(name: string, isShown: boolean): void;
  /** How much the graphics card holds. */
  memory(): { geometries: number; textures: number };
}

declare global {
  interface Window {
    linkforge: Console;
  }
}

function start(scene: Scene): Console {
  const state = new State(scene);
  if (!scene.view.panels) document.documentElement.style.colorScheme = "light"; // a picture is the same on all machines
  const picture = new Picture(document.getElementById("viewport")!, state);
  if (scene.view.panels) mountPanels(state, { fit: () => picture.fit() });
  return {
    get ready() {
      return picture.ready;
    },
    scene: () => state.scene,
    positions: () => jointPositions(state.scene.joints, state.positions),
    set: (positions) => state.setPositions(positions),
    transform: (link) => picture.shown.transform(link).transpose().toArray(),
    extent: (link) => {
      const { min, max } = picture.shown.extentOf(link);
      return [min.toArray(), max.toArray()];
    },
    before: () => {
      const drawn = picture.compared?.drawn ?? [];
      return Object.fromEntries(drawn.map(([link, place]) => [link, place.transpose().toArray()]));
    },
    select: (link) => state.select(link),
    layer: (name, isShown) => {
      const layer = LAYERS.find((one) => one === name);
      if (!layer) throw new Error(`no layer named ${name}; the layers are ${LAYERS.join(", ")}`);
      state.setLayer(layer, isShown);
    },
    memory: () => ({ ...picture.viewport.renderer.info.memory }),
  };
}

const scene = JSON.parse(document.getElementById("scene")!.textContent) as Scene | null;
const notice = document.getElementById("starting")!;
try {
  if (scene) window.linkforge = start(scene);
  notice.remove();
} catch (error) {
  notice.append(` It did not start: ${error instanceof Error ? error.message : String(error)}`);
  throw error;
}
