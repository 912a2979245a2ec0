// Parallel views of boxes.

// Where a point of the unit cube is drawn, and the direction from the scene to the viewer.
const viewOf = ({ azimuth, elevation, zoom }, shape, width, height) => {
  const [a, e] = [azimuth, elevation].map((x) => (x * Math.PI) / 180);
  const right = [-Math.sin(a), Math.cos(a), 0];
  const up = [-Math.cos(a) * Math.sin(e), -Math.sin(a) * Math.sin(e), Math.cos(e)];
  const toward = [Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)];
  const scale = (zoom * 0.92 * Math.min(width, height)) / Math.sqrt(dot(shape, shape));
  const at = (u) => {
    const p = [0, 1, 2].map((k) => (u[k] - 0.5) * shape[k] * scale);
    return [width / 2 + dot(right, p), height / 2 - dot(up, p)];
  };
  return { at, toward };
};

// The corners of a rectangle u_axis = end.
const corners = (axis, end, low, high) => {
  const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
  return [[low[b], low[c]], [high[b], low[c]], [high[b], high[c]], [low[b], high[c]]].map(([x, y]) => {
    const u = [0, 0, 0];
    [u[axis], u[b], u[c]] = [end, x, y];
    return u;
  });
};
const trace = (path, points) => {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
};

// Whether a point is in a parallelogram that has an area.
const covers = ([x, y], [o, p, , q]) => {
  const [e, f] = [[p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]];
  const det = e[0] * f[1] - e[1] * f[0];
  const s = ((x - o[0]) * f[1] - (y - o[1]) * f[0]) / det;
  const t = (e[0] * (y - o[1]) - e[1] * (x - o[0])) / det;
  return det !== 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1;
};

// The fill of a depth: the deeper, the darker.
const shade = (depth, [least, most]) => {
  const part = most > least ? (depth - least) / (most - least) : 0.5;
  return `hsl(${205 + 25 * part} ${45 + 25 * part}% ${90 - 62 * part}%)`;
};
