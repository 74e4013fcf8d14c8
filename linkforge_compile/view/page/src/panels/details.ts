/** The selected link, its joint and its shapes, and the lines of the spec that wrote them. */
import type { Joint, Link, Place, Shape } from "../scene";
import type { State } from "../state";
import { make, makeButton, moduleTag } from "./elements";
import { brief, positionUnit, shownLimits, shownPlace, shownPosition, shownSize } from "./numbers";

export function makeDetails(state: State): HTMLElement {
  const section = make("section", { className: "details", ariaLabel: "selected link" });
  section.setAttribute("aria-live", "polite");
  const position = make("output");
  const showPosition = (): void => {
    const joint = state.joint(state.link(state.selected)?.parent ?? null);
    if (joint) position.value = shownNow(joint, state);
  };
  const show = (): void => {
    const link = state.link(state.selected);
    section.hidden = !link;
    section.replaceChildren(...(link ? linkParts(link, position, state) : []));
    showPosition();
  };
  state.listen((change) => {
    if (change === "scene" || change === "selection" || change === "units") show();
    if (change === "positions") showPosition();
  });
  show();
  return section;
}

function linkParts(link: Link, position: HTMLElement, state: State): HTMLElement[] {
  const joint = state.joint(link.parent);
  const close = makeButton("×", "clear the selection (Esc)", () => state.select(null));
  close.ariaLabel = "clear the selection";
  const heading = make("h2", {}, link.name);
  const parts = [make("div", { className: "line" }, heading, ...moduleTag(link.module), close), ...sourceLine(link.source)];
  parts.push(makeList([...massRows(link), ...shapeRows("visual", link.visuals, state), ...shapeRows("collision", link.collisions, state)]));
  if (joint) parts.push(make("h3", {}, `joint ${joint.name}`), ...sourceLine(joint.source), makeList(jointRows(joint, position, state)));
  return parts;
}

type Row = [name: string, value: Node | string];

function makeList(rows: readonly Row[]): HTMLElement {
  const pairs = rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]);
  return make("dl", {}, ...pairs);
}

function massRows({ mass, center, inertia }: Link): Row[] {
  if (mass === null) return [["mass", "none"]];
  const rows: Row[] = [["mass", `${brief(mass)} kg`]];
  if (center) rows.push(["centre of mass", `${vector(center)} m`]);
  if (!inertia) return rows;
  return [...rows, ["inertia at the centre of mass [kg*m^2]", inertiaTable(inertia.moments)]];
}

function inertiaTable(moments: readonly number[]): HTMLTableElement {
  const [ixx, iyy, izz, ixy, ixz, iyz] = moments.map((moment) => brief(moment, 3));
  const lines = [[ixx, ixy, ixz], ["", iyy, iyz], ["", "", izz]];
  const rows = lines.map((line) => make("tr", {}, ...line.map((moment) => make("td", {}, moment ?? ""))));
  return make("table", { className: "inertia" }, ...rows);
}

function jointRows(joint: Joint, position: HTMLElement, state: State): Row[] {
  const unit = joint.type === "prismatic" ? "m/s" : "rad/s";
  const force = joint.type === "prismatic" ? "N" : "N*m";
  const above = makeButton(joint.parent, "select the link above", () => state.select(joint.parent));
  above.className = "link";
  const rows: Row[] = [["type", joint.type], ["above", above]];
  if (joint.type === "fixed") return rows;
  if (joint.axis) rows.push(["axis", vector(joint.axis)]);
  if (joint.type === "planar" || joint.type === "floating") return rows;
  rows.push(["limits", shownLimits(joint, state.isInDegrees)], ["position", position]);
  if (joint.velocity !== null) rows.push(["velocity", `at most ${brief(joint.velocity)} ${unit}`]);
  if (joint.effort !== null) rows.push(["effort", `at most ${brief(joint.effort)} ${force}`]);
  if (joint.mimic) rows.push(["mimics", joint.mimic.joint]);
  return rows;
}

function shapeRows(kind: string, shapes: readonly Shape[], state: State): Row[] {
  return shapes.map((shape, index) => [index === 0 ? kind : "", shownShape(shape, state)]);
}

function shownShape(shape: Shape, state: State): Node | string {
  const name = shape.name ? `${shape.name}: ` : "";
  const numbers = (...all: (number | undefined)[]): string => all.map((number) => brief(number ?? 0)).join(" × ");
  if (shape.type === "box") return `${name}box ${numbers(...(shape.size ?? []))} m`;
  if (shape.type === "sphere") return `${name}sphere, radius ${numbers(shape.radius)} m`;
  if (shape.type !== "mesh") return `${name}${shape.type}, radius ${numbers(shape.radius)} m, length ${numbers(shape.length)} m`;
  const file = state.scene.files[shape.file ?? ""];
  if (!file) return make("span", { className: "missing" }, `${name}mesh, not shown`);
  return make("span", { title: file.name }, `${name}${file.name.split("/").at(-1) ?? ""}, ${shownSize(file.size)}`);
}

function sourceLine(source: Place | null): HTMLElement[] {
  if (!source) return [];
  const text = make("code", {}, shownPlace(source));
  const copy = makeButton("copy", "copy the location in the spec", () => void copyText(text, copy));
  return [make("div", { className: "line source" }, text, copy)];
}

/** Copy the text; where the browser forbids that, select it for Ctrl+C. */
async function copyText(text: HTMLElement, button: HTMLButtonElement): Promise<void> {
  try {
    await navigator.clipboard.writeText(text.textContent ?? "");
    button.replaceChildren("copied");
  } catch {
    getSelection()?.selectAllChildren(text);
    button.replaceChildren("Ctrl+C");
  }
  setTimeout(() => button.replaceChildren("copy"), 1500);
}

function shownNow(joint: Joint, state: State): string {
  const unit = positionUnit(joint, state.isInDegrees);
  const position = shownPosition(state.positions[joint.name] ?? 0, unit);
  return position.replace("-", "−") + (unit.name === "°" ? "" : " ") + unit.name;
}

function vector(numbers: readonly number[]): string {
  return numbers.map((number) => brief(number)).join("  ");
}
