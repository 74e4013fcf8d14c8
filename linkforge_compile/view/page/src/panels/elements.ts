/** HTML elements from values. Names of a robot become text, never HTML. */

type Properties<Tag extends keyof HTMLElementTagNameMap> = Partial<
  Omit<HTMLElementTagNameMap[Tag], "innerHTML" | "outerHTML">
>;

/** Make an element with these properties and children. */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  properties: Properties<Tag> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Tag] {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** Make a button that shows a text; the title explains it. */
export function makeButton(text: string, title: string, onclick: (event: MouseEvent) => void): HTMLButtonElement {
  return make("button", { type: "button", title, onclick }, text);
}

/** Make a part of a side panel, which opens and closes by its heading. */
export function makeSection(heading: string, ...children: (Node | string)[]): HTMLDetailsElement {
  return make("details", { open: true, className: "section" }, make("summary", {}, heading), ...children);
}

/** Return the tag of a module, coloured by its name; "" has none. */
export function moduleTag(module: string): HTMLElement[] {
  if (!module) return [];
  const tag = make("span", { className: "module", title: `module ${module}` }, module);
  tag.style.setProperty("--hue", String(hueOf(module)));
  return [tag];
}

function hueOf(name: string): number {
  let hash = 0;
  for (const character of name) hash = (hash * 31 + (character.codePointAt(0) ?? 0)) % 9973;
  return (hash * 137) % 360; // Near names get far hues.
}

/** Return such as "1 link" or "2 links". */
export function counted(count: number, what: string): string {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}
