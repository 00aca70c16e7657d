// The arm in three dimensions, from its table: links, joint axes, frames, centres of mass, and vectors as arrows.

/** How the vectors of a quantity look: what they are of, and whether they are axial, with two heads. */
const KINDS = {
  omega: ["turn", true],
  omega_dot: ["turn", true],
  rate: ["turn", true],
  rate_dot: ["turn", true],
  twice_rate: ["turn", true],
  angular_momentum: ["turn", true],
  joint_moment: ["moment", true],
  inertia_moment: ["moment", true],
  child_moment: ["moment", true],
  torque: ["moment", true],
  base_moment: ["moment", true],
  base_force: ["force", false],
  joint_force: ["force", false],
  inertia_force: ["force", false],
  child_force: ["force", false],
  gravity: ["gravity", false],
  d: ["length", false],
  r: ["length", false],
};

/** What is along the axis of its joint: one number. */
const AXIAL = ["torque", "rate", "rate_dot", "twice_rate"];

/** The vectors that can be shown for all links at once, and the step that computes them. */
const LAYERS = [
  ["omega", 1],
  ["omega_dot", 2],
  ["velocity", 3],
  ["acceleration", 4],
  ["gravity", 5],
  ["joint_force", 6],
  ["joint_moment", 6],
  ["torque", 7],
];

/** What a floating base has in a layer: its quantities are others than those of links. */
const LAYER_OF_BASE = { base_acceleration: "acceleration", base_force: "joint_force", base_moment: "joint_moment" };

/** The faces of a box by its corners, which count x first and z last: bottom and top stand first. */
const FACES = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/** The key of an arrow: omega-2, or r-1-5 for the lever of link 1 to joint 5, which is not the first on it. */
const keyOfArrow = ({ quantity, joint, carries }) => `${quantity}-${joint}${carries ? `-${carries}` : ""}`;

function arrowOfKey(key) {
  const [quantity, joint, carries = 0] = key.split("-");
  return { quantity, joint: Number(joint), carries: Number(carries) };
}

/** From where the arm can be looked at by a button. */
const VIEWS = ["front", "top", "3D"];

/** The radius of the base, in those of its joint. */
const BASE_DISC = 2.6;

class Arm {
  constructor(root, inspection, value, chosen) {
    this.root = root;
    this.chosen = chosen;
    this.inspection = inspection;
    this.value = value;
    this.layers = new Set();
    this.arrows = new Map();
    this.showFrames = false;
    this.showComs = true;
    const { robot, dof } = inspection;
    const gravity = turn(ofAngles(robot.base.rpy), robot.gravity);
    this.up = norm(gravity) > 0 ? unit(times(gravity, -1)) : [0, 0, 1];
    this.gravityInWorld = gravity;
    // where frame 0 stands
    this.placed = robot.base;
    const near = Math.abs(this.up[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
    this.east = unit(cross(cross(this.up, near), this.up));
    this.north = cross(this.up, this.east);
    // the joints from the base to a link
    this.depths = Array.from({ length: dof + 1 }, (_, link) => inspection.pathTo(link).length);
    this.groups = {};
    for (const name of ["floor", "axes", "solids", "coms", "drawing", "frames", "arrows", "labels", "words"]) {
      this.groups[name] = svg("g", { class: name });
      root.append(this.groups[name]);
    }
    this.floor = svg("path", { class: "grid" });
    this.groups.floor.append(this.floor);
    this.axes = [];
    this.solids = [];
    this.coms = [];
    this.labels = [];
    this.triads = [];
    for (let joint = 0; joint <= dof + 1; joint++) {
      this.triads.push(
        AXES.map((axis) => {
          const of = {
            line: svg("path", { class: `axis-${axis}`, "data-frame": joint }),
            text: svg("text", { class: `axis-${axis}` }, axis),
          };
          this.groups.frames.append(of.line, of.text);
          return of;
        }),
      );
      if (joint > dof) break;
      const solids = [
        { kind: "link", joint },
        ...(joint > 0 ? [{ kind: "joint", joint }] : [{ kind: "base", joint }]),
      ];
      for (const solid of solids) {
        solid.body = svg("path", { class: "body" });
        solid.cap = svg("path", { class: "cap" });
        solid.node = svg("g", { class: `solid ${solid.kind}`, "data-link": joint }, solid.body, solid.cap);
        this.groups.solids.append(solid.node);
        this.solids.push(solid);
      }
      if (joint === 0) continue;
      const axis = svg("path", { class: "joint-axis", "data-axis": joint });
      this.groups.axes.append(axis);
      this.axes.push(axis);
      const com = svg(
        "g",
        {
          class: "com",
          "data-com": joint,
          tabindex: "0",
          role: "button",
          "aria-label": `centre of mass of link ${joint}`,
        },
        svg("circle", { r: 6 }),
        svg("path", { d: "M0 0V-6A6 6 0 0 1 6 0ZM0 0V6A6 6 0 0 1 -6 0Z" }),
      );
      this.groups.coms.append(com);
      this.coms.push(com);
      const label = svg("text", { class: "joint-number" }, String(joint));
      this.groups.labels.append(label);
      this.labels.push(label);
    }
    for (const [quantity] of LAYERS) {
      for (let joint = 1; joint <= dof; joint++) this.arrow(quantity, joint);
    }
    if (inspection.floating) {
      for (const quantity of ["omega", "omega_dot", "gravity", ...Object.keys(LAYER_OF_BASE)]) this.arrow(quantity, 0);
    }
    this.down = this.plainArrow("gravity", "g");
    this.tips = inspection.tips.map(() => ({ f: this.plainArrow("force", "tip force"), n: this.plainArrow("moment", "tip moment") }));
    this.wrench = inspection.freeTips();
    this.words = new Labels();
    this.look = { yaw: -0.9, pitch: 0.32, zoom: 1 };
    this.home = this.look;
    this.drawing = new Drawing(this, this.groups.drawing, this.groups.words);
    this.showDrawing = true;
    listenToHand(this);
  }

  /** The arrow of a quantity of a joint, or of one of several on a link; made when it is first wanted. */
  arrow(quantity, joint, carries = 0) {
    const key = keyOfArrow({ quantity, joint, carries });
    if (!this.arrows.has(key)) {
      const isSlide = AXIAL.includes(quantity) && this.inspection.isPrismatic(joint);
      const slides = quantity === "torque" ? ["force", false] : ["motion", false];
      const [kind, isAxial] = isSlide ? slides : KINDS[quantity] || ["motion", false];
      const of = this.inspection.quantities[quantity];
      if (!of || !of.drawn || joint < 0) return null;
      const parts = {
        hit: svg("path", { class: "hit" }),
        shaft: svg("path", { class: "shaft" }),
        head: svg("path", { class: "head" }),
        part: svg("path", { class: "part" }),
        text: svg("text", {}, of.letter, svg("tspan", { class: "sub", dy: "0.3em" }, this.inspection.indexText({ quantity, joint, carries }))),
      };
      const node = svg(
        "g",
        { class: `arrow ${kind}`, "data-arrow": key, tabindex: "0", role: "button", hidden: "" },
        ...Object.values(parts),
      );
      this.groups.arrows.append(node);
      this.arrows.set(key, { key, quantity, joint, carries, of, isAxial, node, ...parts });
    }
    return this.arrows.get(key);
  }

  /** An arrow that belongs to no name. */
  plainArrow(kind, text) {
    const parts = [svg("path", { class: "shaft" }), svg("path", { class: "head" }), svg("text", {}, text)];
    this.groups.labels.append(svg("g", { class: `arrow plain ${kind}`, role: "img", "aria-label": text }, ...parts));
    return parts;
  }

  drawPlain([shaft, head, text], from, to, isAxial = false) {
    const heads = arrowhead(from, to, isAxial);
    shaft.setAttribute("d", heads ? segment(from, heads.neck) : "");
    head.setAttribute("d", heads ? heads.path : ringAt(from));
    this.words.addLine(from, to, 3);
    this.words.put(text, this.words.inside(text, { x: to.x + 7, y: to.y + 4 }, "start"));
  }

  /** Gravity, in the corner, and the wrenches at the tips, the longest of a kind with a fixed length. */
  drawForces(pose) {
    const isHeavy = norm(this.gravityInWorld) > 0;
    this.down[0].parentNode.toggleAttribute("hidden", !isHeavy);
    if (isHeavy) {
      const [from, to] = [this.centre, add(this.centre, times(this.up, -0.3 * this.size))].map((point) =>
        this.project(point),
      );
      const corner = { x: 24 - Math.min(0, to.x - from.x), y: 20 };
      this.drawPlain(this.down, corner, { x: corner.x + to.x - from.x, y: corner.y + to.y - from.y });
    }
    for (const of of ["f", "n"]) {
      const vectors = pose.tips.map((_, tip) => this.wrench[of].slice(3 * tip, 3 * tip + 3));
      const largest = Math.max(...vectors.map(norm));
      vectors.forEach((vector, tip) => {
        const isFree = norm(vector) === 0;
        this.tips[tip][of][0].parentNode.toggleAttribute("hidden", isFree);
        if (isFree) return;
        const { at, axes } = pose.tips[tip];
        const along = times(turn(axes, vector), (this.size * 0.5) / largest);
        const [from, to] = [at, add(at, along)].map((point) => this.project(point));
        this.drawPlain(this.tips[tip][of], from, to, of === "n");
      });
    }
  }

  /** The vector of an arrow: its numbers, in its own axes, or null where the arm has none. */
  vector({ quantity, joint, carries, of }) {
    if (of.drawn === "axis") {
      const name = this.inspection.nameOf(quantity, joint);
      return name && AXIAL.includes(quantity) ? [0, 0, this.value(name)] : null;
    }
    if (!of.axes) return null;
    const names = AXES.map((axis) => this.inspection.nameOf(quantity, joint, axis, carries));
    return names.every(Boolean) ? names.map((name) => this.value(name)) : null;
  }

  /** Chooses from where to look at first: along the axes of an arm whose joints are all parallel. */
  fit(poses) {
    const [first] = poses;
    const { robot, dof: last } = this.inspection;
    const axes = first.rotations.slice(1, last + 1).map((turned) => column(turned, 2));
    // all of whose axes are parallel, so that a figure in the plane has everything
    this.isPlanar = !this.inspection.floating && axes.every((axis) => Math.abs(dot(axis, axes[0])) > 0.999);
    const axis = axes[0];
    const isUpright = Math.abs(dot(axis, this.up)) > 0.999;
    // the arm from its side
    const out = minusV(first.joints[last + 1], first.joints[1]);
    const along = Math.atan2(dot(out, this.north), dot(out, this.east));
    const side = Number.isFinite(along) && norm(out) > 1e-6 ? along - 1.15 : -0.9;
    const face = Math.atan2(dot(axis, this.north), dot(axis, this.east));
    const isFigure = this.isPlanar && !isUpright;
    this.baseAxis = isFigure ? axis : this.up;
    const yaw = isFigure ? face : side;
    const tilt = isFigure ? Math.asin(Math.max(-1, Math.min(1, dot(axis, this.up)))) : 0;
    this.views = {
      front: { yaw, pitch: tilt, zoom: 1 },
      // x of the base to the right
      top: { yaw: isUpright ? this.yawOfTop(first) : yaw, pitch: Math.PI / 2, zoom: 1 },
      "3D": { yaw: isFigure ? face - 0.35 : side, pitch: isFigure ? 0.2 : 0.3, zoom: 1 },
    };
    this.home = this.views[this.isPlanar ? (isUpright ? "top" : "front") : "3D"];
    this.look = this.home;
    const points = poses.flatMap((pose) => [...pose.joints, ...pose.coms, ...pose.elbows, ...pose.tips.map(({ at }) => at), ...(pose.box || [])]);
    const low = AXES.map((_, at) => Math.min(...points.map((point) => point[at])));
    const high = AXES.map((_, at) => Math.max(...points.map((point) => point[at])));
    this.centre = times(add(low, high), 0.5);
    this.size = Math.max(norm(minusV(high, low)) / 2, 0.05) * 1.05;
    this.extent = this.size;
    // a floating base is above the ground on which its robot stands first
    const ground = Math.min(...points.map((point) => dot(minusV(point, robot.base.xyz), this.up)));
    this.ground = this.inspection.floating ? add(robot.base.xyz, times(this.up, ground)) : robot.base.xyz;
  }

  /** The yaw with which x of frame 0 points to the right in a view from above. */
  yawOfTop(pose) {
    const x = column(pose.frames[0].axes, 0);
    return Math.atan2(-dot(x, this.east), dot(x, this.north));
  }

  lookOf(name) {
    return this.views[name];
  }

  /** The name of the view, or null for one that a hand has chosen. */
  viewName() {
    const { yaw, pitch, zoom } = this.look;
    return VIEWS.find((name) => this.views[name].yaw === yaw && this.views[name].pitch === pitch && this.views[name].zoom === zoom) || null;
  }

  lookFrom(name) {
    this.look = this.views[name];
    this.changed();
  }

  /** Whether the arm is seen along its parallel axes, without perspective: as a figure. */
  isFigure() {
    if (!this.isPlanar || !this.pose) return false;
    return Math.abs(dot(this.seenFrom().toViewer, column(this.pose.rotations[1], 2))) > 1 - 1e-9;
  }

  /** From where the arm is seen: the axes of the screen in the world. */
  seenFrom() {
    const { yaw, pitch } = this.look;
    const flat = add(times(this.east, Math.cos(yaw)), times(this.north, Math.sin(yaw)));
    const toViewer = add(times(flat, Math.cos(pitch)), times(this.up, Math.sin(pitch)));
    const right = cross(this.up, flat);
    return { toViewer, right, over: cross(toViewer, right), far: 5 * this.extent };
  }

  project(point) {
    const { toViewer, right, over, far } = this.view;
    const of = minusV(point, this.centre);
    const depth = dot(of, toViewer);
    const scale = this.isFlat ? this.pixels : (this.pixels * far) / Math.max(far - depth, far / 10);
    return {
      x: this.width / 2 + (dot(of, right) - this.middle.x) * scale,
      y: this.height * (this.isFlat ? 0.5 : 0.53) - (dot(of, over) - this.middle.y) * scale,
      depth,
      scale,
    };
  }

  /** Asks for the size of the picture: only when it changed, for the answer waits for the layout of the page. */
  measure() {
    this.width = this.root.clientWidth || 600;
    this.height = this.root.clientHeight || 450;
    this.root.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
  }

  /** Draws the arm at a state; `lit` are the keys of arrows that are shown whatever layers there are. */
  draw(q) {
    if (!this.width) this.measure();
    const pose = (this.pose = new Pose(this.inspection, this.value, q, this.placed));
    if (!this.centre) this.fit([pose]);
    const reach = Math.max(...pose.joints.map((point) => norm(minusV(point, this.centre))));
    this.extent = Math.max(this.size, reach * 1.02);
    this.view = this.seenFrom();
    this.isFlat = this.isFigure();
    this.middle = { x: 0, y: 0 };
    if (this.isFlat) this.fitFigure(pose);
    else this.pixels = (0.39 * Math.min(this.width, this.height * 1.1) * this.look.zoom) / this.extent;
    this.drawFloor();
    this.drawSolids(pose);
    this.drawMarks(pose);
    this.drawVectors(pose, q);
  }

  /** Arrows and, of a figure, dimensions, whose words keep away from them and from the arm. */
  drawVectors(pose, q) {
    this.q = q;
    this.words.begin(this.width, this.height);
    const isDrawn = this.isFlat && this.showDrawing;
    this.rings = [];
    this.drawArrows(pose);
    this.drawForces(pose);
    if (isDrawn) this.addArm(pose);
    this.drawing.draw(pose, q, isDrawn);
    // letters of rings keep away from the arcs of angles
    for (const { text, at } of this.rings.filter(({ text }) => isDrawn && !text.hasAttribute("hidden"))) {
      const places = [-8, 20, 6].flatMap((dy) => [[13, "start"], [-13, "end"]].map(([dx, anchor]) => ({ point: { x: at.x + dx, y: at.y + dy }, anchor })));
      this.words.write(text, places);
    }
  }

  /** Words keep away from links, joints and centres of mass. */
  addArm(pose) {
    const around = (point, radius) => this.words.addBox({ left: point.x - radius, right: point.x + radius, top: point.y - radius, bottom: point.y + radius });
    for (let joint = 1; joint <= this.inspection.dof; joint++) {
      const [at, elbow, com] = [pose.joints[joint], pose.elbows[joint], pose.coms[joint]].map((point) => this.project(point));
      const ends = this.inspection.carriedBy(joint).map((end) => this.project(pose.joints[end]));
      const thick = this.thickness(joint) * 0.62 * this.pixels;
      this.words.addLine(at, elbow, thick);
      for (const end of ends.length ? ends : [com]) this.words.addLine(elbow, end, thick);
      around(at, 8);
      if (this.showComs) around(com, 6);
    }
  }

  /**
   * The scale and the middle of a figure. They stay while the arm fits the picture with room for its dimensions, so
   * that the base stands still; a picture of another size or from another side begins anew.
   */
  fitFigure(pose) {
    const { yaw, pitch, zoom } = this.look;
    const { right, over } = this.view;
    const disc = this.thickness(0) * BASE_DISC;
    const ends = [...pose.joints, ...pose.elbows, ...pose.coms].map((point) => [point, this.thickness(0)]);
    ends.push([this.inspection.robot.base.xyz, disc]);
    const reach = (along) => {
      const values = ends.map(([point, around]) => [dot(minusV(point, this.centre), along), around]);
      return [Math.min(...values.map(([value, around]) => value - around)), Math.max(...values.map(([value, around]) => value + around))];
    };
    const [x, y] = [reach(right), reach(over)];
    const edge = this.showDrawing ? this.drawing.far() + 20 : 16;
    const [wide, high] = [Math.max(this.width - 2 * edge, 60), Math.max(this.height - 2 * edge, 60)];
    const seen = [this.width, this.height, yaw, pitch, edge].join();
    const fits = ([low, top], middle, room) => Math.max(top - middle, middle - low) * this.figure.pixels <= room / 2 + 1e-6;
    const isFit = this.figure?.seen === seen && fits(x, this.figure.x, wide) && fits(y, this.figure.y, high);
    if (!this.figure || (!isFit && zoom === 1) || this.figure.seen !== seen) {
      const most = (0.47 * Math.min(this.width, this.height * 1.1)) / this.size;
      const pixels = Math.min(wide / (x[1] - x[0]), high / (y[1] - y[0]), most);
      this.figure = { seen, pixels, x: (x[0] + x[1]) / 2, y: (y[0] + y[1]) / 2 };
    }
    this.middle = { x: this.figure.x, y: this.figure.y };
    this.pixels = this.figure.pixels * zoom;
  }

  /** Half the width of a link's joint, in m: the more joints from the base, the thinner. */
  thickness(joint) {
    return this.size * (0.062 - 0.03 * (this.depths[joint] / Math.max(...this.depths, 4)));
  }

  drawFloor() {
    // it stands still while the arm moves
    const seen = [this.look.yaw, this.look.pitch, this.pixels, this.extent, this.width, this.height, this.middle.x, this.middle.y].join();
    if (seen === this.floorSeen) return;
    this.floorSeen = seen;
    const span = this.size * 0.95;
    const step = niceAbove(span / 4);
    const count = Math.ceil(span / step);
    const at = (a, b) =>
      this.project(add(this.ground, add(times(this.east, a * step), times(this.north, b * step))));
    let path = "";
    for (let line = -count; line <= count; line++) {
      path += segment(at(line, -count), at(line, count)) + segment(at(-count, line), at(count, line));
    }
    this.floor.setAttribute("d", path);
    this.floor.toggleAttribute("hidden", Boolean(this.inspection.floating) && norm(this.gravityInWorld) === 0);
  }

  drawSolids(pose) {
    for (const solid of this.solids) {
      const { joint, kind } = solid;
      const radius = this.thickness(joint);
      if (joint === 0 && pose.box) {
        this.drawBox(solid, pose);
      } else if (kind === "link") {
        const from = joint === 0 ? this.inspection.robot.base.xyz : pose.joints[joint];
        const carried = this.endsOf(joint, pose);
        // the end of a branch reaches to its centre of mass
        const ends = carried.length ? carried : [pose.coms[joint]];
        const paths = ends.map((to) => [from, joint === 0 ? to : pose.elbows[joint], to]);
        const outline = paths.flatMap((path) =>
          path.slice(1).map((end, at) => capsule(this.project(path[at]), this.project(end), radius * 0.62)),
        );
        solid.body.setAttribute("d", outline.join(""));
        const points = paths.flat();
        solid.depth = points.reduce((sum, point) => sum + this.project(point).depth, 0) / points.length;
      } else {
        const axis = kind === "base" ? this.baseAxis : column(pose.rotations[joint], 2);
        const at = kind === "base" ? this.inspection.robot.base.xyz : pose.joints[joint];
        const half = kind === "base" ? radius * 0.35 : radius * 1.25;
        const wide = kind === "base" ? radius * BASE_DISC : radius;
        const side = unit(cross(axis, Math.abs(axis[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
        const other = cross(axis, side);
        const corners = joint > 0 && this.inspection.isPrismatic(joint) ? 4 : 20;
        const rim = (height) =>
          Array.from({ length: corners }, (_, corner) => {
            const angle = ((corner + 0.5) * 2 * Math.PI) / corners;
            const out = add(times(side, Math.cos(angle) * wide), times(other, Math.sin(angle) * wide));
            return this.project(add(add(at, times(axis, height)), out));
          });
        const [top, bottom] = [rim(half), rim(-half)];
        solid.body.setAttribute("d", polygon(hull([...top, ...bottom])));
        solid.cap.setAttribute("d", polygon(mean(top) > mean(bottom) ? top : bottom));
        // a joint stands out of the links that meet there
        solid.depth = this.project(at).depth + (kind === "base" ? -radius : radius * 1.1);
      }
    }
    const order = [...this.solids].sort((a, b) => a.depth - b.depth);
    if (!this.order || order.some((solid, at) => solid !== this.order[at])) {
      this.groups.solids.append(...order.map((solid) => solid.node));
      this.order = order;
    }
  }

  /** Where a link ends: at the joints and at the tip that it carries; of several tips, at each. */
  endsOf(link, pose) {
    const { inspection } = this;
    const carried = inspection.carriedBy(link).map((end) => pose.joints[end]);
    if (!inspection.floating) return carried;
    const tips = inspection.tips.flatMap(({ on }, tip) => (on === link ? [pose.tips[tip].at] : []));
    // one at the joint is no end
    return [...carried, ...tips].filter((end) => norm(minusV(end, pose.joints[link])) > 1e-9);
  }

  /** A floating base, as the box of its mass and inertia. */
  drawBox(solid, pose) {
    const isBox = solid.kind === "base";
    const corners = pose.box.map((corner) => this.project(corner));
    const middle = pose.coms[0];
    const isSeen = (face) => {
      const centre = times(face.reduce((sum, at) => add(sum, pose.box[at]), [0, 0, 0]), 1 / 4);
      const viewer = add(this.centre, times(this.view.toViewer, this.view.far));
      return dot(minusV(centre, middle), minusV(viewer, centre)) > 0;
    };
    const seen = FACES.map((face, at) => ({ at, path: polygon(face.map((corner) => corners[corner])), isSeen: isSeen(face) })).filter((face) => face.isSeen);
    solid.body.setAttribute("d", isBox ? seen.map((face) => face.path).join("") : "");
    // top or bottom
    solid.cap.setAttribute("d", isBox ? seen.filter((face) => face.at < 2).map((face) => face.path).join("") : "");
    solid.depth = this.project(middle).depth;
  }

  drawMarks(pose) {
    const long = this.size * 0.3;
    const short = this.size * 0.17;
    this.axes.forEach((axis, index) => {
      const [at, z] = [pose.joints[index + 1], column(pose.rotations[index + 1], 2)];
      axis.setAttribute("d", segment(this.project(add(at, times(z, -long))), this.project(add(at, times(z, long)))));
      const com = this.project(pose.coms[index + 1]);
      const node = this.coms[index];
      node.toggleAttribute("hidden", !this.showComs || !(this.inspection.robot.joints[index].mass > 0));
      node.setAttribute("transform", `translate(${round(com.x)} ${round(com.y)})`);
      const label = this.project(at);
      this.labels[index].setAttribute("x", round(label.x));
      this.labels[index].setAttribute("y", round(label.y + 4));
      // joints at one place get one label beside the other
      const before = pose.joints.slice(1, index + 1).filter((other) => {
        const there = this.project(other);
        return Math.hypot(there.x - label.x, there.y - label.y) < 11;
      });
      this.labels[index].setAttribute("dx", 12 * before.length);
    });
    this.triads.forEach((triad, joint) => {
      const isLit = this.litFrame === joint;
      const [origin, turned] = this.frame(pose, joint, isLit);
      // all axes of the base are those of one frame
      const isOfFloating = joint === 0 && Boolean(this.inspection.floating);
      const isTold = isOfFloating || (this.showFrames && (joint === 0 || this.chosen.kind !== "base"));
      triad.forEach((of, which) => {
        const isShown = isTold || isLit;
        of.line.toggleAttribute("hidden", !isShown);
        of.text.toggleAttribute("hidden", !isShown);
        if (!isShown) return;
        const [from, to] = [this.project(origin), this.project(add(origin, times(column(turned, which), short)))];
        const end = this.project(add(origin, times(column(turned, which), short * 1.22)));
        of.line.setAttribute("d", segment(from, to));
        of.text.setAttribute("x", round(end.x));
        of.text.setAttribute("y", round(end.y + 4));
      });
    });
  }

  /** Where axes stand in which the vectors of a link are told, and their directions in the world. */
  frame(pose, link, isLit) {
    const { dof, robot } = this.inspection;
    const turned = this.turnedToWorld(pose, link);
    if (link === 0 || link > dof) return [pose.frames[link].at, turned];
    // a frame of a modified table stands beside its joint's point
    const isOfTable = robot.convention === "modified" && this.chosen.kind === "link" && !isLit;
    return [isOfTable ? pose.frames[link].at : pose.joints[link], turned];
  }

  /** The axes in which the vectors of a link are told, in the world. */
  turnedToWorld(pose, link) {
    const chosen = this.chosen.turn(link);
    return chosen ? product(pose.rotations[link], transposed(chosen)) : pose.rotations[link];
  }

  drawArrows(pose) {
    const largest = {};
    for (const arrow of this.arrows.values()) {
      const layer = LAYER_OF_BASE[arrow.quantity] || arrow.quantity;
      const isShown = this.layers.has(layer) || arrow.isLit;
      arrow.isShown = isShown;
      if (!isShown) continue;
      arrow.numbers = this.vector(arrow);
      if (arrow.numbers) largest[layer] = Math.max(largest[layer] || 0, norm(arrow.numbers));
    }
    // letters that would stand on each other: the lit ones are written, and then the first
    for (const arrow of [...this.arrows.values()].sort(
      (a, b) => Number(Boolean(b.isLit)) - Number(Boolean(a.isLit)),
    )) {
      // a vector that is zero is told where it is pointed at
      const isShown = arrow.isShown && arrow.numbers && (arrow.isLit || norm(arrow.numbers) > 0);
      arrow.node.toggleAttribute("hidden", !isShown);
      if (isShown) this.drawArrow(arrow, pose, largest[LAYER_OF_BASE[arrow.quantity] || arrow.quantity]);
    }
  }

  drawArrow(arrow, pose, largest) {
    const { quantity, joint, of, numbers } = arrow;
    const frame = of.axes === "parent" ? this.inspection.parentOf(joint) : joint;
    const anchor = {
      joint: pose.joints[joint],
      axis: pose.joints[joint],
      com: pose.coms[joint],
      lever: pose.joints[this.inspection.endOf(arrow)],
      position: pose.joints[joint],
    };
    const isLength = KINDS[quantity]?.[0] === "length";
    const start = quantity === "r" ? pose.coms[joint] : anchor[of.drawn];
    const size = norm(numbers);
    // the longest of a quantity has a fixed length, and what is short is still seen
    const drawn = isLength ? size : size > 0 ? this.size * (0.08 + 0.36 * (size / largest)) : 0;
    const along = size > 0 ? times(turn(pose.rotations[frame], numbers), drawn / size) : [0, 0, 0];
    const [from, to] = [this.project(start), this.project(add(start, along))];
    const heads = arrowhead(from, to, arrow.isAxial);
    arrow.hit.setAttribute("d", segment(from, to));
    arrow.shaft.setAttribute("d", heads ? segment(from, heads.neck) : "");
    arrow.head.setAttribute("d", heads ? heads.path : ringAt(from));
    this.words.addLine(from, to, 3);
    arrow.text.removeAttribute("hidden");
    // an arrow that points at the viewer is a ring around the number of the joint
    const beside = heads ? { x: to.x + 8 * heads_x(from, to), y: to.y + 4 + 10 * heads_y(from, to) } : { x: to.x + 13, y: to.y - 8 };
    const place = this.words.inside(arrow.text, beside, to.x < from.x - 2 ? "end" : "start");
    const isInside = to.x >= 0 && to.x <= this.width && to.y >= 0 && to.y <= this.height;
    const isWritten = isInside && (arrow.isLit || this.words.boxes.every((box) => !overlaps(box, place.box)));
    if (!heads) this.rings.push({ text: arrow.text, at: to });
    if (isWritten && (heads || !this.isFlat || !this.showDrawing)) this.words.put(arrow.text, place);
    arrow.text.toggleAttribute("hidden", !isWritten);
    const chosen = of.axes ? this.chosen.turn(frame) : null;
    const told = chosen ? turn(chosen, numbers) : numbers;
    let part = "";
    if (arrow.component !== null && arrow.component !== undefined && size > 0) {
      const alone = [0, 0, 0];
      alone[arrow.component] = (told[arrow.component] * drawn) / size;
      const tip = this.project(add(start, turn(this.turnedToWorld(pose, frame), alone)));
      part = segment(from, tip) + segment(tip, to);
    }
    arrow.part.setAttribute("d", part);
    const unitOf = this.inspection.unitOf(quantity, joint);
    const said = of.drawn === "axis" ? short(told[2]) : told.map(short).join(", ");
    arrow.node.setAttribute("aria-label", `${this.inspection.words(arrow)}, ${joint}: ${said} ${unitText(unitOf)}`);
  }

  /** Lights arrows, joints, links and frames: `what` has sets of their keys and numbers. */
  light({ arrows = [], axis = null, link = null, frame = null, component = null }) {
    for (const arrow of this.arrows.values()) {
      arrow.isLit = false;
      arrow.component = null;
      arrow.node.classList.remove("lit");
    }
    for (const key of arrows) {
      const { quantity, joint, carries } = arrowOfKey(key);
      const arrow = this.arrow(quantity, joint, carries);
      if (!arrow) continue;
      arrow.isLit = true;
      arrow.component = component;
      arrow.node.classList.add("lit");
    }
    this.litFrame = frame;
    this.axes.forEach((node, index) => node.classList.toggle("lit", index + 1 === axis));
    this.coms.forEach((node, index) => node.classList.toggle("lit", index + 1 === link));
    for (const solid of this.solids)
      solid.node.classList.toggle("lit", solid.joint === link && solid.kind === "link" && link > 0);
    this.triads.forEach((triad, joint) => triad.forEach(({ line }) => line.classList.toggle("lit", joint === frame)));
    if (this.pose) {
      this.drawMarks(this.pose);
      this.drawVectors(this.pose, this.q);
    }
  }

  turnBy(yaw, pitch) {
    const limit = Math.PI / 2 - 0.02;
    this.look = {
      ...this.look,
      yaw: this.look.yaw + yaw,
      pitch: Math.max(-limit, Math.min(limit, this.look.pitch + pitch)),
    };
    this.changed();
  }

  zoomBy(factor) {
    this.look = { ...this.look, zoom: Math.max(0.4, Math.min(6, this.look.zoom * factor)) };
    this.changed();
  }

  reset() {
    this.look = this.home;
    this.figure = null;
    this.changed();
  }

  /** Replaced by the page. */
  changed() {}
}
