/** The tree of links, each with the joint above it. */
import type { Joint, Link } from "../scene";
import type { State } from "../state";
import { make, makeButton, moduleTag } from "./elements";
import { findsLink } from "./search";

const GLYPHS: Readonly<Record<Joint["type"], string>> = {
  fixed: "",
  revolute: "↻",
  continuous: "⟳",
  prismatic: "↕",
  planar: "▱",
  floating: "✥",
};
const DEEPEST_INDENT = 12; // Levels below are not indented further, so that names stay readable.

export function makeTree(state: State): HTMLElement {
  return new Tree(state).element;
}

class Tree {
  readonly element: HTMLElement;
  private rows = new Map<string, Row>();
  private readonly collapsed = new Set<string>();

  constructor(private readonly state: State) {
    this.element = make("div", { role: "tree", className: "tree", ariaLabel: "links and joints" });
    this.element.onkeydown = (event) => this.onKey(event);
    this.element.onclick = (event) => this.onClick(event);
    state.listen((change) => {
      if (change === "scene") this.rebuild();
      if (change === "search") this.filter();
      if (change === "hidden") this.rows.forEach((row) => row.showEye());
      if (change === "selection") this.showSelection();
    });
    this.rebuild();
  }

  private rebuild(): void {
    const below = new Map<string, Link[]>();
    for (const link of this.state.scene.links) {
      const parent = this.state.joint(link.parent)?.parent ?? "";
      below.set(parent, [...(below.get(parent) ?? []), link]);
    }
    const focused = this.element.contains(document.activeElement) ? (document.activeElement as HTMLElement) : null;
    this.rows = new Map();
    const roots = this.state.scene.links.filter(({ parent }) => !this.state.joint(parent));
    // Not by recursion: a chain may have more links than calls may nest.
    const waiting: [Link, Row | null][] = roots.map((root): [Link, Row | null] => [root, null]).reverse();
    for (let next = waiting.pop(); next; next = waiting.pop()) {
      const [link, above] = next;
      if (this.rows.has(link.name)) continue;
      const row = new Row(link, above, this.state);
      this.rows.set(link.name, row);
      const children = below.get(link.name) ?? [];
      row.hasChildren = children.length > 0;
      for (const child of [...children].reverse()) waiting.push([child, row]);
    }
    this.element.replaceChildren(...[...this.rows.values()].map((row) => row.element));
    this.filter();
    this.showSelection();
    this.rows.get(focused?.dataset["link"] ?? "")?.element.focus();
  }

  /** Show the rows that the search finds, with all links above them; without a search, those not collapsed. */
  private filter(): void {
    const isSearch = this.state.search !== "";
    const shown = new Set<Row>();
    for (const row of this.rows.values()) {
      const isFound = isSearch && findsLink(this.state, row.link);
      row.element.classList.toggle("found", isFound);
      if (isFound) for (let at: Row | null = row; at; at = at.above) shown.add(at);
    }
    const inside = new Set<Row>(); // below a link that is collapsed; a row comes after the one above it
    for (const row of this.rows.values()) {
      if (row.above && (this.collapsed.has(row.above.link.name) || inside.has(row.above))) inside.add(row);
      row.element.hidden = isSearch ? !shown.has(row) : inside.has(row);
      row.showExpanded(isSearch || !this.collapsed.has(row.link.name));
    }
    this.element.dataset["empty"] = isSearch && shown.size === 0 ? "nothing of this name" : "";
  }

  private showSelection(): void {
    const selected = this.rows.get(this.state.selected ?? "");
    for (let row = selected?.above; row; row = row.above) this.collapsed.delete(row.link.name);
    this.filter();
    for (const row of this.rows.values()) row.showSelected(row === selected);
    const focusable = selected ?? this.rows.values().next().value;
    if (focusable) focusable.element.tabIndex = 0;
    selected?.element.scrollIntoView({ block: "nearest" });
  }

  private collapse(row: Row, isCollapsed: boolean): void {
    if (isCollapsed) this.collapsed.add(row.link.name);
    else this.collapsed.delete(row.link.name);
    this.filter();
  }

  private rowAt(event: Event): Row | undefined {
    const element = event.target instanceof Element ? event.target.closest<HTMLElement>("[role=treeitem]") : null;
    return this.rows.get(element?.dataset["link"] ?? "");
  }

  private onClick(event: MouseEvent): void {
    const row = this.rowAt(event);
    if (!row) return;
    const target = event.target as Element;
    if (target.closest(".twisty") && row.hasChildren) this.collapse(row, row.isExpanded);
    else if (target.closest(".eye")) this.toggleEye(row, event.shiftKey);
    else this.state.select(row.link.name);
  }

  private toggleEye(row: Row, withAllBelow: boolean): void {
    const chosen = new Set([row]);
    for (const other of withAllBelow ? this.rows.values() : []) if (other.above && chosen.has(other.above)) chosen.add(other);
    this.state.hide([...chosen].map(({ link }) => link.name), !this.state.hidden.has(row.link.name));
  }

  private onKey(event: KeyboardEvent): void {
    const row = this.rowAt(event);
    if (!row || event.ctrlKey || event.altKey || event.metaKey) return;
    const rows = [...this.rows.values()].filter(({ element }) => !element.hidden);
    const at = rows.indexOf(row);
    const goTo = (next: Row | null | undefined): void => {
      if (!next) return;
      this.state.select(next.link.name);
      next.element.focus();
    };
    const actions: Record<string, () => void> = {
      ArrowDown: () => goTo(rows[at + 1]),
      ArrowUp: () => goTo(rows[at - 1]),
      Home: () => goTo(rows[0]),
      End: () => goTo(rows.at(-1)),
      ArrowLeft: () => (row.hasChildren && row.isExpanded ? this.collapse(row, true) : goTo(row.above)),
      ArrowRight: () => (row.isExpanded ? goTo(row.hasChildren ? rows[at + 1] : null) : this.collapse(row, false)),
      Enter: () => goTo(row),
      " ": () => this.toggleEye(row, event.shiftKey),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  }
}

class Row {
  readonly element: HTMLElement;
  hasChildren = false;
  isExpanded = true;
  /** 1 for a root. */
  readonly level: number;
  private readonly twisty = make("span", { className: "twisty", ariaHidden: "true" });
  private readonly eye: HTMLButtonElement;

  constructor(
    readonly link: Link,
    readonly above: Row | null,
    private readonly state: State,
  ) {
    this.level = above ? above.level + 1 : 1;
    this.eye = makeButton("", "", () => undefined);
    this.eye.className = "eye";
    this.eye.tabIndex = -1;
    const name = make("span", { className: "name" }, link.name);
    const names = make("span", { className: "names" }, name, ...shownJoint(state.joint(link.parent)));
    // At its first link only: the names of deep links need the place.
    const module = link.module === above?.link.module ? "" : link.module;
    const parts = [this.twisty, names, ...moduleTag(module), this.eye];
    this.element = make("div", { role: "treeitem", ariaLevel: String(this.level), tabIndex: -1, title: link.name }, ...parts);
    this.element.dataset["link"] = link.name;
    this.element.style.setProperty("--level", String(Math.min(this.level - 1, DEEPEST_INDENT)));
    this.showEye();
  }

  showExpanded(isExpanded: boolean): void {
    this.isExpanded = isExpanded;
    if (this.hasChildren) this.element.ariaExpanded = String(isExpanded);
    this.twisty.replaceChildren(!this.hasChildren ? "" : isExpanded ? "▾" : "▸");
  }

  showSelected(isSelected: boolean): void {
    this.element.ariaSelected = String(isSelected);
    this.element.tabIndex = -1;
  }

  showEye(): void {
    const isHidden = this.state.hidden.has(this.link.name);
    this.element.classList.toggle("invisible", isHidden);
    this.eye.ariaPressed = String(!isHidden);
    this.eye.ariaLabel = `show ${this.link.name}`;
    this.eye.title = `${isHidden ? "show" : "hide"} the link; with Shift also all links below it (Space)`;
    this.eye.replaceChildren(isHidden ? "○" : "●");
  }
}

function shownJoint(joint: Joint | undefined): HTMLElement[] {
  if (!joint) return [];
  const text = joint.type === "fixed" ? joint.name : `${GLYPHS[joint.type]} ${joint.name}`;
  return [make("span", { className: `joint-name ${joint.type}`, title: `${joint.name}: ${joint.type}` }, text)];
}
