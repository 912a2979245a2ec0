// Level sets on a grid, by marching squares: the same as the page's maker draws. Nodes have
// positions xs[i], ys[j]; a ring of nodes at the border's positions, below every level, closes them.

const levelSet = (xs, ys, values, level) => {
  const [columns, rows] = [xs.length, ys.length];
  const [wide, high] = [columns + 2, rows + 2];
  const clamp = (i, n) => Math.min(Math.max(i - 1, 0), n - 1);
  const value = (i, j) =>
    i < 1 || j < 1 || i > columns || j > rows ? NaN : values[(j - 1) * columns + i - 1];
  const place = (i, j) => [xs[clamp(i, columns)], ys[clamp(j, rows)]];
  const crossing = (edge) => {
    const up = edge % 2;
    const node = (edge - up) / 2;
    const [i, j] = [node % wide, Math.floor(node / wide)];
    const [k, l] = up ? [i, j + 1] : [i + 1, j];
    const [one, other, a, b] = [place(i, j), place(k, l), value(i, j), value(k, l)];
    let part = Number.isNaN(a) ? 0 : 1;
    if (!Number.isNaN(a) && !Number.isNaN(b)) {
      part = Math.min(Math.max((level - a) / (b - a), 0), 1) || 0;
    }
    return [one[0] + part * (other[0] - one[0]), one[1] + part * (other[1] - one[1])];
  };
  const onward = new Map();
  for (let j = 0; j < high - 1; j += 1) {
    for (let i = 0; i < wide - 1; i += 1) {
      const v = [value(i, j), value(i + 1, j), value(i + 1, j + 1), value(i, j + 1)];
      const within = v.map((x) => x >= level);
      const count = within.filter(Boolean).length;
      if (count === 0 || count === 4) {
        continue;
      }
      const id = (a, b, up) => 2 * (b * wide + a) + up;
      const edges = [id(i, j, 0), id(i + 1, j, 1), id(i, j + 1, 0), id(i, j, 1)];
      const sum = v[0] + v[1] + v[2] + v[3];
      const joined = Number.isNaN(sum) || sum / 4 >= level;
      for (let e = 0; e < 4; e += 1) {
        if (!within[e] || within[(e + 1) % 4]) {
          continue;
        }
        for (let turn = 1; turn < 4; turn += 1) {
          const f = joined ? (e + turn) % 4 : (e + 4 - turn) % 4;
          if (!within[f] && within[(f + 1) % 4]) {
            onward.set(edges[e], { to: edges[f], drawn: !Number.isNaN(sum) });
            break;
          }
        }
      }
    }
  }
  const area = [];
  const lines = [];
  for (const start of onward.keys()) {
    const [points, drawn] = [[], []];
    for (let at = start; onward.has(at); ) {
      const step = onward.get(at);
      onward.delete(at);
      points.push(crossing(at));
      drawn.push(step.drawn);
      at = step.to;
    }
    if (points.length > 0) {
      area.push(points);
      lines.push(...runsOf(points, drawn));
    }
  }
  return { area, lines };
};

const runsOf = (points, drawn) => {
  const n = points.length;
  const gap = drawn.indexOf(false);
  if (gap < 0) {
    return [[...points, points[0]]];
  }
  const all = [];
  let run = [];
  for (let step = 1; step <= n; step += 1) {
    const i = (gap + step) % n;
    if (drawn[i]) {
      if (run.length === 0) {
        run.push(points[i]);
      }
      run.push(points[(i + 1) % n]);
    } else if (run.length > 0) {
      all.push(run);
      run = [];
    }
  }
  return all;
};
