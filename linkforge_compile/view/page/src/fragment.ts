/** What the user set, in the fragment of the page's address: a reload keeps it, and a link shares it. */
import { LAYERS, type State } from "./state";

const JOINT = "joint.";
const DELAY = 300; // [ms]; browsers limit how often a page changes its address

/** Set what the address states, and keep the address as the user changes it. */
export function keepInAddress(state: State): void {
  restore(state, new URLSearchParams(location.hash.slice(1)));
  let timer: number | undefined;
  state.listen(() => {
    window.clearTimeout(timer);
    timer = window.setTimeout(() => replaceAddress(state), DELAY);
  });
  window.addEventListener("hashchange", () => restore(state, new URLSearchParams(location.hash.slice(1))));
}

function restore(state: State, stored: URLSearchParams): void {
  const joints = [...stored].filter(([key]) => key.startsWith(JOINT));
  state.setPositions(Object.fromEntries(joints.map(([key, text]) => [key.slice(JOINT.length), Number.parseFloat(text)])));
  const layers = stored.get("layers")?.split(",");
  if (layers) for (const layer of LAYERS) state.setLayer(layer, layers.includes(layer));
  if (stored.has("link")) state.select(stored.get("link"));
  if (stored.has("hidden")) state.hide(stored.getAll("hidden"), true);
  if (stored.has("unit")) state.useDegrees(stored.get("unit") !== "rad");
}

function replaceAddress(state: State): void {
  if (location.protocol === "about:") return; // A frame without an address of its own, as in a notebook.
  const fragment = fragmentOf(state);
  history.replaceState(null, "", fragment ? `#${fragment}` : location.pathname + location.search);
}

function fragmentOf(state: State): string {
  const stored = new URLSearchParams();
  for (const [name, start] of Object.entries(state.start)) {
    const position = state.positions[name] ?? start;
    if (position !== start) stored.set(JOINT + name, String(Number(position.toFixed(6))));
  }
  const layers = LAYERS.filter((layer) => state.layers.has(layer)).join(",");
  if (layers !== LAYERS.filter((layer) => state.firstLayers.has(layer)).join(",")) stored.set("layers", layers);
  if (state.selected !== null) stored.set("link", state.selected);
  for (const link of state.hidden) stored.append("hidden", link);
  if (!state.isInDegrees) stored.set("unit", "rad");
  return stored.toString();
}
