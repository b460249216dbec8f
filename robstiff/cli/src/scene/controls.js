// Mouse, fingers, keys, sliders and what they read.

const people = (k, q) => (data.joints[k].slides ? q * 1e3 : (q * 180) / Math.PI);
// A zero has no sign.
const fixed = (x, digits) => x.toFixed(digits).replace(/^-(?=[0.]+$)/, "");
const unitOf = (k) => (data.joints[k].slides ? "mm" : "deg");

function say() {
  const pose = shown();
  const list = (values, digits) => values.map((x) => fixed(x, digits)).join(", ");
  const said = [];
  if (data.poses.length > 1) {
    const name = pose.given ? data.poses[state.row].name ?? String(data.poses[state.row].row) : "moved by hand";
    said.push([data.kind === "path" ? "Row" : "Pose", name]);
  }
  said.push(["Joints", pose.q.map((q, k) => `${fixed(people(k, q), 2)} ${unitOf(k)}`).join(", ")]);
  said.push(["Tool at", `(${list(pose.tcp.map((x) => x * 1e3), 1)}) mm`]);
  const part = pose.given || !data.effects.length ? "" : " (of the joints alone)";
  said.push([`Compliance${part}`, `${principal(pose.compliance).map(({ value }) => shortest(value)).join(", ")} µm/N along its axes`]);
  if (pose.displacement) {
    said.push(["Displacement", `(${list(pose.displacement, 1)}) µm, ${shortest(norm(pose.displacement))} µm in all`]);
  }
  if (pose.off) said.push(["Off", `(${list(pose.off, 1)}) µm`]);
  if (pose.measured) said.push(["Measured", `(${list(pose.measured, 1)}) µm, ${shortest(norm(pose.measured))} µm in all`]);
  if (pose.given && pose.value != null && data.value && data.kind !== "pose") {
    said.push([data.value.name, `${shortest(pose.value)} ${data.value.unit === "um" ? "µm" : data.value.unit}`]);
  }
  const readout = find("readout");
  readout.replaceChildren(...said.flatMap(([name, value]) => ["dt", "dd"].map((tag, k) => {
    const element = document.createElement(tag);
    element.textContent = k ? value : name;
    return element;
  })));
  pose.q.forEach((q, k) => {
    const slider = find(`q${k + 1}`);
    if (document.activeElement !== slider || pose.given) slider.value = people(k, q);
    slider.nextElementSibling.textContent = fixed(people(k, q), 1);
  });
  find("moved").textContent = pose.given ? "" : data.effects.length
    ? "Moved by hand: the ellipsoid is that of the joints alone, without the effects of the description."
    : "Moved by hand: the ellipsoid follows from the joints.";
}

function update() {
  redraw();
  say();
}

function show(row) {
  state.row = Math.max(0, Math.min(data.poses.length - 1, row));
  state.moved = null;
  const slider = find("row");
  if (slider) {
    slider.value = state.row;
    slider.setAttribute("aria-valuetext", data.poses[state.row].name ?? `row ${data.poses[state.row].row}`);
  }
  update();
}

// Fingers and mouse: one turns, two zoom.
const fingers = new Map();
canvas.addEventListener("pointerdown", (event) => {
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  try { canvas.setPointerCapture(event.pointerId); } catch { /* one that was made by a script */ }
});
canvas.addEventListener("pointermove", (event) => {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY];
  if (fingers.size === 2) {
    const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    const apart = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
    eye.zoomBy(apart(before) / apart(now));
  } else {
    eye.turnBy((now[0] - before[0]) * 0.008, (now[1] - before[1]) * 0.008);
  }
  fingers.set(event.pointerId, now);
  redraw();
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  eye.zoomBy(Math.exp(event.deltaY * 0.001));
  redraw();
}, { passive: false });

canvas.addEventListener("keydown", (event) => {
  const step = 0.09;
  const moves = {
    ArrowLeft: () => eye.turnBy(-step, 0), ArrowRight: () => eye.turnBy(step, 0),
    ArrowUp: () => eye.turnBy(0, step), ArrowDown: () => eye.turnBy(0, -step),
    "+": () => eye.zoomBy(0.9), "=": () => eye.zoomBy(0.9), "-": () => eye.zoomBy(1 / 0.9), 0: () => eye.reset(),
  };
  if (!moves[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  moves[event.key]();
  redraw();
});

find("row")?.addEventListener("input", (event) => show(Number(event.target.value)));
find("play")?.addEventListener("click", () => {
  state.playing = !state.playing;
  find("play").textContent = state.playing ? "Stop" : "Play";
  if (state.playing && state.row === data.poses.length - 1) show(0);
  let last = performance.now(), exact = state.row;
  // A whole path in ten seconds, whatever its length.
  const step = (now) => {
    if (!state.playing) return;
    exact += ((now - last) / 1e4) * data.poses.length;
    last = now;
    show(Math.floor(exact));
    if (exact < data.poses.length - 1) requestAnimationFrame(step);
    else { state.playing = false; find("play").textContent = "Play"; }
  };
  requestAnimationFrame(step);
});
data.joints.forEach((joint, k) => {
  const slider = find(`q${k + 1}`);
  const given = data.poses.map((pose) => pose.q[k]);
  const [low, high] = joint.limits ?? (joint.slides ? [0, reach] : [-Math.PI, Math.PI]);
  slider.min = people(k, Math.min(low, ...given));
  slider.max = people(k, Math.max(high, ...given));
  slider.addEventListener("input", () => {
    state.moved = [...shown().q];
    state.moved[k] = Number(slider.value) * (joint.slides ? 1e-3 : Math.PI / 180);
    update();
  });
});
find("back").addEventListener("click", () => show(state.row));

function saySizes() {
  const floor = state.near ? `the path ${shortest(extent * 1e3)} mm from corner to corner` : `a square of the floor ${shortest(square * 1e3)} mm`;
  find("ellipsoid-scale").textContent = perUnit > 0 ? `1 µm/N is ${shortest(perUnit * 1e3)} mm, ${floor}.` : "The robot is rigid.";
  const arrows = find("arrow-scale");
  if (arrows && perMicrometre > 0) arrows.textContent = `${shortest(perMicrometre * 1e6)} times as long as it is.`;
}
saySizes();
find("near")?.addEventListener("click", () => {
  lookAt(!state.near);
  find("near").setAttribute("aria-pressed", state.near);
  find("near").textContent = state.near ? "Look at the arm again" : "Look at the path alone";
  saySizes();
  redraw();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { colours.read(); redraw(); });
new ResizeObserver(redraw).observe(canvas);
colours.read();
// The worst pose first.
const worst = data.poses.reduce((most, pose, k) => (Math.abs(pose.value ?? 0) > Math.abs(data.poses[most].value ?? 0) ? k : most), 0);
show(worst);
draw();
