// Where the links are, by the rotations and lengths of the equations: what is needed to draw, and no dynamics.

// ---- vectors of three numbers, and matrices of three rows

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minusV = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(...a);
const unit = (a) => times(a, 1 / (norm(a) || 1));
const turn = (m, v) => [dot(m[0], v), dot(m[1], v), dot(m[2], v)];
const column = (m, at) => [m[0][at], m[1][at], m[2][at]];
const product = (a, b) => a.map((row) => [0, 1, 2].map((at) => dot(row, column(b, at))));

function turnX(angle) {
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  return [
    [1, 0, 0],
    [0, c, -s],
    [0, s, c],
  ];
}

/** Rz(yaw) Ry(pitch) Rx(roll). */
function ofAngles([roll, pitch, yaw]) {
  const [sp, cp, sy, cy] = [Math.sin(pitch), Math.cos(pitch), Math.sin(yaw), Math.cos(yaw)];
  return product(
    product(
      [
        [cy, -sy, 0],
        [sy, cy, 0],
        [0, 0, 1],
      ],
      [
        [cp, 0, sp],
        [0, 1, 0],
        [-sp, 0, cp],
      ],
    ),
    turnX(roll),
  );
}

const AXES = ["x", "y", "z"];

/** The rotation of a joint by its equations; one that is none is not among them. */
function rotationOf(value, joint) {
  return AXES.map((row) =>
    AXES.map((of) => {
      const found = value(`rot${joint}_${row}${of}`);
      return Number.isNaN(found) ? Number(row === of) : found;
    }),
  );
}

/** Half the edges of the box that has the mass and the moments of inertia of a base, m; null where none has them. */
function halvesOf({ mass, inertia }) {
  const sum = inertia[0] + inertia[1] + inertia[2];
  const squares = inertia.map((of) => (1.5 * (sum - 2 * of)) / mass);
  return squares.every((of) => of > 0 && Number.isFinite(of)) ? squares.map(Math.sqrt) : null;
}

/** Where everything stands in the world, by the rotations and lengths of the equations, and where the base is placed. */
class Pose {
  constructor(inspection, value, q, placed = inspection.robot.base) {
    const { robot, dof, floating } = inspection;
    const isModified = robot.convention === "modified";
    const vector = (stem) => AXES.map((axis) => value(`${stem}_${axis}`));
    const base = ofAngles(placed.rpy);
    this.rotations = [base];
    this.joints = [robot.base.xyz];
    this.coms = [floating ? add(robot.base.xyz, turn(base, floating.com)) : robot.base.xyz];
    this.elbows = [robot.base.xyz];
    this.frames = [{ at: robot.base.xyz, axes: base }];
    for (let joint = 1; joint <= dof; joint++) {
      const row = robot.joints[joint - 1];
      const parent = this.frames[row.parent];
      const turned = product(this.rotations[row.parent], rotationOf(value, joint));
      const d = vector(`d${joint}`);
      // where its row begins
      const begins = row.begins || { xyz: [0, 0, 0], rpy: [0, 0, 0] };
      const start = add(parent.at, turn(parent.axes, begins.xyz));
      const at = isModified ? add(start, times(column(product(parent.axes, ofAngles(begins.rpy)), 0), row.a)) : start;
      const b = row.d + (row.kind === "prismatic" ? q[joint - 1] : 0);
      const here = (local) => add(at, turn(turned, local));
      this.rotations.push(turned);
      this.joints.push(at);
      this.elbows.push(here([0, 0, b]));
      this.coms.push(here(d));
      this.frames.push(
        isModified
          ? { at: here([0, 0, b]), axes: turned }
          : { at: here([row.a, 0, b]), axes: product(turned, turnX(row.alpha)) },
      );
    }
    const { at, axes } = this.frames[robot.tip];
    const tip = add(at, turn(axes, robot.tool.xyz));
    this.joints.push(tip);
    this.rotations.push(product(this.rotations[robot.tip], rotationOf(value, dof + 1)));
    this.frames.push({ at: tip, axes: this.rotations[dof + 1] });
    const placedTip = ({ on, xyz, rpy }) => ({
      at: add(this.frames[on].at, turn(this.frames[on].axes, xyz)),
      axes: product(this.frames[on].axes, ofAngles(rpy)),
    });
    this.tips = floating ? floating.tips.map(placedTip) : [this.frames[dof + 1]];
    // the corners of the box of a floating base
    const halves = floating ? halvesOf(floating) : null;
    const signs = [-1, 1].flatMap((z) => [-1, 1].flatMap((y) => [-1, 1].map((x) => [x, y, z])));
    this.box = halves && signs.map((sign) => add(this.coms[0], turn(base, sign.map((of, at) => of * halves[at]))));
  }
}
