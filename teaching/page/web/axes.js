// In whose axes a vector's components are told: those in which the code computes, or others. `rne eval --trace --axes`
// has the same three.

const KINDS_OF_AXES = ["link", "joint", "base"];

const transposed = (m) => [0, 1, 2].map((at) => column(m, at));

/** From axes fixed to a link into the lecture's, fixed to the link before and also with z along the joint: Rz(θ). */
function intoLectureAxes(row, q) {
  const angle = row.theta + (row.kind === "revolute" ? q : 0);
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  return [
    [c, -s, 0],
    [s, c, 0],
    [0, 0, 1],
  ];
}

class ChosenAxes {
  /** `value(name)` is that of the code; `stateOf()` the positions of the joints. */
  constructor(inspection, value, stateOf) {
    Object.assign(this, { inspection, value, stateOf, kind: "link" });
  }

  /**
   * From the axes in which the code has the vectors of a link into axes of a kind, or null where these are the same.
   * Link 0 is the base, and n + 1 the tip, whose axes are its own also in the lecture.
   */
  turn(link, kind = this.kind) {
    const { dof, robot } = this.inspection;
    if (kind === "link" || link < 1) return null;
    if (kind === "joint") return link > dof ? null : intoLectureAxes(robot.joints[link - 1], this.stateOf()[link - 1]);
    return this.inspection.pathTo(link).map((joint) => rotationOf(this.value, joint)).reduce(product);
  }

  /** Whether the components of a name are other numbers in other axes: those of vectors, of I and of R. */
  has({ quantity, component, part, of }) {
    if (part || !component) return false;
    if (component.length === 1) return Boolean(of.axes);
    return quantity === "inertia" || quantity === "rotation";
  }

  /** The names of the three components of a vector. */
  vectorOf({ quantity, joint, carries }) {
    return AXES.map((axis) => this.inspection.nameOf(quantity, joint, axis, carries));
  }

  /** The value of a name in axes of a kind; in link axes that of the code. */
  component(name, kind = this.kind) {
    const meaning = this.inspection.meaning(name);
    if (kind === "link" || !meaning || !this.has(meaning)) return this.value(name);
    const at = [...meaning.component].map((axis) => AXES.indexOf(axis));
    if (at.length === 1) {
      const names = this.vectorOf(meaning);
      const turned = this.turn(this.inspection.axes(meaning), kind);
      return turned && names.every(Boolean) ? turn(turned, names.map((of) => this.value(of)))[at[0]] : this.value(name);
    }
    const { quantity, joint } = meaning;
    const own = (which) => this.turn(which, kind) || intoLectureAxes({ theta: 0, kind: "prismatic" }, 0);
    if (quantity === "inertia") {
      const entry = (a, b) => this.value(this.inspection.nameOf(quantity, joint, a <= b ? a + b : b + a));
      const inertia = AXES.map((row) => AXES.map((of) => entry(row, of)));
      return product(product(own(joint), inertia), transposed(own(joint)))[at[0]][at[1]];
    }
    // between two sets of axes that both are those of the base there is no rotation to tell of
    if (kind === "base") return this.value(name);
    const before = own(this.inspection.parentOf(joint));
    return product(product(before, rotationOf(this.value, joint)), transposed(own(joint)))[at[0]][at[1]];
  }

  /** Whether a name is told in other axes than those of its equation. */
  isOther(name) {
    const meaning = this.inspection.meaning(name);
    if (this.kind === "link" || !meaning || !this.has(meaning)) return false;
    // a floating base has one set of axes
    if (this.inspection.floating && meaning.joint === 0) return false;
    return meaning.quantity !== "rotation" || this.kind === "joint";
  }

  /** The axes of the vectors of a link, in words. */
  words(link, kind = this.kind) {
    const { dof } = this.inspection;
    if (link < 1 || kind === "base") return "the axes of the base";
    if (link > dof) return "the axes of the tip";
    const parent = this.inspection.parentOf(link);
    return kind === "link"
      ? `the axes of link ${link}`
      : `the lecture's axes of joint ${link}, fixed to ${parent === 0 ? "the base" : `link ${parent}`}`;
  }
}
