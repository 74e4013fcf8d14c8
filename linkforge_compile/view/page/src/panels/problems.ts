/** What is wrong with the spec, its meshes or the connection, over the picture. */
import type { MissingFile, Place } from "../scene";
import type { Problem, State } from "../state";
import { counted, make } from "./elements";
import { shownPlace } from "./numbers";

export function makeProblems(state: State): HTMLElement {
  const summary = make("summary");
  const list = make("ul");
  const overlay = make("details", { className: "problems" }, summary, list);
  const status = make("div", { className: "unseen", role: "status" });
  let wasFaulty = false;
  const show = (): void => {
    const all = [...state.problems, ...missingFiles(state), ...unreadableFiles(state)];
    const heading = headingOf(state, all);
    overlay.hidden = heading === "";
    summary.replaceChildren(heading);
    if (status.textContent !== heading) status.replaceChildren(heading);
    list.replaceChildren(...all.map(makeItem));
    const isFaulty = all.some(({ severity }) => severity === "error");
    if (isFaulty && !wasFaulty) overlay.open = true;
    wasFaulty = isFaulty;
    overlay.classList.toggle("grave", isFaulty || state.connection !== "");
  };
  state.listen((change) => (change === "live" || change === "scene") && show());
  show();
  document.body.append(status); // outside of the overlay, which is hidden at times
  return overlay;
}

/** Return the files that the page cannot read as problems. */
function unreadableFiles(state: State): Problem[] {
  return [...state.unreadable].flatMap(([digest, reason]) => {
    const file = state.scene.files[digest];
    if (!file) return []; // of the scene before, until this one is loaded
    const hints = file.links?.length ? [shownUse("", file.links, file.source ?? null)] : [];
    return [{ severity: "warning", code: "", message: `${file.name} is not shown: ${reason}`, hints }];
  });
}

/** Return the links that have a file, and the first place that names it. */
function shownUse(file: string, links: readonly string[], source: Place | null): string {
  return `${file && `${file} `}of ${links.join(", ")}${source ? ` at ${shownPlace(source)}` : ""}`;
}

/** Return the missing files as problems, one for each reason. */
function missingFiles(state: State): Problem[] {
  const byReason = new Map<string, MissingFile[]>();
  for (const file of state.scene.missing) byReason.set(file.reason, [...(byReason.get(file.reason) ?? []), file]);
  return [...byReason].map(([reason, files]) => ({
    severity: "warning",
    code: "",
    message: `${counted(files.length, "file")} not shown: ${reason}`,
    hints: files.map(({ file, links, source }) => shownUse(file, links, source)),
  }));
}

function headingOf(state: State, all: readonly Problem[]): string {
  const errors = all.filter(({ severity }) => severity === "error").length;
  const warnings = all.filter(({ severity }) => severity === "warning").length;
  const notes = all.length - errors - warnings;
  const counts = ([[errors, "error"], [warnings, "warning"], [notes, "note"]] as const).map(([count, noun]) => (count ? counted(count, noun) : ""));
  const parts = [state.connection, ...counts];
  if (errors) parts.push(state.scene.links.length ? "showing the last robot without errors" : "no robot to show yet");
  return parts.filter(Boolean).join(" · ");
}

function makeItem(problem: Problem): HTMLElement {
  const { severity, code, message, file, line, column, page, hints = [], snippet } = problem;
  const head = make("div", {}, make("b", { className: severity }, severity), " ", ...shownCode(code, page), " ", message);
  const item = make("li", { className: severity }, head);
  if (file) item.append(make("code", {}, shownPlace({ file, line: line ?? 1, column: 1 }) + (column ? `:${column}` : "")));
  if (snippet) item.append(make("pre", {}, snippet));
  for (const hint of hints) item.append(make("div", { className: "hint" }, hint));
  return item;
}

/** Return the code, linked to its page, which the server has or the web; no other address is opened from here. */
function shownCode(code: string, page: string | null | undefined): HTMLElement[] {
  if (!code) return [];
  const isSafe = page && ["http:", "https:"].includes(new URL(page, document.baseURI).protocol);
  if (!page || !isSafe) return [make("code", {}, code)];
  return [make("a", { href: page, target: "_blank", rel: "noreferrer" }, code)];
}
