/** Keys, and the dialog that lists them. */
import { LAYERS, type State } from "../state";
import { make, makeButton } from "./elements";
import { moveAtRandom } from "./joints";
import { LAYER_KEYS } from "./layers";
import { defaultPositions } from "./states";

interface Key {
  key: string;
  text: string;
  press(): void;
}

/** What the keys do, but those of the tree, in the order of the help. */
export function makeKeys(state: State, search: HTMLInputElement, fit: () => void, help: () => void): Key[] {
  const layers = LAYERS.map((layer) => ({
    key: LAYER_KEYS[layer].key,
    text: `show or hide ${LAYER_KEYS[layer].text}`,
    press: () => state.setLayer(layer, !state.layers.has(layer)),
  }));
  return [
    ...layers,
    { key: "/", text: "search for links, joints and modules", press: () => search.focus() },
    { key: "Home", text: "show the whole robot", press: fit },
    { key: "d", text: "move all joints to the default pose", press: () => state.setPositions(defaultPositions(state)) },
    { key: "r", text: "move all joints to their start positions", press: () => state.setPositions(state.start) },
    { key: "p", text: "move all joints to random positions", press: () => moveAtRandom(state) },
    { key: "u", text: "show angles in degrees or radians", press: () => state.useDegrees(!state.isInDegrees) },
    { key: "h", text: "show or hide the selected link", press: () => hideSelected(state) },
    { key: "Escape", text: "clear the selection", press: () => state.select(null) },
    { key: "?", text: "show this help", press: help },
  ];
}

function hideSelected(state: State): void {
  if (state.selected !== null) state.hide([state.selected], !state.hidden.has(state.selected));
}

/** Call what a key does, except while the user writes into a field. */
export function listenToKeys(keys: readonly Key[]): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || isTyping(event) || document.querySelector("dialog[open]")) return;
    const found = keys.find(({ key }) => key === event.key);
    if (!found) return;
    event.preventDefault();
    found.press();
  });
}

function isTyping(event: KeyboardEvent): boolean {
  const { target } = event;
  if (target instanceof HTMLInputElement) {
    return ["text", "search", "number"].includes(target.type) || (target.type === "range" && event.key === "Home");
  }
  return target instanceof HTMLSelectElement;
}

/** Make the dialog; Escape closes it. */
export function makeHelp(keys: readonly Key[]): HTMLDialogElement {
  const rows = keys.flatMap(({ key, text }) => [make("dt", {}, make("kbd", {}, key)), make("dd", {}, text)]);
  const dialog = make("dialog", { className: "help" });
  dialog.append(
    make("h2", {}, "Keyboard shortcuts"),
    make("dl", {}, ...rows),
    make("h3", {}, "In the tree"),
    make("p", {}, "↑ ↓ select a link, ← → collapse and expand it, Space hides or shows it, Shift+Space also all links below it."),
    make("h3", {}, "Mouse"),
    make("p", {}, "Drag to rotate, drag with the right button to pan, scroll to zoom, click to select a link. Double-click a slider to reset it."),
    makeButton("close", "close (Esc)", () => dialog.close()),
  );
  return dialog;
}
