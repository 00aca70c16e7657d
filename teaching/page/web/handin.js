// What a student hands in: the state and the answers as a worksheet, which `rne mark` reads, and the score.

/** Names that worksheets have for quantities, where they are others than those of the page. */
const WORKSHEET_NAMES = { child_force: "next_force", child_moment: "next_moment", torque: "tau", position: "q", rate: "qd", rate_dot: "qdd" };

/** The quantities of a worksheet that the seven steps find. */
const WORKSHEET_QUANTITIES = [
  "omega", "omega_dot", "velocity", "acceleration", "gravity", "inertia_force", "inertia_moment", "next_force",
  "next_moment", "joint_force", "joint_moment", "tau",
];

/** The text to hand in: a worksheet in CSV with the score in its comments. */
function worksheetOf(page, student) {
  const { robot } = page.inspection;
  const name = student.replaceAll(/[,;"\n\r]/g, " ").trim();
  const { exercise } = page;
  // only the cells with an answer are marked
  const { cells: all } = page.inspection;
  const cells = all.filter((cell) => cell.joint > 0 && cell.components.some((of) => exercise.answers.has(of.name)));
  const asked = cells.length ? `, cells ${cells.map(({ joint, step }) => `${joint}.${step}`).join(" ")}` : "";
  const lines = [`# rne worksheet, format 1, robot ${robot.name}${asked}${name ? `, student ${name}` : ""}`];
  lines.push(`# ${exercise.score()}`);
  const { base } = page.state;
  // a worksheet is that of a base at rest
  if (base) lines.push(`# base: ${Object.entries(base).map(([of, vector]) => `${of} ${vector.join(" ")}`).join(", ")}`);
  lines.push("joint,step,quantity,component,value,unit,frame");
  robot.joints.forEach((joint, index) => {
    const slides = joint.kind === "prismatic";
    const units = slides ? ["m", "m/s", "m/s²"] : ["rad", "rad/s", "rad/s²"];
    OF.forEach((of, at) => lines.push(`${index + 1},0,${of},,${page.state[of][index]},${units[at]},`));
  });
  const others = [];
  for (const [of, { text, isRight, tries }] of exercise.answers) {
    const meaning = page.inspection.meaning(of);
    const quantity = WORKSHEET_NAMES[meaning.quantity] || meaning.quantity;
    if (!WORKSHEET_QUANTITIES.includes(quantity) || meaning.joint === 0) {
      others.push(`# ${of}: ${text}, ${isRight ? "right" : "wrong"}, attempts: ${tries}`);
      continue;
    }
    const cell = page.inspection.owner(of).cell;
    const frame = quantity === "tau" ? "" : page.axes.kind;
    const component = quantity === "tau" ? "" : meaning.component;
    lines.push(`${meaning.joint},${cell.step},${quantity},${component},${numberOf(text)},${page.inspection.unit(of)},${frame}`);
  }
  return `${[...lines, ...others].join("\n")}\n`;
}

/** The panel of an exercise: the score, the student's name, and the text. */
class HandIn {
  constructor(page) {
    this.page = page;
    byId("hand-in").addEventListener("toggle", () => this.show());
    byId("student").addEventListener("input", () => this.show());
    byId("copy-answers").addEventListener("click", () => copied(byId("answers").value, byId("answers")));
  }

  show() {
    byId("score").textContent = this.page.exercise.score();
    byId("mark-base").hidden = !this.page.inspection.floating;
    if (byId("hand-in").open) byId("answers").value = worksheetOf(this.page, byId("student").value);
  }
}

/** Copies a text, or selects it where the browser does not let a page copy. */
async function copied(text, field = null) {
  try {
    await navigator.clipboard.writeText(text);
    byId("said").textContent = "copied";
    return true;
  } catch {
    field?.select();
    return false;
  }
}
