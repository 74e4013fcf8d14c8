/** A check box for each layer of the picture. */
import { LAYERS, type Layer, type State } from "../state";
import { make } from "./elements";

/** What each layer is called, and its key. */
export const LAYER_KEYS: Readonly<Record<Layer, { text: string; key: string }>> = {
  visuals: { text: "visuals", key: "v" },
  collisions: { text: "collisions", key: "c" },
  frames: { text: "frames", key: "f" },
  axes: { text: "joint axes", key: "a" },
  centers: { text: "centres of mass", key: "m" },
  inertias: { text: "inertia", key: "i" },
  grid: { text: "grid", key: "g" },
  labels: { text: "labels", key: "l" },
};

export function makeLayers(state: State): HTMLElement {
  const boxes = LAYERS.map((layer) => {
    const { text, key } = LAYER_KEYS[layer];
    const box = make("input", { type: "checkbox", name: layer, onchange: () => state.setLayer(layer, box.checked) });
    return { layer, box, label: make("label", { title: `show ${text} (${key})` }, box, text, make("kbd", {}, key)) };
  });
  const show = (): void => boxes.forEach(({ layer, box }) => (box.checked = state.layers.has(layer)));
  state.listen((change) => change === "layers" && show());
  show();
  const list = make("div", { className: "list" }, ...boxes.map(({ label }) => label));
  return make("details", { className: "layers", open: innerWidth > 1000 }, make("summary", {}, "Layers"), list);
}
