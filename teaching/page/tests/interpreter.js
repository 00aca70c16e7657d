// Run by interpreter.rs behind the page's own scripts: reads questions, prints answers, numbers as text.
"use strict";
const fs = require("fs");
const text = (list) => list.map((value) => String(value));
// ω, ω̇, ċ, c̈, g, f and n of joint i and the link h that carries it
const VECTORS = ["wi", "dwi", "dci", "ddci", "gi", "fh_i", "nh_i"];
const said = JSON.parse(fs.readFileSync(process.argv[2], "utf8")).map(({ data, states }) => {
  const inspection = new Inspection(data);
  const [folded, withWrench] = [data.programs.folded, data.programs.with_wrench].map((record) => new Program(record));
  const reduced = data.programs.reduced ? new Program(data.programs.reduced) : null;
  const equations = new Equations(inspection.components);
  const torques = new Torques(inspection, folded, withWrench);
  const [sine, cosine] = [Math.sin, Math.cos];
  const { coordinates } = inspection;
  const answers = states.map(({ state: given, wrench, turns }) => {
    const ofJoints = Object.entries(given).map(([of, numbers]) => [of, inspection.ofJoints(numbers)]);
    const state = inspection.follow(Object.fromEntries(ofJoints));
    const ofCoordinates = (numbers) => text(coordinates.map((joint) => numbers[joint]));
    // sine and cosine of the runtime: then everything else has to be the same bits
    const known = new Map(turns.map(([angle, s, c]) => [angle, [s, c]]));
    const runtime = (angle, which) => (known.has(angle) ? known.get(angle)[which] : NaN);
    Math.sin = (angle) => runtime(angle, 0);
    Math.cos = (angle) => runtime(angle, 1);
    const { free, total, gravity } = torques.split(state, wrench);
    Math.sin = sine;
    Math.cos = cosine;
    equations.set(inspection.argumentsOf(state));
    const pose = new Pose(inspection, (name) => equations.value(name), state.q);
    const chosen = new ChosenAxes(inspection, (name) => equations.value(name), () => state.q);
    const links = inspection.robot.joints.map((_, index) => {
      const joint = index + 1;
      const names = VECTORS.map((stem) =>
        AXES.map((axis) => `${stem.replace("i", joint).replace("h", inspection.parentOf(joint))}_${axis}`),
      );
      const vectors = names.map((vector) => vector.map((name) => equations.value(name)));
      const inWorld = vectors.map((vector) => turn(pose.rotations[joint], vector));
      const [lecture, base] = ["joint", "base"].map((kind) => names.flat().map((of) => chosen.component(of, kind)));
      return {
        world: text(inWorld.flat()),
        lecture: text(lecture),
        base: text(base),
        com: text(pose.coms[joint]),
        next: text(pose.joints[inspection.endOf({ joint })]),
      };
    });
    return {
      links,
      free: ofCoordinates(free),
      total: ofCoordinates(total),
      gravity: ofCoordinates(gravity),
      own: text(folded.run(inspection.argumentsOf(state))),
      reduced: reduced ? text(reduced.run(inspection.argumentsOf(state))) : null,
      equations: text(coordinates.map((joint) => equations.value(`tau${joint + 1}`))),
    };
  });
  // slips of the first steps, typed with six digits
  const exercise = new Exercise(inspection, equations);
  const component = [...inspection.components.values()].find(
    (of) => /^ddc\d+_x$/.test(of.name) && of.became.kind === "computed",
  );
  const slips = component
    ? exercise
        .slips(component.name)
        .map((slip) => [
          slip.text,
          exercise.answer(component.name, slip.value.toPrecision(6)).text,
          String(slip.value),
        ])
    : [];
  const right = component
    ? exercise.answer(component.name, equations.value(component.name).toPrecision(6)).text
    : "Right.";
  return {
    answers,
    slips,
    right,
    value: component ? String(equations.value(component.name)) : "0",
    rust: ["folded", "reduced"].map((of) => data.programs[of].statements.map(({ name, value }) => `let ${name} = ${codeOf(value)};`)),
    c: data.programs.folded.statements.map(({ name, value }) => `const double ${name} = ${codeOf(value, true)};`),
  };
});
console.log(JSON.stringify(said));
