// The state of the arm, the sliders that set it, and a motion from one pose to another.

const OF = ["q", "qd", "qdd"];
const LETTERS = { q: "q", qd: "q̇", qdd: "q̈" };

/** What the sliders of a joint reach: by the limits of the file, where it has them. */
function rangeOf(joint, of) {
  const isPrismatic = joint.kind === "prismatic";
  if (of === "q") {
    const [low, high] = joint.position_limits || (isPrismatic ? [0, 1] : [-Math.PI, Math.PI]);
    return [Math.max(low, isPrismatic ? low : -2 * Math.PI), Math.min(high, isPrismatic ? high : 2 * Math.PI)];
  }
  const most = of === "qd" ? joint.velocity_limit || (isPrismatic ? 1 : 3) : isPrismatic ? 5 : 10;
  return [-most, most];
}

/** A pose that is no special one, inside the limits. */
function ordinaryPose(robot, pattern) {
  return robot.joints.map((joint, index) => {
    const [low, high] = rangeOf(joint, "q");
    // not the same for all: two joints at their margins would make a special pose
    const margin = (0.1 + 0.05 * (index % 3)) * (high - low);
    const wished =
      joint.kind === "prismatic"
        ? low + (high - low) * (0.5 + 0.3 * pattern[index % pattern.length])
        : pattern[index % pattern.length];
    return Math.round(Math.max(low + margin, Math.min(high - margin, wished)) * 100) / 100;
  });
}

/** The motion of least jerk from rest to rest: 10 s³ - 15 s⁴ + 6 s⁵ of the way. A floating base stands still. */
class Trajectory {
  constructor(from, to, seconds, base = null) {
    Object.assign(this, { from, to, seconds, base });
  }

  /** The state at a time, s. */
  at(time) {
    const s = Math.max(0, Math.min(1, time / this.seconds));
    const way = s ** 3 * (10 - 15 * s + 6 * s * s);
    const rate = (30 * s * s * (1 - s) ** 2) / this.seconds;
    const bend = (60 * s * (1 - s) * (1 - 2 * s)) / this.seconds ** 2;
    const along = (factor) => this.from.map((from, joint) => (this.to[joint] - from) * factor);
    return {
      q: this.from.map((from, joint) => from + (this.to[joint] - from) * way),
      qd: along(rate),
      qdd: along(bend),
      ...(this.base ? { base: structuredClone({ ...this.base, ...AT_REST }) } : {}),
    };
  }
}

/** The joints that a joint follows, in words: `finger_a`, `− left + 0.5 × right`. */
function followed({ follows }, joints) {
  const factor = (size) => (size === 1 ? "" : `${exact(size)} × `);
  const term = ([joint, ratio]) => `${ratio < 0 ? "− " : "+ "}${factor(Math.abs(ratio))}${joints[joint - 1].name}`;
  return follows.ratios.map(term).join(" ").replace(/^\+ /, "");
}

class Sliders {
  constructor(table, inspection, state, changed) {
    this.inputs = new Map();
    this.outputs = new Map();
    const { joints } = inspection.robot;
    this.joints = joints;
    const head = element(
      "tr",
      {},
      element("th", { scope: "col" }, "joint"),
      ...OF.map((of) => element("th", { scope: "col" }, LETTERS[of])),
    );
    table.append(element("thead", {}, head));
    const body = element("tbody");
    joints.forEach((joint, index) => {
      const row = element("tr", { "data-row": index + 1 });
      const name = element(
        "th",
        { scope: "row" },
        String(index + 1),
        element("span", { class: "joint-name", dir: "auto", title: joint.name }, joint.name),
        joint.follows ? element("span", { class: "follows" }, `follows ${followed(joint, joints)}`) : null,
      );
      row.append(name);
      for (const of of OF) {
        const [low, high] = rangeOf(joint, of);
        const quantity = { q: "position", qd: "rate", qdd: "rate_dot" }[of];
        const unitOf = inspection.quantities[quantity]
          ? inspection.unitOf(quantity, index + 1)
          : { q: ["rad", "m"], qd: ["rad/s", "m/s"], qdd: ["rad/s²", "m/s²"] }[of][
              joint.kind === "prismatic" ? 1 : 0
            ];
        const input = element("input", {
          type: "range",
          min: low,
          max: high,
          step: "any",
          "data-joint": index + 1,
          "data-of": of,
          "aria-label": `${LETTERS[of]} of joint ${index + 1}, ${unitOf}`,
        });
        const label = `${LETTERS[of]} of joint ${index + 1}`;
        const set = (value) => {
          state[of][index] = value;
          input.value = value;
          this.tell(state, of, index);
          changed(of, index);
        };
        const field = numberField({ "data-name": `${of}${index + 1}`, "data-field": of, class: "number", "aria-label": `${label} as a number, ${unitOf}` }, set);
        const isAngle = of === "q" && joint.kind === "revolute";
        const degrees = isAngle ? degreesField({ "data-degrees": index + 1, "aria-label": `${label} in degrees` }, set) : null;
        input.addEventListener("input", () => {
          state[of][index] = Number(input.value);
          this.tell(state, of, index);
          changed(of, index);
        });
        goByHundredths(input);
        if (joint.follows) for (const part of [input, field, degrees]) if (part) part.disabled = true;
        this.inputs.set(`${of}${index}`, input);
        this.outputs.set(`${of}${index}`, { field, degrees, unit: unitText(unitOf) });
        const sign = degrees ? element("span", { class: "degree-sign", "aria-hidden": "true" }, "°") : null;
        row.append(element("td", { class: `of-${of}` }, element("span", { class: "slid" }, input, field, degrees, sign)));
      }
      body.append(row);
    });
    table.append(body);
    this.show(state);
  }

  /** Sets the sliders to a state. */
  show(state) {
    for (const of of OF) {
      state[of].forEach((value, index) => {
        this.inputs.get(`${of}${index}`).value = value;
        this.tell(state, of, index);
      });
    }
  }

  /** Shows the state of the joints that follow others, which no slider sets. */
  tellFollowers(state) {
    this.joints.forEach((joint, index) => {
      if (!joint.follows) return;
      for (const of of OF) {
        this.inputs.get(`${of}${index}`).value = state[of][index];
        this.tell(state, of, index);
      }
    });
  }

  tell(state, of, index) {
    const { field, degrees, unit } = this.outputs.get(`${of}${index}`);
    const value = state[of][index];
    fill(field, value);
    field.title = `${full(value)} ${unit}`;
    if (degrees) fillDegrees(degrees, value);
    this.inputs.get(`${of}${index}`).setAttribute("aria-valuetext", `${value.toFixed(3)} ${unit}`);
  }
}
