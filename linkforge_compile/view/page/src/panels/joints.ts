/** A slider and a number for each movable joint, in the order of the tree. */
import { isFree, isMovable } from "../kinematics";
import type { Joint } from "../scene";
import type { State } from "../state";
import { make, makeButton, makeSection } from "./elements";
import { brief, positionUnit, shownLimits, shownPosition, sliderRange } from "./numbers";
import { findsJoint } from "./search";

export function makeJoints(state: State): HTMLElement {
  const list = make("div", { className: "joints" });
  let rows: JointRow[] = [];
  const rebuild = (): void => {
    // The row of a joint that is as before stays, with the pointer that drags its slider.
    const known = new Map(rows.map((row) => [JSON.stringify(row.joint), row]));
    const made = state.scene.joints.filter(isMovable).map((joint) => known.get(JSON.stringify(joint)) ?? new JointRow(joint, state));
    const isOther = made.length !== rows.length || made.some((row, index) => row !== rows[index]);
    rows = made;
    if (isOther) list.replaceChildren(...rows.map((row) => row.element));
    show();
    filter();
  };
  const show = (): void => rows.forEach((row) => row.show());
  const filter = (): void => {
    for (const row of rows) row.element.hidden = !findsJoint(state, row.joint);
    const isEmpty = rows.every((row) => row.element.hidden);
    list.dataset["empty"] = !isEmpty ? "" : rows.length ? "no movable joint matches the search" : "this robot has no movable joints";
  };
  state.listen((change) => {
    if (change === "scene") rebuild();
    if (change === "search") filter();
    if (change === "positions" || change === "units" || change === "selection") show();
  });
  rebuild();
  return makeSection("Joints", makeTools(state), list);
}

function makeTools(state: State): HTMLElement {
  const units = [makeUnit("deg", true, state), makeUnit("rad", false, state)];
  return make(
    "div",
    { className: "tools" },
    makeButton("reset all", "move all joints to their start positions (r)", () => state.setPositions(state.start)),
    makeButton("random", "move all joints to random positions within their limits (p)", () => moveAtRandom(state)),
    make("span", { className: "units", role: "group", ariaLabel: "angle unit" }, ...units),
  );
}

function makeUnit(text: string, isInDegrees: boolean, state: State): HTMLButtonElement {
  const button = makeButton(text, `show angles in ${text} (u)`, () => state.useDegrees(isInDegrees));
  const show = (): void => {
    button.ariaPressed = String(state.isInDegrees === isInDegrees);
  };
  state.listen((change) => change === "units" && show());
  show();
  return button;
}

/** Move each free joint to a random position within its limits. */
export function moveAtRandom(state: State): void {
  const free = state.scene.joints.filter(isFree);
  state.setPositions(
    Object.fromEntries(
      free.map((joint) => {
        const [least, most] = sliderRange(joint);
        return [joint.name, least + Math.random() * (most - least)];
      }),
    ),
  );
}

class JointRow {
  readonly element: HTMLElement;
  private readonly name: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly number: HTMLInputElement;
  private readonly unit = make("span", { className: "unit" });
  private readonly reset: HTMLButtonElement;

  constructor(
    readonly joint: Joint,
    private readonly state: State,
  ) {
    const { name, child } = joint;
    const [least, most] = sliderRange(joint);
    const label = `position of ${name}`;
    const range = { min: String(least), max: String(most), step: "any" };
    this.name = makeButton(name, "", () => state.select(child));
    this.name.className = "name";
    this.slider = make("input", { type: "range", ...range, ariaLabel: label, disabled: !isFree(joint) });
    this.number = make("input", { type: "number", ariaLabel: `${label}, number`, disabled: !isFree(joint) });
    this.reset = makeButton("↺", `move ${name} to its start position`, () => this.moveToStart());
    this.slider.oninput = () => state.setPositions({ [name]: this.slider.valueAsNumber });
    this.slider.ondblclick = () => this.moveToStart();
    this.number.onchange = () => this.readNumber();
    const head = make("div", { className: "line" }, this.name, this.number, this.unit);
    const body = make("div", { className: "line" }, this.slider, this.reset);
    this.element = make("div", { className: "joint" }, head, body);
    if (joint.mimic) this.element.append(make("div", { className: "mimic" }, shownMimic(joint)));
    this.element.dataset["joint"] = name;
    this.show();
  }

  /** Show the position, its unit, and whether the joint's link is selected. */
  show(): void {
    const { joint, state } = this;
    const position = state.positions[joint.name] ?? 0;
    const unit = positionUnit(joint, state.isInDegrees);
    this.slider.value = String(position);
    this.slider.ariaValueText = `${shownPosition(position, unit)} ${unit.name}`;
    this.number.value = shownPosition(position, unit);
    this.number.step = String(unit.step);
    this.unit.replaceChildren(unit.name);
    this.name.title = `${joint.name}: ${joint.type}, limits: ${shownLimits(joint, state.isInDegrees)}`;
    this.reset.style.visibility = isFree(joint) && position !== state.start[joint.name] ? "" : "hidden";
    this.element.classList.toggle("selected", joint.child === state.selected);
  }

  private moveToStart(): void {
    this.state.setPositions({ [this.joint.name]: this.state.start[this.joint.name] ?? this.joint.value });
  }

  private readNumber(): void {
    const unit = positionUnit(this.joint, this.state.isInDegrees);
    const number = this.number.valueAsNumber;
    if (Number.isNaN(number)) this.show();
    else this.state.setPositions({ [this.joint.name]: number / unit.scale });
  }
}

function shownMimic(joint: Joint): string {
  if (!joint.mimic) return "";
  const { joint: leader, multiplier, offset } = joint.mimic;
  const product = multiplier === 1 ? leader : `${brief(multiplier)} × ${leader}`;
  if (offset === 0) return `= ${product}`;
  return `= ${product} ${offset < 0 ? "−" : "+"} ${brief(Math.abs(offset))}`;
}
