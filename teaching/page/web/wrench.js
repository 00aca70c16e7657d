// What the robot exerts on its environment at a tip, in its axes: sliders of a force and a moment. Of several tips one
// is chosen.

const OF_WRENCH = { f: ["force", "N"], n: ["moment", "N·m"] };

class WrenchSliders {
  constructor(root, inspection, wrench, changed) {
    this.rows = [];
    // where the numbers of the tip that the sliders have begin
    this.first = 0;
    if (inspection.tips.length > 1) root.before(this.choice(inspection.tips));
    const heaviest = Math.max(10, ...inspection.robot.joints.map((joint) => joint.mass * 5));
    for (const [of, [word, unitOf]] of Object.entries(OF_WRENCH)) {
      // a moment is as large as a fifth of the force, N, on a lever of a metre
      const most = niceAbove(of === "f" ? heaviest : heaviest / 5);
      AXES.forEach((axis, index) => {
        const set = (value) => {
          wrench[of][this.first + index] = value;
          show();
          changed();
        };
        const field = numberField({ class: "number", "aria-label": `${word} at the tip along ${axis} as a number, ${unitOf}` }, set);
        const input = element("input", {
          type: "range",
          min: -most,
          max: most,
          step: "any",
          value: 0,
          "aria-label": `${word} at the tip along ${axis}, ${unitOf}`,
          "data-tip": `${of}${axis}`,
        });
        const tell = () => {
          fill(field, wrench[of][this.first + index]);
        };
        input.addEventListener("input", () => {
          wrench[of][this.first + index] = Number(input.value);
          tell();
          changed();
        });
        const show = () => {
          input.value = wrench[of][this.first + index];
          tell();
        };
        this.rows.push(show);
        root.append(element("label", {}, `${of} ${axis}`, input, field, unitOf));
        show();
      });
    }
    this.wrench = wrench;
  }

  /** Buttons with the names of the tips. */
  choice(tips) {
    const buttons = tips.map(({ name }, tip) => {
      const button = element("button", { type: "button", "data-tip-name": name, "aria-pressed": String(tip === 0) }, name);
      button.addEventListener("click", () => {
        this.first = 3 * tip;
        for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
        for (const show of this.rows) show();
      });
      return button;
    });
    return element("div", { class: "choice tips", role: "group", "aria-label": "tip of the sliders" }, ...buttons);
  }

  /** Sets the sliders to the wrenches of as many tips. */
  show({ f, n }) {
    for (const [of, numbers] of Object.entries({ f, n }))
      numbers.slice(0, this.wrench[of].length).forEach((value, index) => {
        this.wrench[of][index] = value;
      });
    for (const show of this.rows) show();
  }
}
