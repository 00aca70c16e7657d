// The figure of a textbook, on an arm that is seen along its axes: angles with their values, lengths and centres of mass.

/** Digits of a length in the figure. */
const lengthText = (value) => minus(String(Number(value.toPrecision(3))));

/** About where a text of 14 pixels stands. */
function boxOf({ x, y }, anchor, text) {
  const wide = text.length * 7.5;
  const left = anchor === "start" ? x : anchor === "end" ? x - wide : x - wide / 2;
  return { left, right: left + wide, top: y - 13, bottom: y + 4 };
}

class Drawing {
  constructor(arm, root) {
    this.arm = arm;
    this.marks = [];
    for (let joint = 1; joint <= arm.inspection.dof; joint++) {
      const mark = {};
      for (const name of ["reference", "arc", "head", "size", "com"]) mark[name] = svg("path", { class: `drawn ${name}` });
      for (const name of ["angle", "length", "centre"]) mark[`${name}Text`] = svg("text", { class: `drawn-text ${name}` });
      mark.node = svg("g", { "data-drawing": joint }, ...Object.values(mark));
      root.append(mark.node);
      this.marks.push(mark);
    }
  }

  draw(pose, q, isShown) {
    // the boxes of words, so that none is written on another
    this.boxes = [];
    for (const mark of this.marks) mark.node.toggleAttribute("hidden", !isShown);
    if (!isShown) return;
    this.marks.forEach((mark, index) => this.drawAngle(mark, pose, q, index + 1));
    this.marks.forEach((mark, index) => this.drawLengths(mark, pose, index + 1));
  }

  drawAngle(mark, pose, q, joint) {
    const { inspection, size } = this.arm;
    const row = inspection.robot.joints[joint - 1];
    const project = (point) => this.arm.project(point);
    const at = pose.joints[joint];
    const here = project(at);
    const isTurning = row.kind === "revolute";
    const theta = row.theta + (isTurning ? q[joint - 1] : 0);
    const [x, y] = [column(pose.rotations[joint], 0), column(pose.rotations[joint], 1)];
    // where θ = 0 would have the x axis, and what is a quarter turn on from there
    const [s, c] = [Math.sin(theta), Math.cos(theta)];
    const zero = add(times(x, c), times(y, -s));
    const quarter = add(times(x, s), times(y, c));
    const on = (angle, radius) => project(add(at, add(times(zero, radius * Math.cos(angle)), times(quarter, radius * Math.sin(angle)))));
    const radius = size * 0.2;
    for (const name of ["reference", "arc", "head"]) mark[name].setAttribute("d", "");
    mark.angleText.textContent = "";
    if (isTurning) {
      const turn = Math.max(-2 * Math.PI, Math.min(2 * Math.PI, theta));
      const steps = Math.max(2, Math.ceil(Math.abs(turn) / 0.1));
      const points = Array.from({ length: steps + 1 }, (_, step) => on((turn * step) / steps, radius));
      mark.reference.setAttribute("d", segment(here, on(0, radius * 1.7)));
      mark.arc.setAttribute("d", `M${points.map((point) => `${round(point.x)} ${round(point.y)}`).join("L")}`);
      const head = arrowhead(points[Math.max(0, steps - 2)], points[steps], false);
      if (head && Math.abs(turn) * radius * here.scale > 12) mark.head.setAttribute("d", head.path);
      const word = on(turn / 2, radius * 1.12);
      mark.angleText.append(`θ`, svg("tspan", { class: "sub", dy: "0.3em" }, String(joint)), svg("tspan", { dy: "-0.3em" }, ` = ${minus(((theta * 180) / Math.PI).toFixed(1))}°`));
      const side = word.x >= here.x ? 1 : -1;
      this.write(mark.angleText, { x: word.x + 6 * side, y: word.y + 4 }, side > 0 ? "start" : "end");
    }
  }

  drawLengths(mark, pose, joint) {
    const { inspection } = this.arm;
    const row = inspection.robot.joints[joint - 1];
    const at = pose.joints[joint];
    const length = Math.abs(row.a);
    const name = inspection.robot.convention === "modified" ? null : `a${joint}`;
    const [next] = inspection.carriedBy(joint);
    this.dimension(mark.size, mark.lengthText, at, next ? pose.joints[next] : pose.frames[joint].at, -40, name && length > 0 ? `${name} = ${lengthText(row.a)} m` : null);
    const far = norm(minusV(pose.coms[joint], at));
    this.dimension(mark.com, mark.centreText, at, pose.coms[joint], 18, row.mass > 0 && far > 1e-9 ? `com ${lengthText(far)} m` : null);
  }

  /** A line beside a length, with its ends and its words; away to the left for a positive offset, in pixels. */
  dimension(line, words, from, to, offset, text) {
    const [a, b] = [this.arm.project(from), this.arm.project(to)];
    const { length } = direction(a, b);
    const isThere = text !== null && length > 20;
    line.toggleAttribute("hidden", !isThere);
    words.toggleAttribute("hidden", !isThere);
    if (!isThere) return;
    const sides = [offset, -offset].map((of) => this.beside(a, b, of, text));
    const isFree = ({ box }) => this.boxes.every((other) => box.right < other.left || other.right < box.left || box.bottom < other.top || other.bottom < box.top);
    this.dimensionAt(line, words, [a, b], sides.find(isFree) || sides[0], text);
  }

  /** Where the words of a dimension stand that is so far to the left of the way, in pixels. */
  beside(a, b, offset, text) {
    const { x, y } = direction(a, b);
    const way = { x: y * Math.sign(offset), y: -x * Math.sign(offset) };
    const far = Math.abs(offset) + 8;
    const middle = { x: (a.x + b.x) / 2 + way.x * far, y: (a.y + b.y) / 2 + way.y * far + 4 };
    const anchor = way.x > 0.3 ? "start" : way.x < -0.3 ? "end" : "middle";
    return { offset, middle, anchor, box: boxOf(middle, anchor, text) };
  }

  dimensionAt(line, words, [a, b], { offset, middle, anchor }, text) {
    const { x, y } = direction(a, b);
    // to the left of the way on the screen, whose y points down
    const [nx, ny] = [y * offset, -x * offset];
    const beside = (end, share) => ({ x: end.x + nx * share, y: end.y + ny * share });
    const [c, d] = [beside(a, 1), beside(b, 1)];
    const tick = (end) => segment({ x: end.x - x * 3 - nx / Math.abs(offset) * 3, y: end.y - y * 3 - ny / Math.abs(offset) * 3 }, { x: end.x + x * 3 + nx / Math.abs(offset) * 3, y: end.y + y * 3 + ny / Math.abs(offset) * 3 });
    line.setAttribute("d", segment(beside(a, 0.3), beside(a, 1.15)) + segment(beside(b, 0.3), beside(b, 1.15)) + segment(c, d) + tick(c) + tick(d));
    words.textContent = text;
    this.write(words, middle, anchor);
  }

  write(words, { x, y }, anchor) {
    this.boxes.push(boxOf({ x, y }, anchor, words.textContent));
    words.setAttribute("x", round(x));
    words.setAttribute("y", round(y));
    words.setAttribute("text-anchor", anchor);
  }
}
