/** What a search finds: names of links, joints and modules that contain it. */
import type { Joint, Link } from "../scene";
import type { State } from "../state";

/** Whether the search finds a link: by its name, its module's, or that of the joint above it. */
export function findsLink(state: State, link: Link): boolean {
  return contain(state.search, link.name, link.module, link.parent ?? "");
}

/** Whether the search finds a joint: by its name, its module's, or that of the link below it. */
export function findsJoint(state: State, joint: Joint): boolean {
  return contain(state.search, joint.name, joint.module, joint.child);
}

/** Make the field to search with; Enter selects the first link that it finds. */
export function bindSearch(field: HTMLInputElement, state: State): void {
  field.oninput = () => state.searchFor(field.value.trim());
  field.onkeydown = (event) => {
    if (event.key === "Enter") {
      const found = state.search && state.scene.links.find((link) => findsLink(state, link));
      if (found) state.select(found.name);
    } else if (event.key === "Escape") {
      field.value = "";
      state.searchFor("");
      field.blur();
    }
  };
}

function contain(search: string, ...names: string[]): boolean {
  return names.some((name) => name.toLowerCase().includes(search.toLowerCase()));
}
