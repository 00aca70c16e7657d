// The figure of a textbook, on an arm that is seen along its axes: angles with their values, lengths and centres of mass.

/** Digits of a length in the figure. */
const lengthText = (value) => minus(String(Number(value.toPrecision(3))));

class Drawing {
  /** Lines are drawn in `root`, and words in `letters`, which stands above everything else. */
  constructor(arm, root, letters) {
    this.arm = arm;
    this.marks = [];
    for (let joint = 1; joint <= arm.inspection.dof; joint++) {
      const mark = {};
      for (const name of ["reference", "arc", "head", "size", "com"]) mark[name] = svg("path", { class: `drawn ${name}` });
      mark.node = svg("g", { "data-drawing": joint }, ...Object.values(mark));
      for (const name of ["angle", "length", "centre"]) mark[`${name}Text`] = svg("text", { class: `drawn-text ${name}` });
      mark.words = svg("g", {}, mark.angleText, mark.lengthText, mark.centreText);
      root.append(mark.node);
      letters.append(mark.words);
      this.marks.push(mark);
    }
  }

  /** How far from the arm the line of a length is, in pixels: nearer in a small picture. */
  far() {
    return Math.min(this.arm.width, this.arm.height) < 380 ? 28 : 40;
  }

  draw(pose, q, isShown) {
    for (const mark of this.marks) for (const node of [mark.node, mark.words]) node.toggleAttribute("hidden", !isShown);
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
      mark.angleText.append(`θ`, svg("tspan", { class: "sub", dy: "0.3em" }, String(joint)), svg("tspan", { dy: "-0.3em" }, ` = ${minus(((theta * 180) / Math.PI).toFixed(1))}°`));
      const { words } = this.arm;
      words.addLine(here, on(0, radius * 1.7));
      points.slice(1).forEach((point, step) => words.addLine(points[step], point));
      // beside the arc where it can be, or else around the joint
      const arc = [0.5, 0.25, 0.75, 0, 1].map((share) => on(turn * share, radius * 1.15));
      const places = [0, 14, -12].flatMap((dy) => arc.map(({ x, y }) => beside(here, { x, y: y + dy })));
      for (const far of [1.3, 2, 2.8, 3.6])
        for (let hour = 0; hour < 12; hour++) places.push(beside(here, on(turn / 2 + (hour * Math.PI) / 6, radius * far)));
      words.write(mark.angleText, places);
    }
  }

  drawLengths(mark, pose, joint) {
    const { inspection } = this.arm;
    const row = inspection.robot.joints[joint - 1];
    const at = pose.joints[joint];
    const length = Math.abs(row.a);
    const name = inspection.robot.convention === "modified" ? null : `a${joint}`;
    const [next] = inspection.carriedBy(joint);
    this.dimension(mark.size, mark.lengthText, at, next ? pose.joints[next] : pose.frames[joint].at, -this.far(), name && length > 0 ? `${name} = ${lengthText(row.a)} m` : null);
    const far = norm(minusV(pose.coms[joint], at));
    this.dimension(mark.com, mark.centreText, at, pose.coms[joint], 18, row.mass > 0 && far > 1e-9 ? `com ${lengthText(far)} m` : null);
  }

  /** A line beside a length, with its ends and its words; away to the left for a positive offset, in pixels. */
  dimension(line, label, from, to, offset, text) {
    const [a, b] = [this.arm.project(from), this.arm.project(to)];
    const isThere = text !== null && direction(a, b).length > 20;
    line.toggleAttribute("hidden", !isThere);
    label.toggleAttribute("hidden", !isThere);
    if (!isThere) return;
    label.textContent = text;
    const { words } = this.arm;
    const size = words.sizeOf(label);
    const sides = [offset, -offset].map((of, index) => {
      const way = this.beside(a, b, of);
      const box = { left: Math.min(way.c.x, way.d.x), right: Math.max(way.c.x, way.d.x), top: Math.min(way.c.y, way.d.y), bottom: Math.max(way.c.y, way.d.y) };
      const isOutside = box.left < 4 || box.top < 4 || box.right > words.width - 4 || box.bottom > words.height - 4;
      const costs = way.places.map(({ point, anchor }) => words.cost(words.inside(label, point, anchor, size).box));
      const hidden = words.boxes.filter((of) => way.lines.some((line) => crosses(line, of))).length;
      return { ...way, cost: Math.min(...costs) + (isOutside ? 100 : 0) + 60 * hidden + 2 * index };
    });
    const way = sides[0].cost <= sides[1].cost ? sides[0] : sides[1];
    line.setAttribute("d", way.path);
    for (const [one, other] of way.lines) words.addLine(one, other);
    words.write(label, way.places);
  }

  /** The line of a dimension that is so far to the left of the way, in pixels, and where its words may stand. */
  beside(a, b, offset) {
    const { x, y } = direction(a, b);
    // to the left of the way on the screen, whose y points down
    const [nx, ny] = [y * offset, -x * offset];
    const out = { x: nx / Math.abs(offset), y: ny / Math.abs(offset) };
    const at = (end, share) => ({ x: end.x + nx * share, y: end.y + ny * share });
    const [c, d] = [at(a, 1), at(b, 1)];
    const tick = (end) => [{ x: end.x - (x + out.x) * 3, y: end.y - (y + out.y) * 3 }, { x: end.x + (x + out.x) * 3, y: end.y + (y + out.y) * 3 }];
    const lines = [[at(a, 0.3), at(a, 1.15)], [at(b, 0.3), at(b, 1.15)], [c, d]];
    const anchor = out.x > 0.3 ? "start" : out.x < -0.3 ? "end" : "middle";
    const places = [8, 20, 34, 48].flatMap((far) =>
      [0.5, 0.3, 0.7, 0.1, 0.9].map((share) => ({
        point: { x: c.x + (d.x - c.x) * share + out.x * far, y: c.y + (d.y - c.y) * share + out.y * far + 4 + 5 * out.y },
        anchor,
      })),
    );
    // beyond its ends
    for (const [end, way] of [[c, -1], [d, 1]])
      places.push({ point: { x: end.x + x * way * 12, y: end.y + y * way * 12 + 4 }, anchor: x * way > 0.3 ? "start" : x * way < -0.3 ? "end" : "middle" });
    return { c, d, lines, places, path: [...lines, tick(c), tick(d)].map(([one, other]) => segment(one, other)).join("") };
  }
}

/** Where words stand beside a point that is seen from another: on its far side. */
function beside(from, point) {
  const side = point.x >= from.x ? 1 : -1;
  return { point: { x: point.x + 6 * side, y: point.y + 4 }, anchor: side > 0 ? "start" : "end" };
}
