/** The page: it shows the scene that is in it, and what the user does with it. */
import "./style.css";
import { jointPositions } from "./kinematics";
import { mountPanels } from "./panels/index";
import { Robot } from "./robot";
import type { Scene } from "./scene";
import { LAYERS, State, type Layer } from "./state";
import { Viewport } from "./viewport";

/** For tests, and for people at the browser's console. */
export interface Console {
  /** When everything is loaded and drawn. */
  ready: Promise<void>;
  scene(): Scene;
  /** Of all movable joints, mimic joints too. */
  positions(): Record<string, number>;
  set(positions: Record<string, number>): void;
  /** The place of a link in the world: 16 numbers, row by row. */
  transform(link: string): number[];
  select(link: string | null): void;
  layer(name: Layer, on: boolean): void;
}

declare global {
  interface Window {
    linkforge: Console;
  }
}

function start(scene: Scene): Console {
  const state = new State(scene);
  const viewport = new Viewport(document.getElementById("viewport")!);
  let robot = new Robot(scene);
  viewport.scene.add(robot.root);
  robot.move(state.positions);
  viewport.fit(robot.extent(), scene.view.camera);
  state.listen((change) => {
    if (change === "scene") {
      viewport.scene.remove(robot.root);
      robot = new Robot(state.scene);
      viewport.scene.add(robot.root);
    }
    if (change === "scene" || change === "positions") robot.move(state.positions);
    viewport.redraw();
  });
  if (scene.view.panels) mountPanels(state, { fit: () => viewport.fit(robot.extent()) });
  return {
    ready: Promise.resolve(viewport.draw()),
    scene: () => state.scene,
    positions: () => jointPositions(state.scene.joints, state.positions),
    set: (positions) => state.setPositions(positions),
    transform: (link) => robot.transform(link).transpose().toArray(),
    select: (link) => state.select(link),
    layer: (name, on) => state.setLayer(LAYERS.find((layer) => layer === name) ?? "visuals", on),
  };
}

const scene = JSON.parse(document.getElementById("scene")!.textContent) as Scene | null;
if (scene) window.linkforge = start(scene);
