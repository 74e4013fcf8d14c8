/** What is around the picture: joints, states, the tree, layers, details, parameters and problems. */
import type { State } from "../state";

/** What panels ask of the picture; all else goes through the state. */
export interface Actions {
  /** Show all of the robot. */
  fit(): void;
}

export function mountPanels(_state: State, _actions: Actions): void {}
