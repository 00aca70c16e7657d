// What the last link exerts on its environment at the tip, in tip axes: sliders of a force and a moment.

const OF_WRENCH = { f: ["force", "N"], n: ["moment", "N·m"] };

class WrenchSliders {
  constructor(root, inspection, wrench, changed) {
    this.rows = [];
    const heaviest = Math.max(10, ...inspection.robot.joints.map((joint) => joint.mass * 5));
    for (const [of, [word, unitOf]] of Object.entries(OF_WRENCH)) {
      // a moment is as large as a fifth of the force, N, on a lever of a metre
      const most = niceAbove(of === "f" ? heaviest : heaviest / 5);
      AXES.forEach((axis, index) => {
        const set = (value) => {
          wrench[of][index] = value;
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
          fill(field, wrench[of][index]);
        };
        input.addEventListener("input", () => {
          wrench[of][index] = Number(input.value);
          tell();
          changed();
        });
        const show = () => {
          input.value = wrench[of][index];
          tell();
        };
        this.rows.push(show);
        root.append(element("label", {}, `${of} ${axis}`, input, field, unitOf));
        show();
      });
    }
    this.wrench = wrench;
  }

  /** Sets the sliders to a wrench. */
  show({ f, n }) {
    for (const [of, numbers] of Object.entries({ f, n }))
      numbers.forEach((value, index) => {
        this.wrench[of][index] = value;
      });
    for (const show of this.rows) show();
  }
}
