// The scene and what moves it.

const data = JSON.parse(document.getElementById("data").textContent);
const canvas = document.getElementById("scene");
const find = (id) => document.getElementById(id);
document.documentElement.classList.add("scripted");

// What is shown: a given pose, or joints that were moved by hand.
const state = { row: 0, moved: null, playing: false, near: false };
const shortest = (x) => String(Number(x.toPrecision(4)));
const round = (x) => { const p = 10 ** Math.floor(Math.log10(x)); return [5, 2, 1].find((m) => m * p <= x * 1.0001) * p; };

const colours = {
  read() {
    const style = getComputedStyle(document.documentElement);
    this.css = (name) => `rgb(${style.getPropertyValue(`--${name}`)})`;
    this.rgb = (name) => style.getPropertyValue(`--${name}`).trim().split(/\s+/).map(Number);
  },
};

// Sizes that hold for all poses.
const first = standing(data, data.poses[0].q);
const corners = (arm) => [...arm.joints.flatMap((joint) => [joint.from, joint.to]), origin(arm.flange), origin(arm.tcp)];
const skeleton = corners(first);
const reach = Math.max(1e-3, skeleton.slice(1).reduce((sum, p, k) => sum + norm(add(p, skeleton[k], -1)), 0));
const softest = Math.max(...data.poses.map((pose) => principal(pose.compliance)[0].value));
const farthest = Math.max(0, ...data.poses.flatMap((p) => [p.displacement, p.measured, p.off].filter(Boolean).map(norm)));
const everything = [[0, 0, 0], ...skeleton, ...data.poses.map((pose) => pose.tcp)];
const ends = [0, 1, 2].map((k) => [Math.min(...everything.map((p) => p[k])), Math.max(...everything.map((p) => p[k]))]);
const square = round(reach / 5);
const floor = ends.slice(0, 2).map(([low, high]) => [Math.floor(low / square - 0.3), Math.ceil(high / square + 0.3)]);
// The path alone: a pocket is small beside the arm that mills it.
const box = [0, 1, 2].map((k) => [Math.min(...data.poses.map((p) => p.tcp[k])), Math.max(...data.poses.map((p) => p.tcp[k]))]);
const extent = Math.max(1e-3, norm(box.map(([low, high]) => high - low)));
// What the picture is as large as, and how large ellipsoids and arrows are drawn.
let large, perUnit, perMicrometre;
function measure() {
  large = state.near ? extent : reach;
  // No ellipsoid is longer than the path.
  const longest = Math.min(large / 6.5, data.kind === "path" && extent > 1e-3 ? extent / 2 : Infinity);
  perUnit = softest > 0 ? round(longest / softest) : 0;
  perMicrometre = farthest > 0 ? round((large / 7 / farthest) * 1e6) / 1e6 : 0;
}
measure();
const eye = new Eye(ends.map(([low, high]) => (low + high) / 2), 3 * norm(ends.map(([low, high]) => high - low)));

// From the arm to the path alone, or back.
function lookAt(near) {
  state.near = near;
  measure();
  const seen = near ? box : ends;
  eye.home.centre = seen.map(([low, high]) => (low + high) / 2);
  eye.home.distance = 3 * norm(seen.map(([low, high]) => high - low)) || 3 * large;
  eye.reset();
}

// What is to be seen in the beginning.
function toFit() {
  if (state.near) return [corner(), ...data.poses.flatMap(({ tcp }) => [-0.1, 0.1].map((side) => [tcp[0], tcp[1], tcp[2] + side * large]))];
  const fitted = floor[0].flatMap((x) => floor[1].map((y) => [x * square, y * square, 0]));
  const worst = standing(data, data.poses[state.row].q);
  for (const p of [...corners(worst), ...data.poses.map((pose) => pose.tcp)]) {
    for (const side of [-0.05, 0.05]) fitted.push([p[0], p[1], p[2] + side * reach]);
  }
  const { tcp } = data.poses[state.row];
  semiAxes(data.poses[state.row]).forEach(({ axis, length }) => fitted.push(add(tcp, axis, length), add(tcp, axis, -length)));
  return fitted;
}

// Errors have signs: what is far from zero is bad either way.
const sizes = data.value ? [data.value.least, data.value.most].map(Math.abs) : [0, 0];
const [small, great] = [data.value && data.value.least * data.value.most < 0 ? 0 : Math.min(...sizes), Math.max(...sizes)];
const bad = (value) => (Math.abs(value ?? small) - small) / (great - small || 1);
const shade = (value) => Math.max(0, Math.min(9, Math.round(9 * bad(value))));

function shown() {
  const pose = data.poses[state.row];
  if (!state.moved) return { ...pose, given: true };
  const arm = standing(data, state.moved);
  const compliance = jointCompliance(data, arm);
  const displacement = data.force && displaced(compliance, data.force);
  return { q: state.moved, tcp: origin(arm.tcp), compliance, displacement, given: false };
}

function drawFloor(picture, arm) {
  const [[x1, x2], [y1, y2]] = floor;
  const grid = colours.css("grid");
  for (let x = x1; x <= x2; x++) picture.over([[x * square, y1 * square, 0], [x * square, y2 * square, 0]], grid, 1);
  for (let y = y1; y <= y2; y++) picture.over([[x1 * square, y * square, 0], [x2 * square, y * square, 0]], grid, 1);
  const points = corners(arm).map(([x, y]) => [x, y, 0]);
  picture.context.lineJoin = picture.context.lineCap = "round";
  const at = eye.at([0, 0, 0]), beside = eye.at(add([0, 0, 0], eye.right, 0.035 * reach));
  picture.over(points, colours.css("shadow"), 2 * Math.hypot(beside[0] - at[0], beside[1] - at[1]));
  ["x", "y"].forEach((name, k) => {
    const end = [0, 0, 0];
    end[k] = square;
    picture.arrow([0, 0, 0], end, colours.css("soft"), 1.5);
    picture.word(name, end.map((c) => 1.15 * c));
  });
}

// The base frame's directions, beside the path.
const corner = () => box.map(([low]) => low - 0.12 * large);
function drawDirections(picture) {
  const from = corner();
  ["x", "y", "z"].forEach((name, k) => {
    const end = [...from];
    end[k] += 0.12 * large;
    picture.arrow(from, end, colours.css("soft"), 1.5);
    picture.word(name, add(from, add(end, from, -1), 1.25));
  });
}

// How thick the arm is at a joint, and where on its axis the joint is drawn:
// where an offset follows, some way along it.
const thick = (k) => reach * (0.045 - (0.027 * k) / data.joints.length);
function seat(joint, k) {
  const offset = add(joint.to, joint.from, -1);
  return norm(offset) > 3.2 * thick(k) ? add(joint.from, offset, 0.3) : joint.from;
}

function drawArm(picture, arm) {
  const count = arm.joints.length;
  const [link, joint] = [colours.rgb("link"), colours.rgb("joint")];
  const foot = arm.joints[0].from;
  const up = add([0, 0, 0], arm.joints[0].axis, Math.sign(arm.joints[0].axis[2]) || 1);
  picture.tube(add(foot, up, -0.002 * reach), add(foot, up, 0.018 * reach), thick(-1) * 1.7, thick(-1) * 1.6, joint, { sides: 32 });
  arm.joints.forEach((here, k) => {
    const next = k + 1 < count ? arm.joints[k + 1].from : origin(arm.flange);
    const [wide, narrow] = [0.82 * thick(k), 0.82 * thick(k + 1)];
    const [one, other] = [norm(add(here.to, here.from, -1)), norm(add(next, here.to, -1))];
    const between = wide + ((narrow - wide) * one) / (one + other || 1);
    picture.tube(here.from, here.to, wide, between, link);
    picture.tube(here.to, next, between, narrow, link);
    const [at, half] = [seat(here, k), 1.05 * thick(k)];
    picture.tube(add(at, here.axis, -half), add(at, here.axis, half), 1.12 * thick(k), 1.12 * thick(k), joint, {
      // Over the links that end in it.
      sides: here.slides ? 4 : 28, nearer: 0.4 * thick(k),
    });
  });
  const [flange, tcp] = [origin(arm.flange), origin(arm.tcp)];
  const tool = colours.rgb("tool"), length = norm(add(tcp, flange, -1));
  if (length > 1e-6) {
    const neck = add(flange, add(tcp, flange, -1), 0.7);
    picture.tube(flange, neck, 0.75 * thick(count), 0.6 * thick(count), tool);
    picture.tube(neck, tcp, 0.22 * thick(count), 0.16 * thick(count), tool);
  }
}

function drawPath(picture) {
  if (data.kind === "path") {
    const width = (...poses) => 2.5 + 3.2 * Math.max(...poses.map(({ value }) => bad(value)));
    for (let k = 1; k < data.poses.length; k++) {
      const [one, other] = [data.poses[k - 1], data.poses[k]];
      const n = data.value ? Math.max(shade(one.value), shade(other.value)) : 0;
      const points = [one.tcp, other.tcp];
      if (other.rapid) {
        picture.line(points, colours.css("soft"), 0.8);
        continue;
      }
      // Behind the neighbours' own colour.
      picture.line(points, colours.css("edge"), width(one, other) + 2.5, -0.03 * large);
      picture.line(points, colours.css(data.value ? `shade${n}` : "ink"), width(one, other), 0.01 * large);
    }
  }
  if (data.kind === "campaign") {
    for (const pose of data.poses) {
      const n = data.value ? shade(pose.value) : 0;
      const points = [pose.tcp, add(pose.tcp, eye.right, 1e-5 * reach)];
      picture.line(points, colours.css("edge"), 10 + n / 2);
      picture.line(points, colours.css(`shade${n}`), 7 + n / 2, 1e-4 * reach);
    }
  }
}

function semiAxes(pose) {
  return principal(pose.compliance).map(({ value, axis }) => ({ axis, value, length: value * perUnit }));
}

function drawEllipsoids(picture, pose) {
  const stride = Math.ceil(data.poses.length / 12);
  if (!state.moved && data.poses.length > 1) {
    // Those that are clear of one another; the others would only hide the path.
    const longest = (of) => semiAxes(of)[0].length;
    const drawn = [pose];
    data.poses.filter((other, k) => k % stride === 0 && k !== state.row && !other.rapid).forEach((other) => {
      const clear = (one) => norm(add(one.tcp, other.tcp, -1)) > 0.35 * (longest(one) + longest(other));
      if (data.kind === "path" && !drawn.every(clear)) return;
      drawn.push(other);
      picture.ellipsoid(other.tcp, semiAxes(other), colours.rgb("ellipsoid"), 0.16, 8);
    });
  }
  picture.ellipsoid(pose.tcp, semiAxes(pose), colours.rgb("ellipsoid"), 0.42);
}

function drawAxes(picture, pose) {
  const axes = semiAxes(pose);
  axes.forEach(({ axis, length }) => {
    picture.over([add(pose.tcp, axis, -length), add(pose.tcp, axis, length)], colours.css("ellipsoid-ink"), 1.6);
  });
  // Words of axes too short to tell apart would hide each other.
  axes.filter(({ length }) => length > 0.02 * large).forEach(({ axis, length, value }) => {
    const end = add(pose.tcp, axis, dot(axis, eye.up) < 0 ? -length : length);
    picture.word(`${shortest(value)} µm/N`, end, [[0, -12], [44, 0], [-44, 0], [44, -20], [-44, -20]]);
  });
}

function drawDisplacement(picture, pose) {
  const end = (d) => add(pose.tcp, d, perMicrometre);
  for (const other of data.kind === "campaign" && !state.moved ? data.poses : []) {
    if (other.measured) picture.over([other.tcp, add(other.tcp, other.measured, perMicrometre)], colours.css("arrow"), 1.1, [3, 3]);
    picture.over([other.tcp, add(other.tcp, other.displacement ?? other.off, perMicrometre)], colours.css("arrow"), 1.3);
  }
  if (pose.measured) picture.arrow(pose.tcp, end(pose.measured), colours.css("arrow"), 2, [5, 4]);
  const moved = pose.displacement ?? pose.off;
  if (moved) {
    picture.arrow(pose.tcp, end(moved), colours.css("arrow"), 3);
    picture.word(`${shortest(norm(moved))} µm`, end(moved), [[0, 16], [0, -16], [44, 0], [-44, 0], [52, 24]], 13);
  }
}

function draw() {
  const ratio = window.devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
  if (!width || !height) return;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  eye.look(width, height, toFit());
  const picture = new Picture(context, eye, colours);
  const pose = shown(), arm = standing(data, pose.q);
  if (state.near) {
    drawDirections(picture);
  } else {
    drawFloor(picture, arm);
    drawArm(picture, arm);
  }
  drawPath(picture);
  drawEllipsoids(picture, pose);
  picture.flush();
  drawAxes(picture, pose);
  drawDisplacement(picture, pose);
  if (state.near) return;
  arm.joints.forEach((joint, k) => picture.word(String(k + 1), seat(joint, k), [[0, 0], [13, 0], [-13, 0], [0, -15]], 11));
}

let waiting = 0;
function redraw() {
  if (!waiting) waiting = requestAnimationFrame(() => { waiting = 0; draw(); });
}
