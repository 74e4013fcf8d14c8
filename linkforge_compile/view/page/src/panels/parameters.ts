/** Parameters and variants of the spec as widgets; a change compiles the spec again. */
import { sendSettings } from "../live";
import type { Parameter, State } from "../state";
import { make, makeButton, makeSection } from "./elements";
import { brief } from "./numbers";

const DELAY = 250; // [ms] without another change until the settings are sent
const PATIENCE = 5000; // [ms] until a value that was sent gives way to that of an update, as of another page

export function makeParameters(state: State): HTMLElement {
  const section = makeSection("Parameters");
  const panel = new ParameterPanel(section, state);
  state.listen((change) => change === "live" && panel.show());
  panel.show();
  return section;
}

class ParameterPanel {
  /** What the user set and is not sent yet. */
  private readonly changed = new Map<string, string | null>();
  /** What was sent, and when, until an update states it. */
  private readonly sent = new Map<string, { text: string | null; at: number }>();
  private variant: string | null | undefined;
  private timer = 0;
  private shownKey = "";
  private widgets: Widget[] = [];

  constructor(
    private readonly section: HTMLElement,
    private readonly state: State,
  ) {}

  show(): void {
    const { parameters, variants } = this.state.settings;
    this.section.hidden = parameters.length === 0 && variants.length === 0;
    const key = JSON.stringify([variants, parameters.map(({ value: _, number: __, ...declared }) => declared)]);
    if (key !== this.shownKey) this.rebuild();
    this.shownKey = key;
    parameters.forEach((parameter, index) => {
      const { name, value } = parameter;
      const sent = this.sent.get(name);
      if (sent && (sent.text === value || Date.now() - sent.at > PATIENCE)) this.sent.delete(name);
      const isOwn = this.changed.has(name) || this.sent.has(name);
      this.widgets[index]?.show(parameter, this.problemOf(name), isOwn);
    });
    const select = this.section.querySelector<HTMLSelectElement>("select[name=variant]");
    const variant = this.state.settings.variant ?? "";
    if (select && ![...select.options].some(({ value }) => value === variant)) select.add(new Option(variant));
    if (select && this.variant === undefined) select.value = variant;
  }

  private rebuild(): void {
    const { parameters, variants } = this.state.settings;
    const set = (name: string, text: string | null): void => {
      this.changed.set(name, text);
      this.sendLater();
    };
    this.widgets = parameters.map((parameter) => new Widget(parameter, set));
    const heading = this.section.firstElementChild!;
    const rows = variants.length ? [this.makeVariants(variants)] : [];
    this.section.replaceChildren(heading, ...rows, ...this.widgets.map(({ element }) => element));
  }

  private makeVariants(variants: readonly string[]): HTMLElement {
    const options = ["", ...variants].map((name) => make("option", { value: name }, name || "none"));
    const select = make("select", { name: "variant" }, ...options);
    select.onchange = () => {
      this.variant = select.value || null;
      this.sendLater();
    };
    return make("label", { className: "parameter variant" }, make("span", { className: "name" }, "variant"), select);
  }

  /** Return the message about a parameter; diagnostics quote its name. */
  private problemOf(name: string): string {
    return this.state.problems.find(({ message }) => message.includes(`parameter '${name}'`))?.message ?? "";
  }

  private sendLater(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.send(), DELAY);
  }

  private send(): void {
    for (const [name, text] of this.changed) this.sent.set(name, { text, at: Date.now() });
    const request = { parameters: Object.fromEntries(this.changed) };
    void sendSettings(this.state, this.variant === undefined ? request : { ...request, variant: this.variant });
    this.changed.clear();
    this.variant = undefined;
  }
}

type SetText = (name: string, text: string | null) => void;

class Widget {
  readonly element: HTMLElement;
  private readonly input: HTMLInputElement | HTMLSelectElement;
  private readonly slider: HTMLInputElement | null;
  private readonly reset: HTMLButtonElement;
  private readonly fault = make("div", { className: "fault", role: "alert" });

  constructor(parameter: Parameter, set: SetText) {
    const { name, minimum, maximum } = parameter;
    this.input = makeInput(parameter, (text) => set(name, text));
    const hasSlider = minimum !== null && maximum !== null && !parameter.choices;
    this.slider = hasSlider ? makeSlider(parameter, (text) => this.slide(text, set)) : null;
    this.reset = makeButton("↺", `reset ${name} to its default`, () => set(name, null));
    const label = make("label", { title: titleOf(parameter) }, make("span", { className: "name" }, name), this.input);
    this.element = make("div", { className: "parameter" }, make("div", { className: "line" }, label, this.reset));
    if (this.slider) this.element.append(this.slider);
    this.element.append(this.fault);
    this.element.dataset["parameter"] = name;
  }

  /** Show the value, unless the user's own is under way, and the message of a faulty one. */
  show(parameter: Parameter, fault: string, isOwn: boolean): void {
    const text = parameter.value ?? parameter.default ?? "";
    const isTyped = this.input.type === "text" && document.activeElement === this.input;
    if (!isOwn && this.input.type === "checkbox") (this.input as HTMLInputElement).checked = text === "true";
    else if (!isOwn && !isTyped) this.input.value = text;
    if (this.slider) this.slider.hidden = parameter.number === null;
    if (this.slider && !isOwn && document.activeElement !== this.slider) this.slider.value = String(parameter.number);
    this.reset.style.visibility = parameter.value === null || parameter.value === parameter.default ? "hidden" : "";
    this.fault.replaceChildren(fault);
    this.fault.hidden = fault === "";
    this.input.ariaInvalid = String(fault !== "");
  }

  private slide(text: string, set: SetText): void {
    this.input.value = text;
    set(this.element.dataset["parameter"] ?? "", text);
  }
}

function makeInput(parameter: Parameter, set: (text: string) => void): HTMLInputElement | HTMLSelectElement {
  const { name, choices } = parameter;
  if (choices) {
    const options = choices.map((choice) => make("option", { value: withUnit(choice, parameter.unit) }, withUnit(choice, parameter.unit)));
    const select = make("select", { name, onchange: () => set(select.value) }, ...options);
    return select;
  }
  if (parameter.type === "boolean") {
    const box = make("input", { type: "checkbox", name, onchange: () => set(String(box.checked)) });
    return box;
  }
  const placeholder = parameter.default === null ? "required" : "";
  const input = make("input", { type: "text", name, placeholder, spellcheck: false, onchange: () => set(input.value) });
  return input;
}

function makeSlider(parameter: Parameter, set: (text: string) => void): HTMLInputElement {
  const { name } = parameter;
  const [minimum, maximum] = [Number(parameter.minimum), Number(parameter.maximum)];
  const isWhole = parameter.type === "integer";
  const range = { min: String(minimum), max: String(maximum), step: isWhole ? "1" : "any" };
  const slider = make("input", { type: "range", ariaLabel: `${name}, slider`, ...range });
  const short = (number: number): number => Math.min(Math.max(Number(number.toPrecision(4)), minimum), maximum);
  slider.oninput = () => set(withUnit(isWhole ? slider.valueAsNumber : short(slider.valueAsNumber), parameter.unit));
  return slider;
}

function titleOf({ type, unit, minimum, maximum, default: start, description }: Parameter): string {
  const limits = [minimum === null ? "" : `at least ${brief(minimum)}`, maximum === null ? "" : `at most ${brief(maximum)}`];
  const facts = [type ?? "", ...limits, unit && `in ${unit}`, start === null ? "required" : `default ${start}`];
  return [description, facts.filter(Boolean).join(", ")].filter(Boolean).join("\n");
}

function withUnit(value: string | number | boolean, unit: string | null): string {
  return unit ? `${value} ${unit}` : String(value);
}
