/** The robot in the viewport, kept as the state says. */
import { Vector3, type Raycaster } from "three";
import { Compared } from "./comparison";
import { Shapes } from "./geometry";
import { Grid } from "./grid";
import { Labels } from "./labels";
import { listenToPointer } from "./pointer";
import { Robot } from "./robot";
import { isEmpty, type Change, type State } from "./state";
import { listenToTheme, themeOf } from "./theme";
import { Viewport } from "./viewport";

export class Picture {
  /** When the last scene is loaded and drawn. */
  ready: Promise<void>;
  readonly viewport: Viewport;
  private robot: Robot | null = null;
  /** The robot before, of a scene with one. */
  compared: Compared | null = null;
  private readonly shapes = new Shapes();
  private readonly grid: Grid;
  private readonly labels: Labels;
  private hovered: string | null = null;

  constructor(element: HTMLElement, private readonly state: State) {
    this.viewport = new Viewport(element);
    this.grid = new Grid(element, themeOf(state.scene.view));
    this.labels = new Labels(element);
    this.viewport.scene.add(this.grid.root);
    this.viewport.drawn = () => this.labels.draw(this.viewport.camera, (link) => this.placeOf(link));
    listenToPointer(this.viewport.renderer.domElement, this.viewport.camera, {
      click: (ray) => state.select(this.robot?.hit(ray) ?? null),
      hover: (ray) => this.hover(ray),
    });
    state.listen((change) => this.follow(change));
    this.useTheme();
    listenToTheme(() => this.useTheme());
    this.ready = this.load();
  }

  fit(): void {
    if (this.robot) this.viewport.fit(this.robot.extent());
  }

  get shown(): Robot {
    if (!this.robot) throw new Error("the robot is not loaded yet: await linkforge.ready");
    return this.robot;
  }

  private follow(change: Change): void {
    // A scene that could not be shown does not keep the next one from being shown.
    if (change === "scene") this.ready = this.ready.catch(() => undefined).then(() => this.load());
    else this.update(change);
  }

  /** Show the scene of the state in place of the one before; a later one comes soon if it is no longer the last. */
  private async load(): Promise<void> {
    const { scene } = this.state;
    if (this.robot?.scene === scene) return;
    const robot = await Robot.make(scene, this.shapes);
    const { comparison } = scene;
    this.compared = comparison ? await Compared.make(scene, comparison, robot, this.shapes) : null;
    this.compared?.useTheme(themeOf(scene.view));
    const isFirst = !this.robot || isEmpty(this.robot.scene);
    this.robot?.select(null);
    this.robot?.root.removeFromParent();
    this.robot = robot;
    this.hovered = null;
    this.shapes.sweep();
    this.state.reportUnreadable(new Map([...this.shapes.faults].filter(([file]) => file in scene.files)));
    this.viewport.scene.add(robot.root);
    if (this.compared) this.viewport.scene.add(this.compared.root);
    for (const change of ["positions", "layers", "selection"] as const) this.update(change);
    this.grid.layUnder(robot.extent(), robot.size);
    this.viewport.measure(robot.extent());
    if (!isFirst) return this.viewport.frame();
    this.viewport.fit(robot.extent(), scene.view.camera);
    this.viewport.draw();
  }

  /** Take the colours of the theme. */
  private useTheme(): void {
    const theme = themeOf(this.state.scene.view);
    this.viewport.setBackground(theme.background);
    this.compared?.useTheme(theme);
    this.grid.useTheme(theme);
  }

  private update(change: Change): void {
    const { robot, state } = this;
    if (!robot || robot.scene !== state.scene) return;
    if (change === "positions") {
      robot.move(state.positions);
      this.compared?.move(state.positions);
      this.compared?.show(state);
    } else if (change === "selection") robot.select(state.selected);
    else if (change === "layers" || change === "hidden" || change === "sides") {
      robot.show(state.layers, state.hidden);
      this.compared?.show(state);
      this.grid.show(state.layers.has("grid"));
      this.updateLabels();
    } else return;
    this.viewport.redraw();
  }

  private hover(ray: Raycaster | null): void {
    const hovered = (ray && this.robot?.hit(ray)) ?? null;
    if (hovered === this.hovered) return;
    this.hovered = hovered;
    this.updateLabels();
    this.viewport.redraw();
  }

  private updateLabels(): void {
    const all = this.state.layers.has("labels") ? this.shown.scene.links.map(({ name }) => name) : [];
    const links = all.filter((name) => !this.state.hidden.has(name));
    this.labels.set(this.hovered === null ? links : [...links, this.hovered]);
  }

  private placeOf(link: string): Vector3 {
    return this.robot?.placeOf(link) ?? new Vector3();
  }
}
