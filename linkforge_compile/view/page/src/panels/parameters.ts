/** Parameters and variants of the spec as widgets; a change compiles the spec again. */
import { sendSettings } from "../live";
import type { Parameter, State } from "../state";
import { make, makeButton, makeSection } from "./elements";
import { brief } from "./numbers";

const DELAY = 250; // [ms] without another change until the settings are sent

export function makeParameters(state: State): HTMLElement {
  const section = makeSection("Parameters");
  const panel = new ParameterPanel(section, state);
  state.listen((change) => change === "live" && panel.show());
  panel.show();
  return section;
}

class ParameterPanel {
  /** What the user set, until an update states it. */
  private readonly changed = new Map<string, string | null>();
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
    const key = JSON.stringify([variants, parameters.map(({ value: _, ...declared }) => declared)]);
    if (key !== this.shownKey) this.rebuild();
    this.shownKey = key;
    this.changed.clear();
    this.variant = undefined;
    parameters.forEach((parameter, index) => this.widgets[index]?.show(parameter, this.problemOf(parameter.name)));
    const select = this.section.querySelector<HTMLSelectElement>("select[name=variant]");
    const variant = this.state.settings.variant ?? "";
    if (select && ![...select.options].some(({ value }) => value === variant)) select.add(new Option(variant));
    if (select) select.value = variant;
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
    const { parameters, variant } = this.state.settings;
    const texts = parameters.flatMap(({ name, value }) => {
      const text = this.changed.has(name) ? this.changed.get(name) : value;
      return text === null || text === undefined ? [] : [[name, text] as const];
    });
    const chosen = this.variant === undefined ? variant : this.variant;
    void sendSettings(this.state, { parameters: Object.fromEntries(texts), variant: chosen });
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
    this.reset = makeButton("↺", `set ${name} to its default`, () => set(name, null));
    const label = make("label", { title: titleOf(parameter) }, make("span", { className: "name" }, name), this.input);
    this.element = make("div", { className: "parameter" }, make("div", { className: "line" }, label, this.reset));
    if (this.slider) this.element.append(this.slider);
    this.element.append(this.fault);
    this.element.dataset["parameter"] = name;
  }

  /** Show the value, and the message of a faulty one. */
  show(parameter: Parameter, fault: string): void {
    const text = parameter.value ?? parameter.default ?? "";
    if (this.input.type === "checkbox") (this.input as HTMLInputElement).checked = text === "true";
    else if (document.activeElement !== this.input || fault === "") this.input.value = text;
    const number = inUnit(text, parameter.unit);
    if (this.slider) this.slider.hidden = Number.isNaN(number);
    if (this.slider && document.activeElement !== this.slider) this.slider.value = String(number);
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
  if (parameter.type === "bool") {
    const box = make("input", { type: "checkbox", name, onchange: () => set(String(box.checked)) });
    return box;
  }
  const placeholder = parameter.default === null ? "required" : "";
  const input = make("input", { type: "text", name, placeholder, spellcheck: false, onchange: () => set(input.value) });
  return input;
}

function makeSlider(parameter: Parameter, set: (text: string) => void): HTMLInputElement {
  const { name, minimum, maximum } = parameter;
  const isWhole = parameter.type === "int" || parameter.type === "integer";
  const range = { min: String(minimum), max: String(maximum), step: isWhole ? "1" : "any" };
  const slider = make("input", { type: "range", ariaLabel: `${name}, slider`, ...range });
  slider.oninput = () => set(withUnit(Number(slider.valueAsNumber.toPrecision(4)), parameter.unit));
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

/** Return the number of a text in this unit, or without a unit; NaN for any other text. */
function inUnit(text: string, unit: string | null): number {
  const [number, written, ...more] = text.trim().split(/\s+/);
  const isIn = more.length === 0 && (written === undefined || written === unit);
  return isIn && number ? Number(number) : Number.NaN;
}
