// The nominal machine: rows of M = J^-1 leg by leg, and its transmission factors, in doubles.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const combine = (s, a, t, b) => [0, 1, 2].map((k) => s * a[k] + t * b[k]);
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

// The row of M that a leg contributes at P, and a quantity that is positive exactly where the leg
// reaches P without a serial singularity.
const legAt = (leg, P) => {
  if (leg.drive === "planar") {
    return { row: leg.direction, clearance: 1 };
  }
  const w = combine(1, combine(1, P, 1, leg.platform), -1, leg.anchor);
  if (leg.drive === "strut") {
    const l = Math.sqrt(dot(w, w));
    return { row: w.map((x) => x / l), clearance: l };
  }
  if (leg.drive === "slider") {
    const n = leg.direction;
    const r = combine(1, w, -dot(n, w), n);
    const clearance = leg.length ** 2 - dot(r, r);
    const eta = leg.mode * Math.sqrt(clearance);
    return { row: combine(1, n, 1 / eta, r), clearance };
  }
  const k = leg.axis;
  const along = dot(k, w);
  const h = combine(1, w, -along, k);
  const N = dot(h, h);
  const g = (dot(w, w) + leg.arm ** 2 - leg.length ** 2) / (2 * leg.arm);
  const clearance = leg.length ** 2 - along ** 2 - (g - leg.arm) ** 2;
  const q = combine(1 / leg.arm, w, -g / N, h);
  const row = combine(1 / N, cross(k, h), leg.mode / Math.sqrt(clearance), q);
  return { row, clearance };
};

// Singular values of the matrix with these rows, by rotations that make its rows orthogonal
// (one-sided Jacobi): small ones come out as accurate as large ones.
const singularValues = (rows) => {
  const a = rows.map((row) => row.slice());
  for (let sweep = 0; sweep < 30; sweep += 1) {
    let turned = false;
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      const [alpha, beta, gamma] = [dot(a[p], a[p]), dot(a[q], a[q]), dot(a[p], a[q])];
      if (Math.abs(gamma) <= 1e-16 * Math.sqrt(alpha * beta)) {
        continue;
      }
      turned = true;
      const zeta = (beta - alpha) / (2 * gamma);
      const t = (zeta < 0 ? -1 : 1) / (Math.abs(zeta) + Math.sqrt(1 + zeta * zeta));
      const c = 1 / Math.sqrt(1 + t * t);
      [a[p], a[q]] = [combine(c, a[p], -c * t, a[q]), combine(c * t, a[p], c, a[q])];
    }
    if (!turned) {
      break;
    }
  }
  return a.map((row) => Math.sqrt(dot(row, row)));
};

// The factors at P in increasing order, or null out of reach; and the least clearance.
const factorsAt = (legs, P) => {
  const states = legs.map((leg) => legAt(leg, P));
  const clearance = Math.min(...states.map((state) => state.clearance));
  if (!(clearance > 0)) {
    return { psi: null, clearance };
  }
  const xi = singularValues(states.map((state) => state.row));
  return { psi: xi.map((x) => 1 / x).sort((x, y) => x - y), clearance };
};

// A number in so many significant digits, without trailing zeros.
const shown = (x, digits) => {
  if (!Number.isFinite(x)) {
    return x > 0 ? "infinite" : "none";
  }
  const text = x.toPrecision(digits);
  return text.includes("e") ? String(Number(text)) : text.includes(".") ? text.replace(/\.?0+$/, "") : text;
};
