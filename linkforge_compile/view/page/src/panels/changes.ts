/** What differs between the two robots of a comparison, and the colours in which it is drawn. */
import { COLORS } from "../comparison";
import type { Comparison, Difference, DifferenceKind } from "../scene";
import type { State } from "../state";
import { make, makeButton, makeSection } from "./elements";

/** Make the section; its check boxes show the robots, and a difference selects its link. */
export function makeChanges(comparison: Comparison, state: State): HTMLElement {
  const [before, after] = comparison.labels;
  const boxes = [makeBox(`before: ${before}`, "before", state), makeBox(`after: ${after}`, "after", state)];
  const list = make("ul", { className: "changes" }, ...comparison.differences.map((one) => makeDifference(one, state)));
  const none = comparison.differences.length ? [] : [make("p", {}, "no differences")];
  return makeSection("Changes", ...boxes, makeLegend(comparison), ...none, ...makeRemoved(comparison), list);
}

/** Show the names that are gone, as `linkforge diff` prints them. */
function makeRemoved({ removed }: Comparison): HTMLElement[] {
  if (!removed.length) return [];
  const lines = removed.map(({ kind, text }) => make("div", {}, `${kind} ${text}`));
  return [make("div", { className: "removed-names" }, "breaking: removed names that others may rely on", ...lines)];
}

function makeBox(text: string, side: "before" | "after", state: State): HTMLElement {
  const box = make("input", { type: "checkbox", checked: state.sides.has(side) });
  box.onchange = () => state.showSide(side, box.checked);
  return make("label", { className: "side" }, box, text);
}

/** Name the colours that are used, in words. */
function makeLegend({ kinds }: Comparison): HTMLElement {
  const used = (Object.keys(COLORS) as DifferenceKind[]).filter((kind) => Object.values(kinds).includes(kind));
  const names = ["same", ...used, "before"];
  return make("p", { className: "legend" }, ...names.map((name) => make("span", { className: `change ${name}` }, name)));
}

function makeDifference({ kind, path, text, link }: Difference, state: State): HTMLElement {
  const className = `change ${kind}`;
  const select = makeButton(path, "select its link", () => state.select(link));
  const name = link === null ? make("span", { className }, path) : Object.assign(select, { className: `link ${className}` });
  return make("li", {}, name, ` ${text}`);
}
