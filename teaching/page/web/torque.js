// Torques: what gravity, speed and acceleration have in them, as bars at one state and as curves over a motion.

const PARTS = [
  ["gravity", "gravity", "τ(q, 0, 0)"],
  ["velocity", "Coriolis and centrifugal", "τ(q, q̇, 0) − τ(q, 0, 0)"],
  ["inertia", "inertia", "τ(q, q̇, q̈) − τ(q, q̇, 0)"],
  ["tip", "force and moment at the tip", "τ with what the tip exerts − τ"],
];

/** The parts where the base moves, too. */
const PARTS_WITH_BASE = {
  gravity: "everything at rest in this orientation: q̇ = q̈ = 0, ω = ω̇ = a = 0",
  velocity: "what q̇ and ω add, without accelerations",
  inertia: "what q̈, ω̇ and a add",
  tip: "what the forces and moments at the tips add",
};

/** A floating base that keeps its orientation and does not move. */
const AT_REST = { omega: [0, 0, 0], omega_dot: [0, 0, 0], acceleration: [0, 0, 0] };

/**
 * The torques of a state and their parts, each a list with a number per joint; `onBase` has the same lists of force and
 * moment on a floating base.
 */
class Torques {
  constructor(inspection, folded, withWrench) {
    this.inspection = inspection;
    this.folded = folded;
    this.withWrench = withWrench;
  }

  split(state, wrench = null) {
    const { q, qd, qdd, base } = state;
    const still = q.map(() => 0);
    const of = (state) => this.folded.run(this.inspection.argumentsOf(state));
    const gravity = of({ q, qd: still, qdd: still, base: base && { ...base, ...AT_REST } });
    const moving = of({ q, qd, qdd: still, base: base && { ...base, ...AT_REST, omega: base.omega } });
    // last, so that the program's intermediates are those of the state
    const free = of({ q, qd, qdd, base });
    const total =
      wrench && [...wrench.f, ...wrench.n].some((of) => of !== 0)
        ? this.withWrench.run(this.inspection.argumentsOf(state, wrench))
        : free;
    const less = (a, b) => a.map((value, at) => value - b[at]);
    const parts = {
      total,
      free,
      gravity,
      velocity: less(moving, gravity),
      inertia: less(free, moving),
      tip: less(total, free),
    };
    const each = (part) => Object.fromEntries(Object.entries(parts).map(([name, values]) => [name, part(values)]));
    const ofBase = base ? 6 : 0;
    const torques = each((values) => this.inspection.ofJoints(values.slice(ofBase)));
    return base ? { ...torques, onBase: each((values) => values.slice(0, ofBase)) } : torques;
  }
}

/** The rows of bars of the torques. No actuator is at a joint that follows others. */
const barsOfJoints = (inspection) =>
  inspection.robot.joints.map((joint, index) => ({
    name: `tau${index + 1}`,
    label: `torque ${index + 1}`,
    unit: unitText(inspection.unitOf("torque", index + 1)),
    data: { "data-torque": index + 1 },
    symbol: math("msub", {}, math("mi", {}, "τ"), math("mn", {}, String(index + 1))),
    isLeftOut: Boolean(joint.follows),
  }));

/** The rows of bars of what must act on a floating base. */
const barsOfBase = (inspection) =>
  [["f", "base_force", "force"], ["n", "base_moment", "moment"]].flatMap(([of, quantity, word]) =>
    AXES.map((axis) => ({
      name: `${of}b0_${axis}`,
      label: `${word} on the base along ${axis}`,
      unit: unitText(inspection.unitOf(quantity, 0)),
      data: { "data-on-base": `${of}${axis}` },
      group: of,
      symbol: math("msub", {}, math("mi", {}, inspection.quantities[quantity].letter), math("mi", {}, axis)),
    })),
  );

class Bars {
  constructor(list, rows) {
    this.rows = rows.map(({ name, label: words, unit, data, symbol, group, isLeftOut }) => {
      const segments = PARTS.map(([part, meaning]) => element("span", { class: `bar ${part}`, title: meaning }));
      const total = element("span", { class: "bar-total" });
      const track = element(
        "div",
        { class: "track", "aria-hidden": "true" },
        element("span", { class: "zero" }),
        ...segments,
        total,
      );
      const text = element("output", { ...data, class: "torque-value" });
      const label = element(
        "button",
        { type: "button", class: "torque-name pick", "data-name": name, "aria-label": words },
        math("math", {}, symbol),
      );
      const [low, high] = [element("span", { class: "end low" }), element("span", { class: "end high" })];
      const row = element(
        "li",
        {},
        label,
        element(
          "div",
          { class: "scale" },
          track,
          element("div", { class: "ends", "aria-hidden": "true" }, low, element("span", { class: "end" }, "0"), high),
        ),
        text,
      );
      if (!isLeftOut) list.append(row);
      return { name, group, segments, total, text, low, high, unit, end: 0 };
    });
  }

  /** How far the bars of a row reach, to one side or the other. */
  reach(split, at) {
    const values = PARTS.map(([part]) => split[part][at]);
    const above = values.filter((value) => value > 0).reduce((sum, value) => sum + value, 0);
    const below = -values.filter((value) => value < 0).reduce((sum, value) => sum + value, 0);
    return Math.max(above, below, 1e-9);
  }

  update(split, isHidden = () => false) {
    const reaches = this.rows.map((_, at) => this.reach(split, at));
    this.rows.forEach((row, joint) => {
      const values = PARTS.map(([part]) => split[part][joint]);
      // components of one vector have one scale
      const most = row.group
        ? Math.max(0, ...reaches.filter((reach, at) => reach > 1e-9 && this.rows[at].group === row.group)) || 1
        : reaches[joint];
      // an end that moved with every number would hide what grows
      if (most > row.end || most < row.end / 6) {
        row.end = niceAbove(most * 1.05);
        row.low.textContent = exact(-row.end);
        row.high.textContent = `${exact(row.end)} ${row.unit}`;
      }
      const stack = { up: 0, down: 0 };
      values.forEach((value, part) => {
        const size = (50 * Math.abs(value)) / row.end;
        const { style } = row.segments[part];
        style.left = `${value >= 0 ? 50 + stack.up : 50 - stack.down - size}%`;
        style.width = `${size}%`;
        const told = isHidden(row.name) ? "" : `: ${short(value)} ${row.unit}`;
        row.segments[part].title = `${PARTS[part][1]}${told}`;
        stack[value >= 0 ? "up" : "down"] += size;
      });
      row.total.style.left = `${50 + (50 * split.total[joint]) / row.end}%`;
      row.text.textContent = isHidden(row.name) ? "?" : `${short(split.total[joint])} ${row.unit}`;
      row.text.title = isHidden(row.name) ? "" : `${full(split.total[joint])} ${row.unit}`;
    });
  }
}

/** The torque of one joint over a motion. */
class Plot {
  constructor(root, inspection, torques) {
    Object.assign(this, { root, inspection, torques, joint: Math.min(2, inspection.dof), time: 0 });
    this.curves = {};
    this.axes = svg("g", { class: "plot-axes" });
    root.append(this.axes);
    for (const part of [...PARTS.map(([part]) => part), "total"]) {
      this.curves[part] = svg("path", { class: `curve ${part}` });
      root.append(this.curves[part]);
    }
    this.peak = svg("g", { class: "peak" }, svg("circle", { r: 4.5 }), svg("text"));
    this.hand = svg("path", { class: "hand" });
    root.append(this.peak, this.hand);
  }

  /** Another motion, under the wrench at the tip: all of it is computed. */
  set(trajectory, wrench) {
    const count = 160;
    this.trajectory = trajectory;
    this.samples = Array.from({ length: count + 1 }, (_, at) => {
      const time = (trajectory.seconds * at) / count;
      return { time, ...this.torques.split(trajectory.at(time), wrench) };
    });
    this.draw();
  }

  /** The sample at which the joint's torque is largest, and the largest part of speed in it. */
  largest(joint = this.joint) {
    const at = joint - 1;
    const by = (of) =>
      this.samples.reduce((most, sample) => (Math.abs(of(sample)) > Math.abs(of(most)) ? sample : most));
    const peak = by((sample) => sample.total[at]);
    const fastest = by((sample) => sample.velocity[at]);
    return {
      time: peak.time,
      value: peak.total[at],
      velocity: fastest.velocity[at],
      velocityTime: fastest.time,
      velocityAtPeak: peak.velocity[at],
    };
  }

  draw() {
    const [width, height] = [this.root.clientWidth || 600, this.root.clientHeight || 240];
    this.root.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const box = { left: 52, right: width - 14, top: 30, bottom: height - 34 };
    const at = this.joint - 1;
    const all = this.samples.flatMap((sample) =>
      Object.keys(this.curves).map((part) => sample[part][at]),
    );
    const [least, most] = [Math.min(0, ...all), Math.max(0, ...all)];
    const step = niceAbove((most - least || 1) / 4);
    const [low, high] = [Math.floor(least / step) * step, Math.ceil(most / step + 1e-9) * step || step];
    const x = (this.x = (time) => box.left + ((box.right - box.left) * time) / this.trajectory.seconds);
    const y = (value) => box.bottom - ((box.bottom - box.top) * (value - low)) / (high - low);
    const unitOf = unitText(this.inspection.unitOf("torque", this.joint));
    const marks = [];
    for (let value = low; value <= high + step / 2; value += step) {
      const tidy = Math.abs(value) < step / 1e6 ? 0 : value;
      marks.push(svg("path", { d: `M${box.left} ${y(tidy)}H${box.right}`, class: tidy === 0 ? "zero" : "" }));
      marks.push(
        svg("text", { x: box.left - 7, y: y(tidy) + 4, class: "end" }, minus(String(Number(tidy.toPrecision(4))))),
      );
    }
    const seconds = niceAbove(this.trajectory.seconds / 6);
    for (let time = 0; time <= this.trajectory.seconds * (1 + 1e-9); time += seconds) {
      marks.push(
        svg("text", { x: x(time), y: box.bottom + 16, class: "middle" }, String(Number(time.toPrecision(3)))),
      );
    }
    marks.push(svg("text", { x: box.right, y: box.bottom + 30, class: "end" }, "time, s"));
    marks.push(svg("text", { x: 4, y: 14 }, `τ${this.joint}, ${unitOf}`));
    this.axes.replaceChildren(...marks);
    this.curves.tip.toggleAttribute("hidden", this.samples.every((sample) => sample.tip[at] === 0));
    for (const [part, curve] of Object.entries(this.curves)) {
      curve.setAttribute(
        "d",
        this.samples
          .map((sample, index) => `${index ? "L" : "M"}${round(x(sample.time))} ${round(y(sample[part][at]))}`)
          .join(""),
      );
    }
    const peak = this.largest();
    const [circle, text] = this.peak.children;
    circle.setAttribute("cx", x(peak.time));
    circle.setAttribute("cy", y(peak.value));
    const isRight = x(peak.time) > (box.left + box.right) / 2;
    text.setAttribute("x", x(peak.time) + (isRight ? -9 : 9));
    text.setAttribute("y", Math.max(box.top - 4, y(peak.value) + (peak.value < 0 ? 16 : -8)));
    text.setAttribute("text-anchor", isRight ? "end" : "start");
    text.textContent = `peak ${short(peak.value)} ${unitOf}`;
    this.span = box;
    this.point(this.time);
  }

  /** Whether a state, whose torques the bars show, is that of the motion at the time of the cursor. */
  has(state) {
    const there = this.trajectory.at(this.time);
    const isThere = (a, b) => a.every((value, at) => Math.abs(value - b[at]) <= 1e-9);
    const isBaseThere = !state.base || Object.keys(state.base).every((of) => isThere(there.base[of], state.base[of]));
    return isBaseThere && OF.every((of) => isThere(there[of], state[of]));
  }

  /** Where the motion is, s. */
  point(time) {
    this.time = time;
    const at = round(this.x(Math.min(time, this.trajectory.seconds)));
    this.hand.setAttribute("d", `M${at} ${this.span.top}V${this.span.bottom}`);
  }

  /** What the curves show, in words. */
  words() {
    const unitOf = unitText(this.inspection.unitOf("torque", this.joint));
    const peak = this.largest();
    const share = Math.abs(peak.value) > 0 ? Math.round((100 * Math.abs(peak.velocity)) / Math.abs(peak.value)) : 0;
    return (
      `Joint ${this.joint}: peak ${short(peak.value)} ${unitOf} at ${short(peak.time)} s. ` +
      `The velocity terms reach ${short(peak.velocity)} ${unitOf}, ${share} % of that.`
    );
  }
}
