/** What is around the picture: joints, poses, the tree, layers, details, parameters and problems. */
import { keepInAddress } from "../fragment";
import { listen } from "../live";
import type { State } from "../state";
import { makeDetails } from "./details";
import { makeChanges } from "./changes";
import { counted, make, makeButton } from "./elements";
import { makeJoints } from "./joints";
import { listenToKeys, makeHelp, makeKeys } from "./keys";
import { makeLayers } from "./layers";
import { makeParameters } from "./parameters";
import { makeProblems } from "./problems";
import { bindSearch } from "./search";
import { makePoses } from "./states";
import { makeTree } from "./tree";

/** What panels ask of the picture; all else goes through the state. */
interface Actions {
  /** Show all of the robot. */
  fit(): void;
}

export function mountPanels(state: State, actions: Actions): void {
  const search = make("input", { type: "search", className: "search", placeholder: "Search (/)", spellcheck: false });
  search.ariaLabel = "search for links, joints and modules";
  bindSearch(search, state);
  const keys = makeKeys(state, search, () => actions.fit(), () => help.showModal());
  const help = makeHelp(keys);
  listenToKeys(keys);
  const left = make("aside", { id: "left", ariaLabel: "tree" }, makeTree(state), makeDetails(state));
  const { live, comparison } = state.scene;
  const settings = [...(live ? [makeParameters(state)] : []), ...(comparison ? [makeChanges(comparison, state)] : [])];
  const right = make("aside", { id: "right", ariaLabel: "joints" }, ...settings, makePoses(state), makeJoints(state));
  const over = make("div", { id: "over" }, makeLayers(state), makeProblems(state));
  const bar = makeBar(state, search, actions, help);
  document.getElementById("panels")!.append(bar, left, over, right, help);
  document.body.classList.add("has-panels");
  keepInAddress(state);
  if (state.scene.live) listen(state);
}

function makeBar(state: State, search: HTMLInputElement, actions: Actions, help: HTMLDialogElement): HTMLElement {
  const name = make("h1");
  const figures = make("span", { className: "figures" });
  const show = (): void => {
    const { links, joints } = state.scene;
    name.replaceChildren(state.scene.name);
    const moving = joints.filter(({ type, mimic }) => type !== "fixed" && !mimic).length;
    figures.replaceChildren(`${counted(links.length, "link")} · ${counted(moving, "movable joint")}`);
    document.title = state.scene.name;
  };
  state.listen((change) => change === "scene" && show());
  show();
  const fit = makeButton("fit", "show the whole robot (Home)", () => actions.fit());
  const keys = makeButton("?", "show the keyboard shortcuts (?)", () => help.showModal());
  return make("header", { id: "bar" }, makeToggle("left", "tree"), name, figures, search, fit, keys, makeToggle("right", "joints"));
}

/** Make a button that opens and closes a side of the page. */
function makeToggle(side: "left" | "right", text: string): HTMLButtonElement {
  const toggle = makeButton(text, `show or hide the ${text}`, () => set(toggle.ariaPressed !== "true"));
  const set = (isShown: boolean): void => {
    toggle.ariaPressed = String(isShown);
    document.body.classList.toggle(`no-${side}`, !isShown);
  };
  set(side === "right" || innerWidth > 900);
  return toggle;
}
