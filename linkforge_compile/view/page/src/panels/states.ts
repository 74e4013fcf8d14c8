/** Poses as buttons: the default, and the states of each group. */
import { isFree } from "../kinematics";
import type { GroupState } from "../scene";
import type { State } from "../state";
import { make, makeButton, makeSection } from "./elements";

const NEAR = 1e-4; // [rad, m]; a joint this near has reached its position

export function makePoses(state: State): HTMLElement {
  const section = makeSection("Poses");
  let buttons: PoseButton[] = [];
  const show = (): void => buttons.forEach((button) => button.show());
  const rebuild = (): void => {
    const start = new PoseButton("default", () => defaultPositions(state), state);
    start.element.title = "move each joint to 0, or to the middle of limits that exclude 0";
    const groups = byGroup(state.scene.states).map(([group, states]) => {
      const made = states.map(({ name, positions }) => new PoseButton(name, () => onlyNumbers(positions), state));
      return { row: makeRow(group, made), made };
    });
    buttons = [start, ...groups.flatMap(({ made }) => made)];
    section.replaceChildren(section.firstElementChild!, makeRow("all joints", [start]), ...groups.map(({ row }) => row));
    show();
  };
  state.listen((change) => {
    if (change === "scene") rebuild();
    if (change === "positions") show();
  });
  rebuild();
  return section;
}

/** Return MoveIt's default pose: each free joint at 0, or in the middle of limits that exclude it. */
export function defaultPositions(state: State): Record<string, number> {
  return Object.fromEntries(state.scene.joints.filter(isFree).map(({ name, value }) => [name, value]));
}

function makeRow(group: string, buttons: PoseButton[]): HTMLElement {
  const made = buttons.map(({ element }) => element);
  const row = make("div", { className: "poses", role: "group", ariaLabel: group });
  row.append(make("span", { className: "group", title: group }, group), ...made);
  return row;
}

class PoseButton {
  readonly element: HTMLButtonElement;

  constructor(
    name: string,
    private readonly positions: () => Record<string, number>,
    private readonly state: State,
  ) {
    this.element = makeButton(name, `move the joints to ${name}`, () => state.setPositions(positions()));
  }

  /** Mark the button while the robot has the pose. */
  show(): void {
    const moved = Object.entries(this.positions()).filter(([name]) => this.state.joint(name));
    const isReached = moved.every(([name, target]) => Math.abs((this.state.positions[name] ?? 0) - target) < NEAR);
    this.element.ariaPressed = String(isReached && moved.length > 0);
  }
}

function byGroup(states: readonly GroupState[]): [string, GroupState[]][] {
  const groups = new Map<string, GroupState[]>();
  for (const state of states) groups.set(state.group, [...(groups.get(state.group) ?? []), state]);
  return [...groups];
}

/** Return the positions of joints that one number places. */
function onlyNumbers(positions: Record<string, number[]>): Record<string, number> {
  return Object.fromEntries(Object.entries(positions).flatMap(([name, all]) => (all.length === 1 ? [[name, all[0]!]] : [])));
}
