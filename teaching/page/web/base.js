// The floating base of a robot: how it stands in the world and how it moves, in its own axes.

/** The rows of the panel: words, letter, unit, and how far a slider goes. */
const OF_BASE = {
  rpy: ["orientation", "R", "rad", Math.PI],
  omega: ["angular velocity", "ω", "rad/s", 3],
  omega_dot: ["angular acceleration", "ω̇", "rad/s²", 10],
  acceleration: ["acceleration of frame 0", "a", "m/s²", 10],
};
const TURNS = ["roll", "pitch", "yaw"];

/** Level and still. */
const levelBase = () => structuredClone({ rpy: [0, 0, 0], ...AT_REST });

/** Whether nothing of a base moves. */
const isStill = (base) => Object.keys(AT_REST).every((of) => base[of].every((value) => value === 0));

/** Sliders and fields of the motion of a base. */
class BaseSliders {
  /** `stateOf()` is the state of the page; `changed(of)` is called with what a slider or a field has set. */
  constructor(inspection, stateOf, changed) {
    this.stateOf = stateOf;
    this.shows = [];
    const columns = AXES.map((axis, at) => element("th", { scope: "col" }, `${TURNS[at]}, ${axis}`));
    const head = element("tr", {}, element("th", { scope: "col" }, inspection.floating.name), ...columns);
    const rows = Object.entries(OF_BASE).map(([of, [word, letter, unitOf, most]]) => {
      const name = element("th", { scope: "row", title: `${word}, ${unitOf}` }, letter, element("span", { class: "joint-name" }, unitOf));
      const cells = AXES.map((axis, at) => this.cell({ of, at, most, unitOf, label: of === "rpy" ? TURNS[at] : `${word}, ${axis}` }, changed));
      return element("tr", {}, name, ...cells);
    });
    const words = "Roll, pitch and yaw turn the base in the world, by R = Rz(yaw) Ry(pitch) Rx(roll); ω, ω̇ and a are in its axes.";
    this.root = element(
      "details",
      { class: "base-motion", open: true },
      element("summary", {}, `Floating base “${inspection.floating.name}”`),
      element("table", { class: "sliders" }, element("thead", {}, head), element("tbody", {}, ...rows)),
      element("p", { class: "hint" }, words),
    );
    this.show();
  }

  cell({ of, at, most, unitOf, label }, changed) {
    const told = `${label} of the base`;
    const set = (value) => {
      this.stateOf().base[of][at] = value;
      show();
      changed(of);
    };
    const input = element("input", { type: "range", min: -most, max: most, step: "any", "data-base": `${of}-${at}`, "aria-label": `${told}, ${unitOf}` });
    const field = numberField({ "data-base-field": `${of}-${at}`, class: "number", "aria-label": `${told} as a number, ${unitOf}` }, set);
    const degrees = of === "rpy" ? degreesField({ "data-base-degrees": at, "aria-label": `${told} in degrees` }, set) : null;
    const show = () => {
      const value = this.stateOf().base[of][at];
      input.value = value;
      fill(field, value);
      field.title = `${full(value)} ${unitOf}`;
      if (degrees) fillDegrees(degrees, value);
      input.setAttribute("aria-valuetext", `${value.toFixed(3)} ${unitOf}`);
    };
    input.addEventListener("input", () => set(Number(input.value)));
    goByHundredths(input);
    this.shows.push(show);
    const sign = degrees ? element("span", { class: "degree-sign", "aria-hidden": "true" }, "°") : null;
    return element("td", {}, element("span", { class: "slid" }, input, field, degrees, sign));
  }

  /** Shows the state of the page. */
  show() {
    for (const show of this.shows) show();
  }
}

/** Bars of the force and the moment on the base, and what they are when nothing moves. */
class OnBase {
  constructor(inspection) {
    this.inspection = inspection;
    const list = element("ol", { class: "bars" });
    this.bars = new Bars(list, barsOfBase(inspection));
    this.words = element("p", { class: "hint", id: "on-base-words" });
    this.root = element(
      "div",
      { class: "on-base" },
      element("h3", {}, "Force F and moment N that must act on the base, beside gravity"),
      list,
      this.words,
    );
    const { robot, floating } = inspection;
    this.mass = robot.joints.reduce((sum, joint) => sum + joint.mass, floating.mass);
  }

  update({ onBase }, { state, wrench, isHidden }) {
    this.bars.update(onBase, isHidden);
    const weight = this.mass * norm(this.inspection.robot.gravity);
    const isResting = isStill(state.base) && [...state.qd, ...state.qdd].every((value) => value === 0);
    const isFree = [...wrench.f, ...wrench.n].every((value) => value === 0);
    const force = withUnit(norm(onBase.total.slice(0, 3)), "N");
    const told =
      weight === 0
        ? "There is no gravity: F and N are zero in free flight."
        : !isFree
          ? `What the tips exert on the ground carries a part; the weight of the robot is ${withUnit(weight, "N")}.`
          : isResting
            ? `The robot stands still: F is its weight, ${withUnit(weight, "N")}.`
            : `The weight of the robot is ${withUnit(weight, "N")}.`;
    const parts = "Gravity: everything at rest in this orientation. Coriolis and centrifugal: what q̇ and ω add. Inertia: what q̈, ω̇ and a add.";
    const size = isHidden("fb0_x") ? "" : `|F| = ${force}. `;
    this.words.replaceChildren(
      element("span", { id: "weight" }, size + told),
      element("span", {}, ` In axes of the base, N about the origin of frame 0. ${parts}`),
    );
  }
}
