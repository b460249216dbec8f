// What is drawn: flat faces, lines and words, the farthest first.

// An eye that looks at a point from all around.
class Eye {
  constructor(centre, distance) {
    this.home = { turn: -0.9, height: 0.34, distance, centre, shift: [0, 0] };
    this.reset();
  }
  reset() {
    Object.assign(this, this.home);
    this.fitted = false;
  }
  turnBy(right, up) {
    this.turn -= right;
    // From above the floor, which is drawn first.
    this.height = Math.min(1.55, Math.max(0.02, this.height + up));
  }
  zoomBy(factor) {
    const least = 0.2 * this.home.distance;
    this.distance = Math.min(5 * this.home.distance, Math.max(least, this.distance * factor));
  }
  // Before a picture of that size [px]; the first time so that the points fill
  // it but for a margin.
  look(width, height, points) {
    const [s, c, t, l] = [Math.sin(this.turn), Math.cos(this.turn), Math.sin(this.height), Math.cos(this.height)];
    this.right = [-s, c, 0];
    this.up = [-c * t, -s * t, l];
    this.back = [c * l, s * l, t];
    this.middle = [width / 2, height / 2];
    this.scale = 2 * height;
    for (let k = 0; k < 8 && !this.fitted; k++) {
      const seen = points.map((p) => this.at(p));
      const ends = [0, 1].map((i) => [Math.min(...seen.map((p) => p[i])), Math.max(...seen.map((p) => p[i]))]);
      const [wide, high] = ends.map(([low, up]) => up - low);
      this.shift = this.shift.map((x, i) => x + (this.middle[i] - (ends[i][0] + ends[i][1]) / 2) / height);
      this.distance *= Math.max(wide / (0.86 * width), high / (0.86 * height)) || 1;
    }
    this.fitted = true;
  }
  depth(p) { return this.distance - dot(add(p, this.centre, -1), this.back); }
  at(p) {
    const r = add(p, this.centre, -1), size = this.scale / 2;
    const scale = this.scale / Math.max(1e-6, this.distance - dot(r, this.back));
    const [x, y] = this.middle.map((m, i) => m + size * this.shift[i]);
    return [x + scale * dot(r, this.right), y - scale * dot(r, this.up)];
  }
}

class Picture {
  constructor(context, eye, colours) {
    Object.assign(this, { context, eye, colours, shapes: [], words: [] });
  }

  // A face that is lit from the upper left behind the eye; what turns away is
  // not seen.
  face(points, normal, colour, alpha = 1, nearer = 0) {
    const middle = points.reduce((sum, p) => add(sum, p, 1 / points.length), [0, 0, 0]);
    const { eye } = this;
    const towards = add(add(eye.centre, eye.back, eye.distance), middle, -1);
    if (dot(normal, towards) <= 0) return;
    const light = unit(add(add(eye.back, eye.up, 0.9), eye.right, -0.6));
    const lit = 0.5 + 0.5 * Math.max(0, dot(normal, light));
    const style = `rgb(${colour.map((c) => Math.round(c * lit)).join(" ")} / ${alpha})`;
    this.shapes.push({ depth: eye.depth(middle) - nearer, points: points.map((p) => eye.at(p)), fill: style, alpha });
  }

  line(points, colour, width, nearer = 0) {
    const middle = add(points[0], points[points.length - 1]).map((x) => x / 2);
    this.shapes.push({
      depth: this.eye.depth(middle) - nearer, points: points.map((p) => this.eye.at(p)), stroke: colour, width,
    });
  }

  // A tube or cone, closed at both ends, in rings short enough to be sorted.
  tube(a, b, ra, rb, colour, { sides = 28, nearer = 0 } = {}) {
    const along = add(b, a, -1), length = norm(along);
    if (length < 1e-6) return;
    const z = unit(along);
    const x = unit(cross(z, Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), y = cross(z, x);
    const ring = (t) => Array.from({ length: sides }, (_, k) => {
      const angle = (2 * Math.PI * k) / sides + Math.PI / sides, r = ra + t * (rb - ra);
      return add(add(add(a, along, t), x, r * Math.cos(angle)), y, r * Math.sin(angle));
    });
    const count = Math.max(1, Math.min(16, Math.round(length / Math.max(ra, rb))));
    const slope = (ra - rb) / length;
    for (let n = 0; n < count; n++) {
      const [one, other] = [ring(n / count), ring((n + 1) / count)];
      for (let k = 0; k < sides; k++) {
        const j = (k + 1) % sides, angle = (2 * Math.PI * (k + 1)) / sides;
        const out = add(x.map((c) => c * Math.cos(angle)), y, Math.sin(angle));
        this.face([one[k], one[j], other[j], other[k]], unit(add(out, z, slope)), colour, 1, nearer);
      }
    }
    this.face(ring(0), z.map((c) => -c), colour, 1, nearer);
    this.face(ring(1), z, colour, 1, nearer);
  }

  // The ellipsoid with the given semi-axes.
  ellipsoid(centre, axes, colour, alpha, rings = 12) {
    const sides = 2 * rings;
    const on = (i, k) => {
      const [t, p] = [(Math.PI * i) / rings, (2 * Math.PI * k) / sides];
      return [Math.sin(t) * Math.cos(p), Math.sin(t) * Math.sin(p), Math.cos(t)];
    };
    // One that is flat still has a surface to be seen.
    const least = 0.015 * Math.max(...axes.map((a) => a.length));
    const size = axes.map((a) => Math.max(a.length, least));
    const put = (u) => axes.reduce((p, a, k) => add(p, a.axis, u[k] * size[k]), centre);
    for (let i = 0; i < rings; i++) {
      for (let k = 0; k < sides; k++) {
        const corners = [on(i, k), on(i + 1, k), on(i + 1, k + 1), on(i, k + 1)];
        const u = corners.reduce((sum, c) => add(sum, c, 0.25), [0, 0, 0]);
        const normal = axes.reduce((n, a, j) => add(n, a.axis, u[j] / size[j]), [0, 0, 0]);
        this.face(corners.map(put), unit(normal), colour, alpha);
      }
    }
  }

  // Everything so far, the farthest first.
  flush() {
    const { context: c } = this;
    c.lineJoin = c.lineCap = "round";
    for (const shape of this.shapes.sort((one, other) => other.depth - one.depth)) {
      c.beginPath();
      shape.points.forEach(([x, y], k) => (k ? c.lineTo(x, y) : c.moveTo(x, y)));
      if (shape.fill) {
        c.closePath();
        c.fillStyle = shape.fill;
        c.fill();
        // Closes the seams between neighbours.
        if (shape.alpha === 1) {
          c.strokeStyle = shape.fill;
          c.lineWidth = 0.7;
          c.stroke();
        }
      } else {
        c.strokeStyle = shape.stroke;
        c.lineWidth = shape.width;
        c.stroke();
      }
    }
    this.shapes = [];
  }

  // Over everything.
  over(points, colour, width, dash = []) {
    const { context: c } = this;
    c.beginPath();
    points.map((p) => this.eye.at(p)).forEach(([x, y], k) => (k ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.setLineDash(dash);
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.stroke();
    c.setLineDash([]);
  }

  arrow(from, to, colour, width, dash) {
    const [[x1, y1], [x2, y2]] = [this.eye.at(from), this.eye.at(to)];
    const length = Math.hypot(x2 - x1, y2 - y1);
    if (length < 2) return;
    this.over([from, to], colour, width, dash);
    const { context: c } = this;
    const head = Math.min(4 + 2.5 * width, length), [ux, uy] = [(x2 - x1) / length, (y2 - y1) / length];
    c.beginPath();
    c.moveTo(x2 + ux, y2 + uy);
    c.lineTo(x2 - head * ux - 0.45 * head * uy, y2 - head * uy + 0.45 * head * ux);
    c.lineTo(x2 - head * ux + 0.45 * head * uy, y2 - head * uy - 0.45 * head * ux);
    c.fillStyle = colour;
    c.fill();
  }

  // A word beside a point, readable on anything, at the first of the offsets
  // [px] where it hides no other; nowhere if there is none.
  word(text, point, offsets = [[0, 0]], size = 12) {
    const { context: c, colours } = this;
    const [x, y] = this.eye.at(point);
    c.font = `${size}px system-ui, sans-serif`;
    const [w, h] = [c.measureText(text).width / 2 + 3, size / 2 + 2];
    const free = ([dx, dy]) => this.words.every((other) =>
      Math.abs(other.x - x - dx) > other.w + w || Math.abs(other.y - y - dy) > other.h + h);
    const offset = offsets.find(free);
    if (!offset) return;
    const at = { x: x + offset[0], y: y + offset[1], w, h };
    this.words.push(at);
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.strokeStyle = colours.css("paper");
    c.lineWidth = 3.5;
    c.lineJoin = "round";
    c.strokeText(text, at.x, at.y);
    c.fillStyle = colours.css("ink");
    c.fillText(text, at.x, at.y);
  }
}
