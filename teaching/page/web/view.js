// What a reader has chosen, as data: a page of the same arm with other numbers can be looked at in the same way.

const kindsOf = (page) => page.inspection.robot.joints.map((joint) => joint.kind).join(" ");

/** What a page shows and how. */
function viewOf(page) {
  return structuredClone({
    kinds: kindsOf(page),
    state: page.state,
    wrench: page.wrench,
    from: page.from,
    to: page.to,
    duration: byId("duration").value,
    time: byId("time").value,
    plot: page.plot.joint,
    form: page.form,
    language: page.language,
    axes: page.axes.kind,
    exercise: page.exercise.isOn,
    lecture: page.isLecture,
    theme: document.documentElement.dataset.theme || "auto",
    cell: [page.cell.joint, page.cell.step],
    layers: [...page.arm.layers],
    frames: page.arm.showFrames,
    masses: page.arm.showComs,
    look: page.arm.look,
    pinned: page.reading.pinned?.name || null,
    tip: document.querySelector(".tip-force").open,
    scrolled: [window.scrollX, window.scrollY, byId("cell").scrollTop],
  });
}

/** Shows a page as another one was: the switches, and of an arm with the same joints everything else. */
function showView(page, view) {
  const press = (button, isOn = true) => {
    if (!button.disabled && (button.getAttribute("aria-pressed") === "true") !== isOn) button.click();
  };
  for (const name of [view.form, view.language, view.axes, view.exercise ? "exercise" : "shown", view.theme])
    press(document.querySelector(`[data-switch="${name}"]`));
  if (view.lecture !== undefined) page.setLecture(view.lecture);
  for (const name of ["frames", "masses"]) press(document.querySelector(`[data-shows="${name}"]`), view[name]);
  if (view.kinds !== kindsOf(page)) return;
  const cell = page.inspection.cell(...view.cell);
  if (cell) page.open(cell);
  page.tip.show({ ...page.inspection.freeTips(), ...view.wrench });
  document.querySelector(".tip-force").open = view.tip;
  Object.assign(page, { from: view.from, to: view.to });
  byId("duration").value = view.duration;
  page.plotJoint(view.plot);
  page.retime();
  byId("time").value = view.time;
  page.plot.point(Number(view.time) * page.trajectory.seconds);
  page.arm.layers = new Set(view.layers.filter((quantity) => page.layerButtons.has(quantity)));
  page.paintLayers();
  page.arm.look = view.look;
  page.setState(view.state);
  if (view.pinned) page.reading.select(view.pinned);
  window.scrollTo(view.scrolled[0], view.scrolled[1]);
  byId("cell").scrollTop = view.scrolled[2];
}
