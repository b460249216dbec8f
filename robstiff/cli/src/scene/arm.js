// The arm: forward kinematics from the table of Denavit and Hartenberg, and the
// compliance of its joints. Lengths in m, angles in rad.

const add = (a, b, t = 1) => a.map((x, k) => x + t * b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const norm = (a) => Math.hypot(...a);
const unit = (a) => { const n = norm(a) || 1; return a.map((x) => x / n); };
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Frames are the first three rows of a 4 x 4 matrix, one after the other.
const origin = (m) => [m[3], m[7], m[11]];
const axis = (m, k) => [m[k], m[4 + k], m[8 + k]];

function times(a, b) {
  const c = [];
  for (let i = 0; i < 12; i += 4) {
    for (let j = 0; j < 4; j++) {
      c.push(a[i] * b[j] + a[i + 1] * b[4 + j] + a[i + 2] * b[8 + j] + (j === 3 ? a[i + 3] : 0));
    }
  }
  return c;
}

const aboutZ = (t, d) => [Math.cos(t), -Math.sin(t), 0, 0, Math.sin(t), Math.cos(t), 0, 0, 0, 0, 1, d];
const aboutX = (t, a) => [1, 0, 0, a, 0, Math.cos(t), -Math.sin(t), 0, 0, Math.sin(t), Math.cos(t), 0];

// The joints, each with the point `from` where its axis begins, the point `to`
// where the offset along it ends and the axis itself; then flange and TCP.
function standing(robot, q) {
  const standard = robot.convention === "standard";
  let frame = robot.base;
  const joints = robot.joints.map((joint, k) => {
    const turn = aboutZ(joint.theta + (joint.slides ? 0 : q[k]), joint.d + (joint.slides ? q[k] : 0));
    const link = aboutX(joint.alpha, joint.a);
    const start = standard ? frame : times(frame, link);
    const end = times(start, turn);
    frame = standard ? times(end, link) : end;
    return { from: origin(start), to: origin(end), axis: axis(start, 2), slides: joint.slides };
  });
  return { joints, flange: frame, tcp: times(frame, robot.tool) };
}

// The translational compliance that the joints give, xx yy zz xy xz yz [um/N]:
// the sum of h v v^T over the columns v of the Jacobian.
function jointCompliance(robot, arm) {
  const h = [0, 0, 0, 0, 0, 0];
  const tip = origin(arm.tcp);
  arm.joints.forEach((joint, k) => {
    const v = joint.slides ? joint.axis : cross(joint.axis, add(tip, joint.from, -1));
    const c = robot.joints[k].compliance * 1e6;
    [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]].forEach(([i, j], n) => { h[n] += c * v[i] * v[j]; });
  });
  return h;
}

const rows = ([xx, yy, zz, xy, xz, yz]) => [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
const displaced = (h, force) => rows(h).map((row) => dot(row, force));

// Principal values and directions, the largest first: rotations of Jacobi.
function principal(h) {
  const a = rows(h);
  let v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const size = norm(a.flat());
  for (let sweep = 0; sweep < 30; sweep++) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (Math.abs(a[p][q]) <= 1e-15 * size) continue;
      const w = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (w < 0 ? -1 : 1) / (Math.abs(w) + Math.hypot(w, 1));
      const c = 1 / Math.hypot(t, 1), s = t * c;
      for (let k = 0; k < 3; k++) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
      for (let k = 0; k < 3; k++) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
      v = v.map((row) => { const r = [...row]; r[p] = c * row[p] - s * row[q]; r[q] = s * row[p] + c * row[q]; return r; });
    }
  }
  const found = [0, 1, 2].map((k) => ({ value: Math.max(a[k][k], 0), axis: v.map((row) => row[k]) }));
  return found.sort((one, other) => other.value - one.value);
}
